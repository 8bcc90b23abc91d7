#include "cloth/state/solver_options.h"

namespace tutu::cloth {

std::string_view name_of(SolverKind kind) { return k_solver_names[static_cast<std::size_t>(kind)]; }

} // namespace tutu::cloth
