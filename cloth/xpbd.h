// Extended position-based dynamics in small steps, with whole warp threads solved at once.
#pragma once

#include "cloth/solver.h"

#include <memory>

namespace tutu::cloth {

/// For garments of rows and columns, in single precision (or double: SolverOptions::double_precision) from one source,
/// as wide as the processor's vectors.
///
/// A substep h [Macklin et al. 2019, Small Steps in Physics Simulation, algorithm 1]:
///   v less what the air takes (cloth/air/air.h, where the fabric has it),
///   v = (v + h g) / (1 + h drag),  x* = x + h v,  pins to their targets,  the constraints,  seams,  self-collision
///   where asked for,  contacts last,  v += (x - x*) / h.
/// The last line is v = (x - x_old) / h without its rounding: where nothing holds a particle, it falls as if alone.
/// A constraint C = |x_j - x_i| - L of compliance a = 1 / K takes part with
///   dlambda = (-C + (1 - s) C(was) - s a/h^2 lambda) / (w_i + w_j + s a/h^2)
/// [Macklin et al. 2016, XPBD, eq. 18 and 26]: s is what damping lets a substep take back (damping.h).
/// Order: bending, shear, weft by Gauss-Seidel, weft twice more, back and forth; then each warp thread as a whole
/// (twice: the second step is Newton's answer to the first one's linearisation), then once more by Gauss-Seidel.
///
/// A contact is pushed out along its normal, at a bounded speed where it began inside; the tangential motion relative
/// to the moving surface is taken back by at most friction * push (Coulomb, on positions).
std::unique_ptr<Solver> make_xpbd(const Garment& garment, const SolverOptions& options);

} // namespace tutu::cloth
