#include "cloth/state/solver_options.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace tutu::cloth {

std::string_view name_of(SolverKind kind) { return k_solver_names[static_cast<std::size_t>(kind)]; }

SolverKind solver_named(std::string_view name) {
  const auto found = std::find(k_solver_names.begin(), k_solver_names.end(), name);
  if (found == k_solver_names.end()) throw std::invalid_argument("no solver called " + std::string(name));
  return static_cast<SolverKind>(found - k_solver_names.begin());
}

ContactFeatures contact_features_named(std::string_view name) {
  const auto found = std::find(k_contact_features_names.begin(), k_contact_features_names.end(), name);
  if (found == k_contact_features_names.end())
    throw std::invalid_argument("no contact features called " + std::string(name));
  return static_cast<ContactFeatures>(found - k_contact_features_names.begin());
}

} // namespace tutu::cloth
