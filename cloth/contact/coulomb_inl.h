// Coulomb's law on positions, written once for any arithmetic: as proxies/distance/closed_forms_inl.h, to be included
// within a namespace.

/// `moved`, what a contact moved a point to (or by), less what friction takes back of `slip`: the point's way in this
/// step relative to the surface under it, of which the part across the unit normal rubs. All of that sticks up to
/// `most` = friction coefficient * push, m, what the contact pushed; beyond, the point slides on by the rest
/// [Macklin et al. 2014, Unified Particle Physics for Real-Time Applications, 6.1, with one coefficient for both].
template <class A>
[[gnu::always_inline]] inline typename A::Vector rubbed(const typename A::Vector& moved, const typename A::Vector& slip,
                                                        const typename A::Vector& normal, typename A::Real most) {
  const typename A::Vector across = A::minus_times(slip, A::dot(slip, normal), normal);
  const typename A::Real share = A::min(A::set(1.0), most / A::length(across)); // 0 / 0: the first, nothing to take
  return A::minus_times(moved, share, across);
}
