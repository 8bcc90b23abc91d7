// What lies between particles against proxies and the true body: the edges and faces of a garment of any triangles, in
// plain double.
#pragma once

#include "cloth/contact/contact_search.h"
#include "cloth/garment/garment.h"
#include "cloth/state/solver_options.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace tutu::cloth {

/// Takes the point, which began the substep where `starts` says, out along the normal, and back by what rubs, as
/// ContactSearch::way_out() has it of a particle. Returns the way.
Vec3 push_out(const ClothContact& contact, const ContactSearch& search, std::span<const Vec3> starts,
              std::vector<Vec3>& x);

/// The triangles of one garment against the proxies of a scene, or its true body, after its particles have met them
/// (ContactSearch, which it goes along with). Each triangle and proxy have one contact a substep, at the point that is
/// the deepest (proxies::triangle_contact): a corner, within an edge, or within the face. The corners that move it are
/// moved by their inverse masses times their weights, but no farther than k_longest_lever times the point itself.
///
/// Pairs that cannot have met since they were last asked are skipped, as in ContactSearch. `automatic` asks only pairs
/// of a triangle that is so large at this moment, for so thin a proxy, that particles which keep the offset could leave
/// the proxy in it; and, where the two meet so fast that the triangle may be torn (k_hasty_speed), all into which the
/// proxy would then fit.
///
/// Against the true body, with `triangles` only, a triangle has one contact for each pair of features that meet
/// (proxies/body/body_features.h), down to k_body_depth; a triangle waits while a corner is worked out of it. They are
/// not swept. Where cloth slides over sharp corners of a coarse body pairs come with a jump, and kick it. They cost
/// four times what its particles do, so that references go by these.
class TriangleContacts {
public:
  /// The garment must outlive it. Takes no memory before its first frame.
  TriangleContacts(const Garment& garment, const SolverOptions& options)
      : garment_(&garment), features_(options.features), swept_(options.swept) {}

  /// Broad phase for a frame, after that of `search`.
  void begin_frame(proxies::CollisionQuery& query, const ContactSearch& search, const Particles& particles);

  /// In a substep, after search.for_each_contact() and with the same particles: calls
  /// on_contact(ClothContact) for each contact, found where those before it left the corners; on_contact moves them,
  /// and returns the Response of the point.
  template <class OnContact>
  void for_each_contact(proxies::CollisionQuery& query, ContactSearch& search, Particles& particles,
                        const OnContact& on_contact);

  const ContactCounts& counts() const { return counts_; }

private:
  using Triangle = std::array<int, 3>; ///< corners
  struct Pair {
    int collider = 0;
    double squared_edge = 0.0; ///< m2: asked where the longest edge is longer
    double wake = 0.0;         ///< travelled sum at which the two may touch, m
  };

  void list_triangles();
  void find_pairs(proxies::CollisionQuery& query, const ContactSearch& search, const Particles& particles);
  double squared_edge_for(const proxies::Capsule& proxy, double offset) const; ///< of Pair
  /// m since candidates were found, of the corner that went the farthest.
  static double travelled(const Triangle& triangle, const ContactSearch::Way& way) {
    return std::max({way.particles[triangle[0]], way.particles[triangle[1]], way.particles[triangle[2]]});
  }
  static double squared_longest_edge(const Triangle& triangle, const std::vector<Vec3>& x);
  /// Whether the three corners, which keep the offset, keep the pair apart; `longest`: edge, squared.
  bool is_kept_by_particles(const Triangle& triangle, double longest, const ContactSearch& search,
                            const Pair& pair) const;
  std::optional<ClothContact> swept(const Triangle& triangle, const ContactSearch& search, int proxy,
                                    const Particles& particles) const;
  /// Nothing where the two are clear of each other (the pair then knows for how long), or all is moved that may be.
  std::optional<ClothContact> found(const Triangle& triangle, const ContactSearch& search, Pair& pair, double travelled,
                                    const Particles& particles);
  template <class OnContact>
  void meet(const ClothContact& contact, ContactSearch& search, const Particles& particles,
            const OnContact& on_contact);
  template <class OnContact>
  void meet_body(proxies::CollisionQuery& query, ContactSearch& search, std::size_t triangle, Particles& particles,
                 const OnContact& on_contact);
  /// m. No more than both have moved in the substep, and k_push_out_speed besides.
  double bounded_push(const ClothContact& contact, const ContactSearch& search, const std::vector<Vec3>& x) const;
  /// Nothing at a pinned corner, or between two.
  std::optional<ClothContact> with_levers(ClothContact contact) const;

  const Garment* garment_;
  ContactFeatures features_;
  bool swept_ = true;
  std::vector<Triangle> triangles_;
  std::vector<double> inverse_masses_; ///< 1/kg, 0 for pinned particles
  std::vector<proxies::Box> boxes_;
  proxies::Candidates candidates_;
  std::vector<int> begin_; ///< of each triangle in pairs_; triangles + 1 entries
  std::vector<Pair> pairs_;
  std::vector<double> body_wakes_; ///< of each triangle: travelled sum at which it may touch the true body, m
  std::vector<proxies::BodyContact> body_contacts_; ///< room
  std::int64_t searches_ = 0;                       ///< of `search`, when pairs were last found
  ContactCounts counts_;
};

template <class OnContact>
void TriangleContacts::for_each_contact(proxies::CollisionQuery& query, ContactSearch& search, Particles& particles,
                                        const OnContact& on_contact) {
  if (features_ == ContactFeatures::particles) return;
  if (searches_ != search.counts().searches) find_pairs(query, search, particles);
  const ContactSearch::Way way = search.way();
  const bool asks_body = features_ == ContactFeatures::triangles && search.colliders().has_body();
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& triangle = triangles_[t];
    // What pushed it would undo how its corners were settled.
    if (std::ranges::any_of(triangle, [&](int corner) { return search.is_pinched(corner); })) continue;
    double gone = travelled(triangle, way);
    double longest = -1.0; // edge, squared: of the triangle as it is, where somebody asks
    const auto meet_if = [&](const std::optional<ClothContact>& contact) {
      if (!contact) return;
      meet(*contact, search, particles, on_contact);
      gone = travelled(triangle, way);
      longest = -1.0;
    };
    for (int p = begin_[t]; p < begin_[t + 1]; ++p) {
      Pair& pair = pairs_[p];
      const double since = gone + way.colliders[pair.collider];
      if (since < pair.wake) continue;
      if (longest < 0.0) longest = squared_longest_edge(triangle, particles.positions);
      if (is_kept_by_particles(triangle, longest, search, pair)) continue;
      meet_if(swept(triangle, search, pair.collider, particles));
      meet_if(found(triangle, search, pair, since, particles));
    }
    if (asks_body) meet_body(query, search, t, particles, on_contact);
  }
}

template <class OnContact>
void TriangleContacts::meet(const ClothContact& contact, ContactSearch& search, const Particles& particles,
                            const OnContact& on_contact) {
  search.keep(contact, on_contact(contact));
  for (const int i : contact.particles) search.moved(i, particles.positions[i]);
  ++counts_.contacts;
}

template <class OnContact>
void TriangleContacts::meet_body(proxies::CollisionQuery& query, ContactSearch& search, std::size_t t,
                                 Particles& particles, const OnContact& on_contact) {
  const Triangle& triangle = triangles_[t];
  const auto& [a, b, c] = triangle;
  const std::vector<Vec3>& x = particles.positions;
  const ContactSearch::Way way = search.way();
  const int body = search.colliders().body_index();
  const double since = travelled(triangle, way) + way.colliders[body];
  if (since < body_wakes_[t]) return;
  if (search.is_in_body(a) || search.is_in_body(b) || search.is_in_body(c)) return; // they come out first
  body_contacts_.clear();
  const double clear = query.body()->contacts({x[a], x[b], x[c]}, {search.offset(), k_body_depth}, body_contacts_);
  ++counts_.queries;
  body_wakes_[t] = since + clear - k_travel_slack;
  for (const proxies::BodyContact& pair : body_contacts_) {
    auto contact = with_levers({triangle, pair.weights, {}, body, pair});
    if (!contact) continue;
    set_on_body(*contact, pair);
    // From where those before it left the corners.
    contact->contact.distance = (contact->point(x) - pair.closest).dot(pair.normal);
    contact->push = bounded_push(*contact, search, x);
    if (contact->push > 0.0) meet(*contact, search, particles, on_contact);
  }
}

} // namespace tutu::cloth
