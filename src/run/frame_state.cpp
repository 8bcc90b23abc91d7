#include "src/run/frame_state.h"

#include <cmath>

namespace tutu::app {
namespace {

template <class T> std::size_t bytes_of(const std::vector<T>& values) { return values.size() * sizeof(T); }

template <class T> void assign(std::vector<T>& to, std::span<const T> from) { to.assign(from.begin(), from.end()); }

} // namespace

std::size_t FrameState::bytes() const {
  std::size_t sum = sizeof(*this) + bytes_of(joints) + bytes_of(colliders_start) + bytes_of(colliders_end) +
                    bytes_of(spin) + bytes_of(substeps);
  for (const cloth::Particles& garment : garments) sum += bytes_of(garment.positions) + bytes_of(garment.velocities);
  for (const std::vector<std::uint8_t>& mask : ignored) sum += bytes_of(mask);
  for (const BroadPhaseState& phase : broad)
    sum += bytes_of(phase.boxes) + bytes_of(phase.begin) + bytes_of(phase.colliders);
  return sum;
}

void capture(const Session& session, FrameState& out) {
  out.time = session.time();
  out.index = static_cast<int>(std::lround(session.time() / session.frame_seconds()));
  assign(out.joints, session.world_from_joint());
  const proxies::SweptColliders colliders = session.colliders().swept();
  assign(out.colliders_start, colliders.start);
  assign(out.colliders_end, colliders.end);
  assign(out.spin, colliders.spin);
  out.ground = colliders.ground;
  const std::size_t garments = session.scene().garments.size();
  out.garments.resize(garments);
  out.broad.resize(garments);
  out.substeps.resize(garments);
  out.ignored.resize(garments);
  for (std::size_t g = 0; g < garments; ++g) {
    const cloth::GuardedSolver& solver = session.garment(static_cast<int>(g));
    out.garments[g] = solver.particles();
    out.substeps[g] = solver.substeps();
    assign(out.ignored[g], session.colliders_of(static_cast<int>(g)).ignored);
    const cloth::BroadPhaseView phase = solver.broad_phase();
    assign(out.broad[g].boxes, phase.boxes);
    assign(out.broad[g].begin, phase.begin);
    assign(out.broad[g].colliders, phase.colliders);
  }
  out.times = session.times();
  out.recoveries = session.troubles().recoveries;
}

std::uint64_t state_hash(const FrameState& state) {
  std::uint64_t hash = cloth::state_hash({});
  for (const cloth::Particles& garment : state.garments) hash = cloth::state_hash(garment, hash);
  return hash;
}

} // namespace tutu::app
