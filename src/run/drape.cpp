#include "src/run/drape.h"
#include "cloth/state/tolerances.h"
#include "src/run/settings_table.h"

#include <algorithm>
#include <cmath>

namespace tutu::app {
namespace {

constexpr double k_pose_seconds = 1.0; ///< s from the rest pose to the first pose; slow enough for cloth to follow
constexpr double k_drape_drag =
    4.0; ///< 1/s; near critical for a skirt's swing (about 1 Hz), so that it settles without ringing

double fastest_of(const Runtime& runtime, std::size_t garments) {
  double fastest = 0.0;
  for (std::size_t g = 0; g < garments; ++g)
    for (const Vec3& v : runtime.garment(static_cast<int>(g)).particles().velocities)
      fastest = std::max(fastest, v.norm());
  return fastest;
}

} // namespace

DrapeResult drape(const Wearer& wearer, std::span<const Transform> first, double longest,
                  const std::function<bool(int, int)>& progress, const std::atomic<bool>* stop) {
  Runtime runtime(wearer);
  runtime.set_wind({wearer.wind.velocity});
  runtime.stop_when(stop);
  const rig::Skeleton& skeleton = wearer.character.skeleton;
  const std::vector<Transform>& rest = skeleton.rest_local;
  std::vector<Transform> local(rest.size()), world(rest.size());

  const double seconds = wearer.settings.frame_seconds();
  const int total = static_cast<int>(std::ceil(longest / seconds));
  const int posing = std::min(total, static_cast<int>(std::ceil(k_pose_seconds / seconds)));
  DrapeResult result;
  for (int frame = 0; frame < total && !runtime.failure(); ++frame) {
    const double u = std::min(1.0, static_cast<double>(frame + 1) / posing);
    const double s = u * u * (3.0 - 2.0 * u); // starts and stops without a jerk
    for (std::size_t j = 0; j < local.size(); ++j) local[j] = s < 1.0 ? interpolate(rest[j], first[j], s) : first[j];
    rig::model_from_local(skeleton, local, world);
    runtime.step(world, seconds, k_drape_drag);
    if (runtime.stopped()) break;
    result.fastest = fastest_of(runtime, wearer.garments.size());
    if (!progress(frame + 1, total)) break;
    if (frame >= posing && result.fastest < cloth::k_settled_speed) break;
  }
  result.seconds = runtime.time();
  result.failure = runtime.failure();
  for (std::size_t g = 0; g < wearer.garments.size(); ++g)
    result.positions.push_back(runtime.garment(static_cast<int>(g)).particles().positions);
  return result;
}

DrapeResult drape(const Scene& scene, double longest, const std::function<bool(int, int)>& progress,
                  const std::atomic<bool>* stop) {
  return drape(scene, rig::first_pose(scene.motion), longest, progress, stop);
}

std::uint64_t drape_fingerprint(const Scene& scene) {
  // Everything becomes numbers, and numbers become a hash: as good as comparing the files, and blind to their layout.
  // Rounded far below any length that matters: another processor's sine may differ in its last bit.
  cloth::Particles numbers;
  const auto rounded = [](double v) { return std::round(v * 1e8) + 0.0; };
  const auto add = [&](double a, double b = 0.0, double c = 0.0) {
    numbers.positions.emplace_back(rounded(a), rounded(b), rounded(c));
  };
  const auto add_point = [&](const Vec3& p) { add(p.x(), p.y(), p.z()); };
  for (const cloth::Garment& garment : scene.garments) {
    for (const Vec3& p : garment.rest_positions) add_point(p);
    for (const cloth::Spring& spring : garment.springs) add(spring.i, spring.j, spring.stiffness);
    for (const cloth::Pin& pin : garment.pins) add(pin.particle, pin.attachment);
    for (const cloth::Seam& seam : garment.seams) add(seam.i, seam.j);
    const cloth::Fabric& f = garment.fabric;
    add(f.density, f.drag, f.contact_offset());
    add(1e3 * f.bend, garment.pressed); // in mN m, above the rounding
    if (f.air) {
      add(f.air->pressure, f.air->lift, f.air->friction);
      add_point(scene.wind.velocity);
    }
  }
  for (const std::vector<int>& joints : scene.attachment_joints)
    for (const int joint : joints) add(joint);
  for (const SkinPins& pins : scene.skin_pins)
    for (const SkinPins::Binding& binding : pins.bindings) {
      add(binding.pin, binding.triangle);
      add_point(binding.weights);
      add_point(binding.offset);
    }
  const auto add_pose = [&](std::span<const Transform> pose) {
    for (const Transform& t : pose) {
      add_point(t.translation);
      add(t.rotation.x(), t.rotation.y(), t.rotation.z());
    }
  };
  add_pose(scene.character.skeleton.rest_local);
  add_pose(rig::first_pose(scene.motion));
  for (const proxies::Proxy& proxy : scene.proxies) {
    if (!proxy.enabled) continue;
    add(proxy.radius, proxy.friction);
    if (proxy.taper != 0.0) add(proxy.taper); // so that the hash of sets without stays what it was
    for (const proxies::Anchor* anchor : {&proxy.a, &proxy.b})
      for (int k = 0; k < anchor->count; ++k) {
        add(anchor->joints[k], anchor->weights[k]);
        add_point(anchor->points[k]);
      }
  }
  add(scene.ground_height.value_or(0.0), scene.ground_height ? 1.0 : 0.0);
  for_each_draping(scene.settings, [&](int number) { add(number); });
  const bool meets_skin =
      scene.collides_with_body() || std::any_of(scene.skin_pins.begin(), scene.skin_pins.end(),
                                                [](const SkinPins& pins) { return !pins.bindings.empty(); });
  if (meets_skin && scene.character.skin.method != rig::Skinning::linear)
    add(7.0, static_cast<double>(scene.character.skin.method));
  return cloth::state_hash(numbers);
}

} // namespace tutu::app
