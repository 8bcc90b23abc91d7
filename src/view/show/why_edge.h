// Why an edge between two particles is where it is: how long it is, and what it touches between its ends.
#pragma once

#include "src/run/frame_state.h"

#include <nlohmann/json.hpp>

namespace tutu::app {

struct WhyEdgeContact {
  std::string collider;  ///< a proxy's name
  double distance = 0.0; ///< m, signed, of the edge's nearest point, at the frame's end
  double depth = 0.0;    ///< m, >= 0: nearer than the garment's gap by so much
  double at = 0.0;       ///< where on the edge, 0 at its first particle, 1 at the second
  Vec3 normal = Vec3::UnitY();
};

struct WhyEdge {
  std::string garment;
  int i = 0, j = 0, frame = 0;          ///< particles at its ends
  double rest = 0.0;                    ///< m
  double length = 0.0;                  ///< m
  std::vector<WhyEdgeContact> contacts; ///< within the gap and k_touch_slack, nearest first
  double strain() const { return length / rest - 1.0; }
};

/// `spring`: of the garment's.
WhyEdge explain_edge(const Scene& scene, std::size_t garment, int spring, const FrameState& now);

nlohmann::json json_of(const WhyEdge& why); ///< lengths in mm where the name says so
std::vector<std::string> text_of(const WhyEdge& why);

/// How a ray passes a segment at its nearest: how far along the ray (m, its direction a unit vector), how far aside
/// (m), and where on the segment (0 at p, 1 at q).
struct Passing {
  double along = 0.0, aside = 0.0, at = 0.0;
};
Passing passing(const Vec3& from, const Vec3& direction, const Vec3& p, const Vec3& q);

} // namespace tutu::app
