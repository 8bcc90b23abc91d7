#include "cloth/cloth.h"
#include "proxies/proxies.h"
#include "rig/rig.h"

int main() {
  using namespace tutu;
  const proxies::Contact contact = proxies::signed_distance(Vec3(0, 2, 0), proxies::Capsule{{0, 0, 0}, {0, 1, 0}, 0.5});
  const auto query = proxies::make_query(proxies::Backend::fcl);
  cloth::GarmentDescription description;
  description.shape = cloth::GridShape{4, 4};
  const cloth::Garment garment = cloth::build_garment(description);
  cloth::MassSpring cloth(garment);
  const bool fell = !cloth.step({}, *query).has_value() && cloth.particles().positions[0].y() < 0.0;
  return contact.distance == 0.5 && fell ? 0 : 1;
}
