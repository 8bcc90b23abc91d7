// Contact of a tile by time of impact, for steps in which the contact at the end alone could let cloth through. Private
// to the folder.
#pragma once

#include "cloth/contact/contact_set.h"
#include "cloth/contact/swept_contact.h"
#include "cloth/woven/sheet.h"

#include <cstdint>
#include <vector>

namespace tutu::cloth {

/// Free particles of one block's rows first..last-1 (and, with `cells`, triangles of the cells to the next block and
/// row) that touched the collider since the substep's start are put back to the side they touched: outside the plane
/// through the point of touch, moved on with the surface. The contacts at the end of the substep go on from there.
/// Plain and in double: it is asked for seldom. Returns how many were put back; `kept`, where it is one, gets them too,
/// whole but for their collider.
template <class T>
std::int64_t sweep_tile(WovenSheet<T>& sheet, int block, int first, int last, const SweptCollider& collider, bool cells,
                        std::vector<ClothContact>* kept);

} // namespace tutu::cloth
