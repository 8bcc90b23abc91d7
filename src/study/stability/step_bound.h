// The largest step of mass_spring in closed form: from the fastest vibration of the garment's own springs.
#pragma once

#include "cloth/garment/garment.h"

namespace tutu::app {

/// s. A step of semi-implicit Euler, v += h (-w^2 x - c v), x += h v, has determinant 1 - h c and trace
/// 2 - h c - h^2 w^2, so both of its eigenvalues stay within the unit circle while h^2 w^2 + 2 h c < 4 [Jury's test].
/// `vibration` w > 0 in rad/s, `drag` c >= 0 in 1/s.
double largest_stable_step(double vibration, double drag);

/// s, of the garment's own springs and drag under mass_spring, which damps no more than its step bears; infinite where
/// nothing can vibrate.
double largest_stable_step(const cloth::Garment& garment);

} // namespace tutu::app
