#include "cloth/contact/contact_set.h"

#include "proxies/distance/closed_forms.h"

#include <algorithm>

namespace tutu::cloth {
namespace {

/// Where on the axis, in [0, 1], the contact is nearest to.
double place_on_axis(const proxies::Capsule& proxy, const proxies::Contact& contact) {
  if (proxies::is_one_ball(proxy)) return proxy.taper > 0.0 ? 1.0 : 0.0;
  // closest = a + t axis + (radius + t taper) normal
  const Vec3 axis = proxy.b - proxy.a;
  const double along = (contact.closest - proxy.a - proxy.radius * contact.normal).dot(axis);
  return std::clamp(along / (axis.squaredNorm() + proxy.taper * contact.normal.dot(axis)), 0.0, 1.0);
}

} // namespace

void set_on_proxy(ClothContact& contact, const proxies::Capsule& proxy) {
  if (proxies::is_one_ball(proxy)) contact.on = ColliderFeature::sphere;
  else contact.on = proxy.taper == 0.0 ? ColliderFeature::capsule : ColliderFeature::cone;
  const double t = place_on_axis(proxy, contact.contact);
  contact.on_collider = {1.0 - t, t, 0.0};
}

void set_on_body(ClothContact& contact, const proxies::MeshContact& on_body) {
  if (on_body.feature == proxies::MeshFeature::face) contact.on = ColliderFeature::body_face;
  else if (on_body.feature < proxies::MeshFeature::vertex_a) contact.on = ColliderFeature::body_edge;
  else contact.on = ColliderFeature::body_vertex;
  contact.body_triangle = on_body.triangle;
  for (int k = 0; k < 3; ++k) contact.on_collider[k] = on_body.weights[k];
}

void set_on_body(ClothContact& contact, const proxies::BodyContact& on_body) {
  contact.on = on_body.pair == proxies::BodyPair::edge_edge ? ColliderFeature::body_edge : ColliderFeature::body_vertex;
  contact.body_triangle = on_body.triangle;
  contact.on_collider = on_body.on_body;
}

void ContactSet::add(const ClothContact& contact) {
  ++kept_;
  if (ring_.empty()) return;
  ClothContact& kept = ring_[(kept_ - 1) % ring_.size()];
  kept = contact;
  std::size_t part = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (contact.particles[k] < 0 || contact.weights[k] == 0.0) continue;
    kept.particles[part] = contact.particles[k];
    kept.weights[part] = contact.weights[k];
    kept.levers[part] = contact.levers[k];
    ++part;
  }
  for (; part < 3; ++part) {
    kept.particles[part] = -1;
    kept.weights[part] = kept.levers[part] = 0.0;
  }
  kept.step = step_;
  kept.substep = substep_;
}

} // namespace tutu::cloth
