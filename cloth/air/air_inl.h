// What the air takes from a triangle of cloth (air.h), written once for any arithmetic: as
// proxies/distance/closed_forms_inl.h, to be included within a namespace.

/// The air of one substep h: each coefficient of Air times density * h / 36, kg s/m3, which with twice a triangle's
/// area and the sum of its corners' velocities makes what h / 3 of its force per speed is.
template <class A> struct AirInStep {
  typename A::Real pressure, lift, friction;
  typename A::Vector wind; ///< m/s
};

/// v, the velocity of a corner, after the air had its third of the triangle for a substep. `normal` and `tangent`: kg,
/// of the third, along the triangle's unit normal doubled_area * per_area and across it.
template <class A>
[[gnu::always_inline]] inline typename A::Vector
slowed_corner(const typename A::Vector& v, typename A::Real inverse_mass, const typename A::Vector& wind,
              typename A::Real normal, typename A::Real tangent, const typename A::Vector& doubled_area,
              typename A::Real per_area) {
  const typename A::Vector u = A::minus_times(v, A::set(1.0), wind);
  const typename A::Real n = inverse_mass * normal, t = inverse_mass * tangent;
  const typename A::Real with_n = A::set(1.0) + n, share = A::set(1.0) / (with_n * (A::set(1.0) + t));
  // u less (I + n N + t (I - N))^-1 u, N the projection on the normal. Both shares are below 1; of nothing they are 0.
  const typename A::Vector less = A::minus_times(v, t * with_n * share, u);
  return A::minus_times(less, (n - t) * share * (A::dot(u, doubled_area) * per_area * per_area), doubled_area);
}

/// All three corners, at x with velocities v and inverse masses w, 1/kg (0: held).
template <class A>
[[gnu::always_inline]] inline void slow_triangle(const AirInStep<A>& air, const typename A::Vector& xa,
                                                 const typename A::Vector& xb, const typename A::Vector& xc,
                                                 typename A::Vector& va, typename A::Vector& vb, typename A::Vector& vc,
                                                 typename A::Real wa, typename A::Real wb, typename A::Real wc) {
  using Real = typename A::Real;
  using Vector = typename A::Vector;
  constexpr double k_no_area = 1e-15; // m2: far below any cell's; a normal of what is smaller is shorter than 1
  const Real one = A::set(1.0);
  const Vector doubled_area = A::cross(A::minus_times(xb, one, xa), A::minus_times(xc, one, xa));
  const Real area = A::length(doubled_area), per_area = one / A::max(area, A::set(k_no_area));
  const Vector sum = A::minus_times(A::plus_times(A::plus_times(va, one, vb), one, vc), A::set(3.0), air.wind);
  const Real across = A::dot(sum, doubled_area) * per_area;
  const Real along = A::length(A::minus_times(sum, across * per_area, doubled_area));
  const Real normal = area * (air.pressure * A::abs(across) + air.lift * along), tangent = area * air.friction * along;
  va = slowed_corner<A>(va, wa, air.wind, normal, tangent, doubled_area, per_area);
  vb = slowed_corner<A>(vb, wb, air.wind, normal, tangent, doubled_area, per_area);
  vc = slowed_corner<A>(vc, wc, air.wind, normal, tangent, doubled_area, per_area);
}
