// Which solver moves a garment, and how.
#pragma once

#include <array>
#include <string_view>

namespace tutu::cloth {

enum class SolverKind {
  mass_spring, ///< the report's, and the plain form to compare with
  xpbd         ///< extended position-based dynamics in small steps, threads solved as wholes
};

/// What of the cloth meets colliders, besides its particles.
enum class ContactFeatures {
  automatic, ///< triangles where a cell of the garment is larger than the smallest collider in reach
  particles, ///< nothing besides
  triangles  ///< with their edges
};
inline constexpr std::array<std::string_view, 3> k_contact_features_names = {"auto", "particles", "triangles"};

struct SolverOptions {
  SolverKind solver = SolverKind::xpbd;
  ContactFeatures features = ContactFeatures::automatic;
  int passes = 1;    ///< xpbd: over the constraints, a substep; more than one pays on fine sheets (256 a side)
  bool swept = true; ///< contacts by time of impact where something moves farther than it is thick
  bool self_collision = false;   ///< particles of the garment keep apart (self_collision.h)
  bool double_precision = false; ///< of the kernels: for references

  bool operator==(const SolverOptions&) const = default;
};

/// As in scene files and on the command line, in the order of SolverKind.
inline constexpr std::array<std::string_view, 2> k_solver_names = {"mass_spring", "xpbd"};
std::string_view name_of(SolverKind kind);

} // namespace tutu::cloth
