// Where points, edges and faces are nearest to a collider: the closed forms, written once for any arithmetic.
//
// This text has neither guard nor namespace. Who wants the forms includes it within their own namespace, so that a SIMD
// kernel compiles them once for each of its targets, with that target's instructions: templates from outside, whose
// functions are another target's, could not be inlined there.
//   proxies/distance/closed_forms.h      one double at a time
//   cloth/woven/arithmetic_inl.h         vectors of float or double, fused where the target can
//   proxies/fit/detail/kernel.cpp        vectors of float, never fused
//
// The arithmetic A is a struct of static functions on A::Real (one number, or one a lane) and A::Vector (three of
// them):
//   set(double), min, max, abs, sqrt, select(mask, x, y) and the operators + - * / < > == of Real;
//   dot, cross, length, plus_times(v, s, w) = v + s w, minus_times of Vector;
//   k_least_square, k_steep, k_parallel, k_one_lane (Real is one number): see where they are used.
// Each lane is computed by the operations as they stand here, in their order: bits are a promise.

/// The balls about all points a + t axis, t in [0, 1], of radius `radius` + t `taper`: a Capsule (proxies/shapes.h)
/// neither of whose end balls holds the other, or with axis 0 a sphere.
template <class A> struct RoundCone {
  typename A::Vector a, axis;        ///< axis = b - a, m
  typename A::Real per_axis_squared; ///< 1 / |axis|^2; 0 for a sphere
  typename A::Real radius, taper;    ///< m: at a, and what b adds
  typename A::Real lean;             ///< taper / (|axis| sqrt(|axis|^2 - taper^2)), 1/m: 0 without taper
};

template <class A> struct ClosedForms {
  using Real = typename A::Real;
  using Vector = typename A::Vector;
  using Cone = RoundCone<A>;

  [[gnu::always_inline]] static inline Real within_unit(Real t) { return A::min(A::max(t, A::set(0.0)), A::set(1.0)); }

  template <bool k_tapered> [[gnu::always_inline]] static inline Real radius_at(const Cone& c, Real t) {
    if constexpr (k_tapered) return c.radius + t * c.taper;
    else return c.radius;
  }

  /// A point against a cone: the place t of the ball whose surface is nearest to the point `d` from a (that it is
  /// deepest in). A normal n of the side leans by n . axis = -taper, since there |p - c(t)| - r(t) is least along the
  /// axis and rises the same way on both sides of c(t); so with the foot h |axis| along the axis and rho across it
  ///   t = clamp(h + rho lean);
  /// without taper that is the foot [Ericson 2005, Real-Time Collision Detection, 5.1.2].
  template <bool k_tapered> [[gnu::always_inline]] static inline Real nearest_on_axis(const Cone& c, const Vector& d) {
    const Real foot = A::dot(d, c.axis) * c.per_axis_squared;
    if constexpr (!k_tapered) return within_unit(foot);
    else return within_unit(foot + A::length(A::minus_times(d, foot, c.axis)) * c.lean);
  }

  /// How far that point is from the surface, m: below 0 inside.
  template <bool k_tapered> [[gnu::always_inline]] static inline Real distance(const Cone& c, const Vector& d) {
    const Real t = nearest_on_axis<k_tapered>(c, d);
    return A::length(A::minus_times(d, t, c.axis)) - radius_at<k_tapered>(c, t);
  }

  /// A point against the half space normal . x <= offset: above 0 outside.
  [[gnu::always_inline]] static inline Real height(const Vector& normal, Real offset, const Vector& x) {
    return A::dot(x, normal) - offset;
  }

  /// Places of an edge (of s) and of an axis (of t), both in [0, 1].
  struct Places {
    Real s, t;
  };

  /// An edge against a capsule of one radius, as two segments [Ericson 2005, 5.1.9]. `edge`: q - p; `r`: p - a; `ee`:
  /// |edge|^2, above 0. Where the squared sine between them is below k_parallel the nearest of the two lines is taken
  /// as if it were that: off by that sine times the edge at most. nearest_of_cone is exact there.
  [[gnu::always_inline]] static inline Places nearest_of_segments(const Cone& c, const Vector& edge, const Vector& r,
                                                                  Real ee) {
    const Real ea = A::dot(edge, c.axis), er = A::dot(edge, r), ar = A::dot(c.axis, r);
    // The line's nearest point to the axis' line; the product with 1 / |axis|^2 keeps the numbers of one size.
    const Real slant = ea * c.per_axis_squared, determinant = ee - ea * slant;
    const Real on_line = (slant * ar - er) / A::max(determinant, A::set(A::k_parallel) * ee);
    const Real t = within_unit((ea * within_unit(on_line) + ar) * c.per_axis_squared);
    return {within_unit((t * ea - er) / ee), t};
  }

  /// An edge against a cone; of one radius too. |p + s edge - a - t axis| - radius_at(t) is convex in (s, t). For s
  /// without bounds it is least at the t where the n with n . edge = 0 and n . axis = -taper faces the edge's line, or,
  /// where the edge is steeper than the cone, at the wide end, and within [0, 1] at the bound next to it; where the s
  /// that belongs to that t is out of bounds, at the bound of s. Less than k_steep, of |edge|^2 |axis|^2, counts as
  /// steeper.
  template <bool k_tapered>
  [[gnu::always_inline]] static inline Places nearest_of_cone(const Cone& c, const Vector& edge, const Vector& r,
                                                              Real ee) {
    const Vector across = A::cross(edge, c.axis);
    const Real squared = A::dot(across, across);
    const Real least = A::max(A::set(A::k_steep) * ee * A::dot(c.axis, c.axis), A::set(A::k_least_square));
    Real upright = squared, facing = A::dot(A::cross(edge, r), across), wide_end = A::set(0.0);
    if constexpr (k_tapered) {
      const Real taper_ee = c.taper * ee;
      upright = squared - taper_ee * c.taper;
      facing = facing + A::abs(A::dot(r, across)) * taper_ee / A::sqrt(A::max(upright, least));
      wide_end = A::select(c.taper > A::set(0.0), A::set(1.0), A::set(0.0));
    }
    const Real t = within_unit(A::select(upright > least, facing / A::max(squared, least), wide_end));
    const Real free = (t * A::dot(edge, c.axis) - A::dot(edge, r)) / ee, s = within_unit(free);
    if constexpr (A::k_one_lane)
      if (s == free) return {s, t};
    return {s, A::select(s == free, t, nearest_on_axis<k_tapered>(c, A::plus_times(r, s, edge)))};
  }

  /// The foot of a point on the plane of a triangle, o + v e + w f, `r` being the point less o [Ericson 2005, 3.4];
  /// over the triangle where v, w and u = 1 - v - w are none of them below 0. `least`: of |e x f|^2, above 0.
  struct Foot {
    Real u, v, w;
  };
  [[gnu::always_inline]] static inline Foot foot_on_plane(const Vector& e, const Vector& f, const Vector& r,
                                                          Real least) {
    const Real ee = A::dot(e, e), ef = A::dot(e, f), ff = A::dot(f, f), re = A::dot(r, e), rf = A::dot(r, f);
    const Real per = A::set(1.0) / A::max(ee * ff - ef * ef, least);
    const Real v = (ff * re - ef * rf) * per, w = (ee * rf - ef * re) * per;
    return {A::set(1.0) - v - w, v, w};
  }
};
