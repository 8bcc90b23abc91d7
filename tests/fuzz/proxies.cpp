// Proxies: read, posed, asked for distances, written, and read again.
#include "proxies/distance/signed_distance.h"
#include "proxies/motion/collider_set.h"
#include "proxies/proxy_file.h"
#include "tests/fuzz/target.h"

#include <cmath>

namespace tutu::fuzz {
namespace {

void pose(const std::vector<proxies::Proxy>& list) {
  const rig::Skeleton& skeleton = small_character().skeleton;
  std::vector<Transform> model = rig::rest_model(skeleton);
  proxies::ColliderSet colliders(list, proxies::Plane{});
  colliders.reset(model);
  for (Transform& joint : model) joint = Transform{Quat(0.6, 0, 0.8, 0), Vec3(0.1, 0, 0)} * joint;
  colliders.advance(model);
  const proxies::SweptColliders swept = colliders.swept();
  for (int i = 0; i < swept.size(); ++i) {
    const proxies::Capsule& capsule = swept.end[i];
    require(is_finite(capsule.a) && is_finite(capsule.b) && is_finite(swept.spin[i]) && capsule.narrowest() > 0.0,
            "colliders are finite and have a radius");
    for (const Vec3& point : {Vec3(0.1, 1.0, 0.2), capsule.a, Vec3(0.5 * (capsule.a + capsule.b))}) {
      const proxies::Contact contact = proxies::signed_distance(point, capsule);
      require(std::isfinite(contact.distance) && std::abs(contact.normal.norm() - 1.0) < 1e-6,
              "a distance is finite, its normal unit");
    }
  }
}

} // namespace

void fuzz_proxies(std::string_view input) {
  const rig::Skeleton& skeleton = small_character().skeleton;
  const std::filesystem::path file = write_input(input, "proxies.json");
  const std::vector<proxies::Proxy> list = proxies::read_proxies(file, skeleton);
  pose(list);
  const std::filesystem::path first = scratch() / "first.json", second = scratch() / "second.json";
  proxies::write_proxies(first, list, skeleton, proxies::read_fit_note(file));
  proxies::write_proxies(second, proxies::read_proxies(first, skeleton), skeleton, proxies::read_fit_note(first));
  require(proxies::read_proxies(second, skeleton).size() == list.size(), "proxies read back as written");
}

} // namespace tutu::fuzz
