#include "src/view/proxy_edit/proxy_figures.h"

#include "proxies/distance/capsule_union.h"
#include "proxies/validate/validate.h"

#include <cmath>
#include <stdexcept>

namespace tutu::app {
namespace {

class Gatherer {
public:
  void add(double distance, double area) {
    under_.add(std::max(0.0, distance), area);
    over_.add(std::max(0.0, -distance), area);
    ++samples_;
  }
  ProxyFigures figures() const {
    ProxyFigures result{under_.figures(), over_.figures(), 0.0, samples_};
    result.rms = std::hypot(result.under.rms, result.over.rms);
    return result;
  }

private:
  proxies::ErrorGatherer under_, over_;
  int samples_ = 0;
};

proxies::SkinSamples samples_of(const rig::Mesh& mesh, int count) {
  std::vector<char> keep; // empty: all
  try {
    keep = proxies::outer_triangles(proxies::BodyMesh(mesh.positions, mesh.triangles));
  } catch (const std::invalid_argument&) {
  }
  return proxies::sample_skin(mesh.positions, mesh.triangles, count, keep);
}

} // namespace

ProxyMeasure::ProxyMeasure(const rig::Mesh& mesh, int samples) : mesh_(&mesh), samples_(samples_of(mesh, samples)) {
  pose(mesh.positions);
}

void ProxyMeasure::pose(std::span<const Vec3f> positions) {
  spots_.clear();
  for (const auto& sample : samples_.samples) {
    Vec3 place = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      place += sample.weights[k] * positions[mesh_->triangles[sample.triangle][k]].cast<double>();
    spots_.push_back({place, sample.area});
  }
}

ProxyMeasure::Result ProxyMeasure::measure(std::span<const proxies::Capsule> shapes, int one) const {
  if (shapes.empty()) return {};
  proxies::CapsuleUnion all;
  all.assign(shapes);
  Gatherer whole, own;
  for (const SkinSpot& spot : spots_) {
    const auto nearest = all.nearest(spot.place);
    whole.add(nearest.distance, spot.area);
    if (nearest.capsule == one) own.add(nearest.distance, spot.area);
  }
  return {whole.figures(), own.figures()};
}

} // namespace tutu::app
