// How cloth answers within a substep, so that motion does not depend on how long the substep is.
#pragma once

#include "cloth/garment/garment.h"

namespace tutu::cloth {

/// What an edge, a diagonal or a bend of violation C (edges: length less rest length, m) is solved for in a substep:
/// C - (1 - taken) C(was), `was` the substep's start.
struct DampedStep {
  double taken = 1.0;   ///< share of C(was) that the substep takes back
  double elastic = 0.0; ///< of an edge's C(was) at most this share of its rest length counts: beyond it is no strain
                        ///< but what the iteration has left, and is taken back at once
};

/// The damping t of a fabric (Fabric::damping) by substeps of any length.
///
/// Kelvin-Voigt stress K (C + t dC/dt) over an implicit step h is
///   dlambda = (-C - g (C - C(was)) - a/h^2 lambda) / ((1 + g) w + a/h^2),  g = t/h  [Macklin et al. 2016, XPBD, eq.
///   26].
/// But the step damps by itself, like t = h: a vibration w decays by h w^2 / 2, as by t w^2 / 2. So with g = t/h - 1
/// both together are t, whatever the substep; divided by 1 + g, taken = h/t. It is 1 at most, and substeps longer than
/// t damp like themselves: up to 2 a vibration of any stiffness decays, but what is stiffer than the step then rings,
/// and cloth that a fast limb strikes opens (with 1.25, one at 20 m/s passed in 3 substeps a frame).
///
/// Turning is no strain, and not damped: edges pull in the direction that they had at the substep's start, as in SHAKE
/// [Ryckaert, Ciccotti, Berendsen 1977], of which a velocity of (x - was) / h makes a leapfrog, the same backwards in
/// time. The direction that they end with would take h w^2 / 2 from a swing w of a fold or of the whole garment, and
/// spin from what turns. It is the one for what the substep steps over (k_most_turn, k_most_pull).
///
/// xpbd of any mesh takes back all of C: its passes do not come to an end, and what they leave grows where a substep is
/// to take back less. What h lacks of t dampers take from its velocities (cloth/mesh_xpbd.h).
class Damping {
public:
  explicit Damping(const Garment& garment);
  DampedStep at(double h) const; ///< h in s

private:
  double time_ = 0.0;    ///< s
  double elastic_ = 0.0; ///< of cloth that carries the longest way from what is held to its end, at twice its weight
};

} // namespace tutu::cloth
