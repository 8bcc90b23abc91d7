// The backend `mesh`: cloth against the true body.
#include "proxies/detail/query_guard.h"
#include "proxies/distance/signed_distance.h"
#include "proxies/query/collision_query.h"

#include <limits>
#include <stdexcept>
#include <string>

namespace tutu::proxies {
namespace {

class MeshQuery final : public CollisionQuery {
public:
  explicit MeshQuery(BodyMesh body)
      : body_(std::move(body)), now_(body_.positions().begin(), body_.positions().end()) {}

  void find_candidates(const SweptColliders& colliders, std::span<const Vec3> points, double reach,
                       Candidates& out) override {
    require_usable(points, reach);
    list_all(colliders, points.size(), out);
  }

  void find_for_boxes(const SweptColliders& colliders, std::span<const Box> boxes, Candidates& out) override {
    require_usable(boxes);
    list_all(colliders, boxes.size(), out);
  }

  void place(std::span<const Capsule> colliders, const std::optional<Plane>& ground) override {
    require_no_proxies(colliders.size());
    require_usable(ground);
    ground_ = ground;
  }

  void place_body(const SweptColliders& colliders, double s) override {
    require_body(colliders);
    start_ = colliders.body_start;
    end_ = colliders.body_end;
    for (std::size_t v = 0; v < now_.size(); ++v)
      now_[v] = (1.0 - s) * start_[v].cast<double>() + s * end_[v].cast<double>();
    body_.pose(now_);
    has_posed_ = true;
  }

  double body_contacts(const std::array<Vec3, 3>& cloth, const BodyReach& reach,
                       std::vector<BodyContact>& out) override {
    if (!features_) features_.emplace(body_); // of no use to those who ask points only
    else if (has_posed_) features_->refresh();
    has_posed_ = false;
    return features_->contacts(cloth, reach, out);
  }

  Contact contact(const Vec3& point, int collider) const override {
    if (collider != SweptColliders{}.ground_index()) return body_.signed_distance(point);
    require_usable(point);
    return proxies::signed_distance(point, *ground_);
  }

  Vec3 body_way(const Vec3& point) const override {
    const MeshPoint on = *body_.nearest(point, std::numeric_limits<double>::infinity());
    Vec3 way = Vec3::Zero();
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t v = body_.triangles()[on.triangle][c];
      way += on.weights[c] * (end_[v] - start_[v]).cast<double>();
    }
    return way;
  }

private:
  static void require_no_proxies(std::size_t count) {
    if (count > 0)
      throw std::invalid_argument("collision query: found " + std::to_string(count) +
                                  " proxies, expected none beside the true body");
  }

  void require_body(const SweptColliders& colliders) const {
    require_no_proxies(colliders.start.size());
    for (const std::span<const Vec3f> vertices : {colliders.body_start, colliders.body_end})
      if (vertices.size() != now_.size())
        throw std::invalid_argument("collision query: found a body of " + std::to_string(vertices.size()) +
                                    " vertices, expected " + std::to_string(now_.size()));
  }

  /// Cloth skips whom it cannot have reached since it was last asked: a search of our own would ask as much.
  void list_all(const SweptColliders& colliders, std::size_t rows, Candidates& out) {
    require_body(colliders);
    out.begin.assign(1, 0);
    out.colliders.clear();
    for (std::size_t i = 0; i < rows; ++i) {
      if (colliders.ground) out.colliders.push_back(colliders.ground_index());
      out.colliders.push_back(colliders.body_index());
      out.begin.push_back(static_cast<int>(out.colliders.size()));
    }
  }

  BodyMesh body_;
  std::optional<BodyFeatures> features_; // of body_
  bool has_posed_ = false;               // body_, since these were refreshed
  std::vector<Vec3> now_;                // the vertices where the body was placed
  std::span<const Vec3f> start_, end_;   // of the frame
  std::optional<Plane> ground_;
};

} // namespace

std::unique_ptr<CollisionQuery> make_mesh_query(BodyMesh body) { return std::make_unique<MeshQuery>(std::move(body)); }

} // namespace tutu::proxies
