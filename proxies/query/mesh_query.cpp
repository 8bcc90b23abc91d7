// The backend `mesh`: cloth against the true body.
#include "proxies/detail/query_guard.h"
#include "proxies/distance/signed_distance.h"
#include "proxies/query/collision_query.h"

#include <stdexcept>
#include <string>

namespace tutu::proxies {
namespace {

class MeshQuery final : public CollisionQuery {
public:
  explicit MeshQuery(BodyMesh body) : body_(std::move(body)) {}

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

  MovingBody* body() override { return &body_; }

  Contact contact(const Vec3& point, int collider) const override {
    if (collider != SweptColliders{}.ground_index()) return body_.contact(point);
    require_usable(point);
    return proxies::signed_distance(point, *ground_);
  }

private:
  static void require_no_proxies(std::size_t count) {
    if (count > 0)
      throw std::invalid_argument("collision query: found " + std::to_string(count) +
                                  " proxies, expected none beside the true body");
  }

  /// Cloth skips whom it cannot have reached since it was last asked: a search of our own would ask as much.
  void list_all(const SweptColliders& colliders, std::size_t rows, Candidates& out) {
    require_no_proxies(colliders.start.size());
    body_.begin_frame(colliders.body_start, colliders.body_end);
    out.begin.assign(1, 0);
    out.colliders.clear();
    for (std::size_t i = 0; i < rows; ++i) {
      if (colliders.ground) out.colliders.push_back(colliders.ground_index());
      out.colliders.push_back(colliders.body_index());
      out.begin.push_back(static_cast<int>(out.colliders.size()));
    }
  }

  MovingBody body_;
  std::optional<Plane> ground_;
};

} // namespace

std::unique_ptr<CollisionQuery> make_mesh_query(BodyMesh body) { return std::make_unique<MeshQuery>(std::move(body)); }

} // namespace tutu::proxies
