#include "proxies/body/moving_body.h"

#include <limits>
#include <stdexcept>
#include <string>

namespace tutu::proxies {

MovingBody::MovingBody(BodyMesh body)
    : body_(std::move(body)), now_(body_.positions().begin(), body_.positions().end()) {}

void MovingBody::begin_frame(std::span<const Vec3f> start, std::span<const Vec3f> end) {
  for (const std::span<const Vec3f> vertices : {start, end})
    if (vertices.size() != now_.size())
      throw std::invalid_argument("collision query: found a body of " + std::to_string(vertices.size()) +
                                  " vertices, expected " + std::to_string(now_.size()));
  start_ = start;
  end_ = end;
}

void MovingBody::place(double s) {
  for (std::size_t v = 0; v < start_.size(); ++v)
    now_[v] = (1.0 - s) * start_[v].cast<double>() + s * end_[v].cast<double>();
  body_.pose(now_);
  has_posed_ = true;
}

double MovingBody::contacts(const std::array<Vec3, 3>& cloth, const BodyReach& reach,
                            std::vector<BodyContact>& contacts) {
  if (!features_) features_.emplace(body_); // of no use to those who ask points only
  else if (has_posed_) features_->refresh();
  has_posed_ = false;
  return features_->contacts(cloth, reach, contacts);
}

Vec3 MovingBody::way(const Vec3& point) const {
  const MeshPoint on = *body_.nearest(point, std::numeric_limits<double>::infinity());
  Vec3 way = Vec3::Zero();
  for (int c = 0; c < 3; ++c) {
    const std::uint32_t v = body_.triangles()[on.triangle][c];
    way += on.weights[c] * (end_[v] - start_[v]).cast<double>();
  }
  return way;
}

} // namespace tutu::proxies
