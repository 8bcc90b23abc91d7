#include "cloth/state/divergence.h"

#include "cloth/state/tolerances.h"

#include <fmt/format.h>

namespace tutu::cloth {
namespace {

std::string place(const Vec3& p) {
  return p.allFinite() ? fmt::format(" at ({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z()) : "";
}

/// The subject and the verb.
std::string finding(const Divergence& d) {
  const std::string where = place(d.position);
  switch (d.trouble) {
  case Trouble::bad_target: return fmt::format("the target of held particle {}{} was no number", d.particle, where);
  case Trouble::bad_collider: return "a collider was no number";
  case Trouble::no_number:
    return fmt::format("particle {} was no number{}{}", d.particle, where.empty() ? "" : ", and last", where);
  case Trouble::out_of_world:
    return fmt::format("particle {} was out of the world{}, more than {:g} m from the origin", d.particle, where,
                       k_world_radius);
  case Trouble::too_fast: return fmt::format("particle {}{} went at {:.4g} m/s", d.particle, where, d.speed);
  case Trouble::long_edge:
    return fmt::format("the edge from particle {}{} to {} was {:.4g} m long, {:.4g} times its rest length", d.particle,
                       where, d.other, d.length, d.length / d.rest_length);
  case Trouble::long_tether:
    return fmt::format("particle {}{} was {:.4g} m from particle {}, which holds it, {:.4g} times what the cloth "
                       "between them allows",
                       d.particle, where, d.length, d.other, d.length / d.rest_length);
  }
  return "";
}

} // namespace

std::string what_was_found(const Divergence& d) {
  std::string text = finding(d);
  if (d.trouble == Trouble::bad_target || d.trouble == Trouble::bad_collider) return text;
  if (d.is_of_length() && d.held && d.held->particle != d.particle)
    text += fmt::format("; particle {} went at {:.4g} m/s", d.particle, d.speed);
  if (d.held)
    text +=
        d.held->particle == d.particle
            ? fmt::format("; particle {} is held, and was moved by {:.4g} m in that substep", d.particle, d.held->way)
            : fmt::format("; the nearest held particle, {}, was moved by {:.4g} m in that substep", d.held->particle,
                          d.held->way);
  if (d.strongest_force > 0.0)
    text += fmt::format("; the largest force was {:.3g} N on particle {}", d.strongest_force, d.strongest_particle);
  return text;
}

} // namespace tutu::cloth
