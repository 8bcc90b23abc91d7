// Whether a scene sits outside the region where its methods hold: closed forms, no simulation.
#pragma once

#include "src/study/stability/scene_setting.h"

#include <string>
#include <vector>

namespace tutu::app {

/// What is outside, each in words with its number and what to change; empty: nothing.
///  - mass_spring in a substep that its own springs do not stand (step_bound.h);
///  - a proxy that goes farther against the cloth in a substep than it is thick, where no substeps are added, or where
///    as many as may be are not enough;
///  - cells that a proxy fits through, where only particles meet it.
std::vector<std::string> outside_safe_region(const RunSettings& description, const SceneSetting& setting);

/// One line of all of them for a person; "" for none.
std::string warning_of(const Scene& scene);

} // namespace tutu::app
