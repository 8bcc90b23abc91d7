// The true body on its way through a frame, for cloth that collides with it.
#pragma once

#include "proxies/body/body_features.h"
#include "proxies/body/body_mesh.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace tutu::proxies {

/// A BodyMesh between two poses. World space, m; conventions of contact.h. Where numbers of vertices or points are
/// wrong, its functions throw std::invalid_argument.
class MovingBody {
public:
  explicit MovingBody(BodyMesh body);

  /// As many vertices as the body has, at the frame's start and end. The spans must live until the next call.
  void begin_frame(std::span<const Vec3f> start, std::span<const Vec3f> end);
  /// Puts the body where it is at `s` in [0, 1] of the frame.
  void place(double s);

  // Of the body where it was placed:

  MeshContact contact(const Vec3& point) const { return body_.signed_distance(point); }

  /// Edges and faces of a triangle of cloth (corners): BodyFeatures::contacts.
  double contacts(const std::array<Vec3, 3>& cloth, const BodyReach& reach, std::vector<BodyContact>& contacts);

  /// How far the surface goes from the frame's start to its end where it is nearest to `point` now.
  Vec3 way(const Vec3& point) const;

private:
  BodyMesh body_;
  std::optional<BodyFeatures> features_; ///< of body_; none before somebody asks for them
  bool has_posed_ = false;               ///< body_, since these were refreshed
  std::vector<Vec3> now_;                ///< the vertices where the body was placed
  std::span<const Vec3f> start_, end_;   ///< of the frame
};

} // namespace tutu::proxies
