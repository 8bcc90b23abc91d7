// Cloth of threads once more, particle by particle in double: what cloth/woven/kernel.h promises, written from its
// formulas. Of the kernel's layout it knows the order only: block after block, in each one column of every lane's run.
#pragma once

#include "cloth/air/air.h"
#include "cloth/garment/elements.h"
#include "cloth/garment/garment.h"
#include "cloth/state/tolerances.h"
#include "cloth/woven/kernel.h"
#include "tests/support/nearest_search.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace tutu::test {

/// A collider as the twin wants it: where it is, where it was, and how it rubs.
struct TwinCollider {
  proxies::Capsule now, before; ///< now.radius with the contact offset
  Vec3 spin = Vec3::Zero();     ///< rad
  double friction = 0.0;
  double push_speed_step = 0.0; ///< m

  double moved() const { return std::max((now.a - before.a).norm(), (now.b - before.b).norm()); }
  bool is_sphere() const { return now.a == now.b; }
  /// Way of the surface at the place t of the axis in direction n.
  Vec3 surface_way(double t, const Vec3& n) const {
    const Vec3 axis = (now.b - now.a).normalized();
    const Vec3 about = is_sphere() ? spin : Vec3(axis * axis.dot(spin));
    return (1.0 - t) * (now.a - before.a) + t * (now.b - before.b) + about.cross(now.radius_at(t) * n);
  }
};

struct TwinPlane {
  proxies::Plane plane; ///< with the contact offset
  double friction = 0.0;
  double push_speed_step = 0.0;
};

class WovenTwin {
public:
  WovenTwin(const cloth::Garment& garment, int blocks, int lanes)
      : x(garment.rest_positions), was(x), v(x.size(), Vec3::Zero()), garment_(&garment), blocks_(blocks),
        rows_(garment.rows), columns_(garment.columns), columns_of_(blocks), inverse_mass_(x.size()), warp_(x.size()),
        weft_(x.size()), falling_(x.size()), rising_(x.size()) {
    for (int lane = 0, column = 0; lane < lanes; ++lane) { // of a grid the last runs may be short or empty
      const int run = garment.woven_shut ? columns_ / lanes + (lane < columns_ % lanes) : blocks;
      for (int block = 0; block < run && column < columns_; ++block) columns_of_[block].push_back(column++);
    }
    const auto pinned = cloth::pinned_flags(garment);
    for (std::size_t i = 0; i < x.size(); ++i) inverse_mass_[i] = pinned[i] ? 0.0 : 1.0 / garment.masses[i];
    for (const cloth::Spring& spring : garment.springs)
      if (spring.kind != cloth::SpringKind::bend) note(spring);
    std::vector<std::uint8_t> held(columns_, 0); // threads; of garments that lie unturned
    for (const cloth::Pin& pin : garment.pins) held[pin.particle % columns_] = 1;
    const auto count = std::count(held.begin(), held.end(), 1);
    if (count > 0 && 2 * count < columns_) tethers_ = cloth::build_tethers(garment);
    std::erase_if(tethers_, [](const cloth::Tether& tether) { return tether.length == 0.0; });
  }

  std::vector<Vec3> x, was, v; ///< one a particle
  /// Edges and faces asked so far whose distance was within k_grazing of 0: single precision decides these its own way,
  /// above all where an earlier contact has just put a shared corner on the surface.
  std::int64_t grazing = 0;
  static constexpr int k_rows_at_once = 15; ///< rows of a block that all that joins it to the next is done with at once
  static constexpr double k_grazing = 1e-6; ///< m, the rounding of single precision at these places, some times over

  /// The air for h seconds, triangle by triangle: v = w + (I + h D / m)^-1 (v - w) [cloth/air/air.h].
  void air(const Vec3& wind, double h) {
    for (int block = 0; block < blocks_; ++block)
      for_block(block, 0, rows_ - 1, [&](int a) {
        const std::optional<int> b = right_of(a);
        if (!b) return;
        const int d = a + columns_, e = *b + columns_;
        air_on({a, d, *b}, wind, h);
        air_on({e, *b, d}, wind, h);
      });
  }

  void predict(const cloth::WovenStep<double>& step) {
    const Vec3 gravity(step.gravity[0], step.gravity[1], step.gravity[2]);
    was = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
      v[i] = inverse_mass_[i] > 0.0 ? Vec3(step.kept * (v[i] + step.h * gravity)) : Vec3(Vec3::Zero());
      x[i] += step.h * v[i];
    }
  }

  void finish(const cloth::WovenStep<double>& step) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      v[i] += (x[i] - (was[i] + step.h * v[i])) / step.h;
      if (v[i].norm() > step.fastest) v[i] *= step.fastest / v[i].norm();
    }
  }

  /// Returns false when an edge was longer than it may be at the moment it was solved.
  bool constraints(const cloth::WovenStep<double>& step) {
    whole_ = true;
    for (std::vector<Edge>* family : {&warp_, &weft_, &falling_, &rising_})
      for (Edge& edge : *family) edge.lambda = 0.0;
    const bool repeats = step.passes > 1;
    if (garment_->fabric.bend > 0.0) bend(step);
    for (const cloth::Tether& tether : tethers_) {
      const Vec3 d = x[tether.particle] - x[tether.anchor];
      const double longest = cloth::longest_of(tether, garment_->fabric);
      if (d.norm() > (1.0 + cloth::k_diverged_stretch) * longest) whole_ = false;
      if (d.norm() > longest) x[tether.particle] = x[tether.anchor] + longest * d.normalized();
    }
    for (int pass = 0; pass < step.passes; ++pass) {
      for (int block = 0; block < blocks_; ++block) {
        for (int first = 0; first < rows_; first += k_rows_at_once) {
          const int last = std::min(first + k_rows_at_once, rows_), last_cell = std::min(last, rows_ - 1);
          if (garment_->fabric.shear > 0.0)
            for (std::vector<Edge>* family : {&falling_, &rising_})
              for_block(block, first, last_cell, [&](int i) { solve((*family)[i], step, repeats); });
          for_block(block, first, last, [&](int i) { solve(weft_[i], step, true); });
        }
      }
      for (int k = 0; k < step.weft_sweeps; ++k)
        for (int n = 0; n < blocks_; ++n)
          for_block(k % 2 == 0 ? blocks_ - 1 - n : n, 0, rows_, [&](int i) { solve(weft_[i], step, true); });
      for (int block = 0; block < blocks_; ++block) {
        for (int k = 0; k < step.newton_steps; ++k) for_block(block, 0, 1, [&](int i) { solve_thread(i, step); });
        for (int k = 0; k < step.closing_sweeps; ++k)
          for (int first = 0; first + 1 < rows_; first += k_rows_at_once)
            for (int begin = first; begin < first + 2; ++begin)
              for (int row = begin; row < std::min(first + k_rows_at_once, rows_ - 1); row += 2)
                for_block(block, row, row + 1, [&](int i) { solve(warp_[i], step, true); });
      }
    }
    return whole_;
  }

  double farthest(int block, int first, int last) const {
    double most = 0.0;
    for_block(block, first, last, [&](int i) { most = std::max(most, (x[i] - was[i]).squaredNorm()); });
    return most;
  }

  /// Least distance of a particle of the tile to the surface before any was moved; contacts are counted.
  double contact_capsule(int block, int first, int last, const TwinCollider& collider, double rise,
                         std::int64_t* contacts) {
    proxies::Capsule shape = collider.now;
    shape.radius += rise;
    TwinCollider risen = collider;
    risen.now.radius = shape.radius;
    double least = std::numeric_limits<double>::max();
    for_block(block, first, last, [&](int i) {
      const Searched contact = search_point(x[i], shape);
      if (inverse_mass_[i] == 0.0) return;
      least = std::min(least, contact.distance);
      if (contact.distance >= 0.0) return;
      const Vec3 surface = risen.surface_way(contact.t, contact.normal);
      x[i] += response(-contact.distance, contact.normal, x[i] - was[i], surface, collider.moved(),
                       collider.push_speed_step, collider.friction);
      ++*contacts;
    });
    return least;
  }

  double contact_plane(int block, int first, int last, const TwinPlane& plane, std::int64_t* contacts) {
    double least = std::numeric_limits<double>::max();
    for_block(block, first, last, [&](int i) {
      const Vec3& n = plane.plane.normal;
      const double height = n.x() * x[i].x() + n.y() * x[i].y() + n.z() * x[i].z() - plane.plane.offset;
      if (inverse_mass_[i] == 0.0) return;
      least = std::min(least, height);
      if (height >= 0.0) return;
      x[i] += response(-height, n, x[i] - was[i], Vec3::Zero(), 0.0, plane.push_speed_step, plane.friction);
      ++*contacts;
    });
    return least;
  }

  /// Edges along the weft and diagonals, and with `high` the other edges and faces, of the cells right of a block's
  /// columns, each where the ones before it left its corners.
  void contact_cells(int block, int first, int last, const TwinCollider& collider, bool high, std::int64_t* contacts) {
    for_block(block, first, last, [&](int a) {
      const std::optional<int> b = right_of(a);
      const bool has_below = a / columns_ + 1 < rows_;
      if (b) edge_contact(a, *b, collider, contacts);
      if (!has_below) return;
      const int d = a + columns_;
      if (high) edge_contact(a, d, collider, contacts);
      if (!b) return;
      const int e = *b + columns_;
      edge_contact(*b, d, collider, contacts);
      if (!high) return;
      for (int end = 0; end < (collider.is_sphere() ? 1 : 2); ++end) {
        face_contact({a, d, *b}, end, collider, contacts);
        face_contact({e, *b, d}, end, collider, contacts);
      }
    });
  }

  /// `lead_of_second`: the share of the second in the place they get.
  void join(int first, int second, double share_of_second) {
    x[first] = x[second] = (1.0 - share_of_second) * x[first] + share_of_second * x[second];
  }

  double inverse_mass(int i) const { return inverse_mass_[i]; }
  const std::vector<int>& columns_of(int block) const { return columns_of_[block]; }

private:
  struct Edge {
    int i = 0, j = 0;
    double rest = 0.0, stiffness = 0.0; ///< m, N/m; no edge where stiffness is 0
    double lambda = 0.0;                ///< N s2 over passes; positive pulls
  };

  std::optional<int> right_of(int i) const {
    if (i % columns_ + 1 < columns_) return i + 1;
    if (!garment_->woven_shut) return std::nullopt;
    return i - columns_ + 1;
  }

  void air_on(const std::array<int, 3>& corners, const Vec3& wind, double h) {
    const auto& [pressure, lift, friction] = *garment_->fabric.air;
    const Vec3 doubled = (x[corners[1]] - x[corners[0]]).cross(x[corners[2]] - x[corners[0]]), n = doubled.normalized();
    const Vec3 u = (v[corners[0]] + v[corners[1]] + v[corners[2]]) / 3.0 - wind;
    const double across = std::abs(u.dot(n)), along = (u - u.dot(n) * n).norm();
    const Eigen::Matrix3d normal = n * n.transpose(), identity = Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d drag = 0.5 * cloth::k_air_density * 0.5 * doubled.norm() / 3.0 *
                                 ((pressure * across + lift * along) * normal + friction * along * (identity - normal));
    for (const int i : corners) v[i] = wind + (identity + h * inverse_mass_[i] * drag).inverse() * (v[i] - wind);
  }

  void note(const cloth::Spring& spring) {
    const auto put = [&](std::vector<Edge>& family, int at) {
      family[at] = {spring.i, spring.j, spring.rest_length, spring.stiffness, 0.0};
    };
    for (const auto& [i, j] : {std::pair(spring.i, spring.j), std::pair(spring.j, spring.i)}) {
      if (j == i + columns_) return put(warp_, i);
      if (right_of(i) == j) return put(weft_, i);
      if (const auto right = right_of(i); right && j == *right + columns_) return put(falling_, i);
      if (const auto right = right_of(j - columns_); j >= columns_ && right == i) return put(rising_, j - columns_);
    }
    throw std::logic_error("a spring between no neighbours");
  }

  template <class F> void for_block(int block, int first, int last, const F& f) const {
    for (int row = first; row < last; ++row)
      for (const int column : columns_of_[block]) f(row * columns_ + column);
  }

  void check(const Edge& edge, double length) {
    if (!(length <= (1.0 + cloth::k_diverged_stretch) * edge.rest)) whole_ = false;
  }

  /// What an edge is solved for at this moment: C - (1 - taken) C(was).
  struct Solved {
    Vec3 direction;
    double residual, at; ///< m, 1 / (K h^2) times taken
    Vec3 before;         ///< from end to end at the substep's start, over the length now
    bool turned;         ///< or grown or shrunk, by too much to pull along `before`
  };
  /// What a pull moves both ends by, for each unit of inverse mass: along the edge as it was where that is allowed.
  static Vec3 pull_of(const Solved& now, double gained, double all, double weights, double length) {
    if (now.turned || std::abs(all) * weights > cloth::k_most_pull * length) return gained * now.direction;
    return gained * now.before;
  }
  Solved solved(const Edge& edge, const cloth::WovenStep<double>& step) {
    const Vec3 d = x[edge.j] - x[edge.i], before = was[edge.j] - was[edge.i];
    const double length = d.norm(), excess = length - edge.rest, most = step.elastic * edge.rest;
    check(edge, length);
    const double excess_before = excess - d.dot(d - before) / length; // to the first order
    return {d / length, excess - (1.0 - step.taken) * std::clamp(excess_before, -most, most),
            step.taken / (edge.stiffness * step.h * step.h), before / length,
            std::abs(1.0 - before.dot(d) / (length * length)) > cloth::k_most_turn};
  }

  /// dlambda = (residual - at lambda) / (w_i + w_j + at).
  void solve(Edge& edge, const cloth::WovenStep<double>& step, bool with_lambda) {
    if (edge.stiffness == 0.0) return;
    const Solved now = solved(edge, step);
    const double wi = inverse_mass_[edge.i], wj = inverse_mass_[edge.j];
    const double gained = (now.residual - (with_lambda ? now.at * edge.lambda : 0.0)) / (wi + wj + now.at);
    edge.lambda += gained;
    const Vec3 pull = pull_of(now, gained, edge.lambda, wi + wj, (x[edge.j] - x[edge.i]).norm());
    x[edge.i] += wi * pull;
    x[edge.j] -= wj * pull;
  }

  /// (J W J^T + at) dlambda = residual - at lambda over the thread that starts at particle `top`, as a dense system.
  void solve_thread(int top, const cloth::WovenStep<double>& step) {
    const int edges = rows_ - 1;
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(edges, 3 * rows_); // of -C: positive lambda pulls
    Eigen::VectorXd weights(3 * rows_), right(edges), at(edges);
    std::vector<Solved> all;
    for (int row = 0; row < rows_; ++row) weights.segment<3>(3 * row).setConstant(inverse_mass_[top + row * columns_]);
    for (int k = 0; k < edges; ++k) {
      const Edge& edge = warp_[top + k * columns_];
      const Solved& now = all.emplace_back(solved(edge, step));
      gradient.block<1, 3>(k, 3 * k) = now.direction.transpose();
      gradient.block<1, 3>(k, 3 * k + 3) = -now.direction.transpose();
      at[k] = now.at;
      right[k] = now.residual - at[k] * edge.lambda;
    }
    Eigen::MatrixXd system = gradient * weights.asDiagonal() * gradient.transpose();
    system.diagonal() += at;
    const Eigen::VectorXd gained = system.ldlt().solve(right);
    const std::vector<Vec3> from = x;
    for (int k = 0; k < edges; ++k) {
      Edge& edge = warp_[top + k * columns_];
      edge.lambda += gained[k];
      const int upper = top + k * columns_, lower = upper + columns_;
      const double wi = inverse_mass_[upper], wj = inverse_mass_[lower];
      const Vec3 pull = pull_of(all[k], gained[k], edge.lambda, wi + wj, (from[lower] - from[upper]).norm());
      x[upper] += wi * pull;
      x[lower] -= wj * pull;
    }
  }

  void bend(const cloth::WovenStep<double>& step) {
    for (int block = 0; block < blocks_; ++block)
      for_block(block, 0, rows_, [&](int i) {
        const std::optional<int> next = right_of(i), last = next ? right_of(*next) : std::nullopt;
        if (last) solve_bend(i, *next, *last, step);
      });
    for (int block = 0; block < blocks_; ++block)
      for (int first = 0; first + 2 < rows_; first += k_rows_at_once)
        for (int colour = 0; colour < 3; ++colour)
          for (int row = first + colour; row < std::min(first + k_rows_at_once, rows_ - 2); row += 3)
            for_block(block, row, row + 1, [&](int i) { solve_bend(i, i + columns_, i + 2 * columns_, step); });
  }

  /// Energy B A kappa^2 / 2 over the middle particle's area A, kappa = c / (l1 (l1 + l2) / 2),
  /// c = (x_c - x_b) l1 / l2 - (x_b - x_a): a constraint c = 0 of compliance (l1 (l1 + l2) / 2)^2 / (B A).
  void solve_bend(int a, int b, int c, const cloth::WovenStep<double>& step) {
    const auto& rest = garment_->rest_positions;
    const double l1 = (rest[b] - rest[a]).norm(), l2 = (rest[c] - rest[b]).norm(), ratio = l1 / l2;
    const double area = garment_->masses[b] / garment_->fabric.density, scale = 0.5 * l1 * (l1 + l2);
    const double compliance = scale * scale / (garment_->fabric.bend * area);
    const double wa = inverse_mass_[a], wb = inverse_mass_[b], wc = inverse_mass_[c];
    const auto curve_of = [&](const std::vector<Vec3>& at) { return Vec3(ratio * (at[c] - at[b]) - (at[b] - at[a])); };
    const Vec3 curve = curve_of(x), along = curve.normalized();
    const double g = 1.0 / step.taken - 1.0, weights = wa + wb * (1.0 + ratio) * (1.0 + ratio) + wc * ratio * ratio;
    const double change = along.dot(curve - curve_of(was)); // along it alone: what turns is not damped
    const Vec3 lambda = -(curve.norm() + g * change) / ((1.0 + g) * weights + compliance / (step.h * step.h)) * along;
    x[a] += wa * lambda; // the gradients of c: 1, -(1 + ratio), ratio
    x[b] -= wb * (1.0 + ratio) * lambda;
    x[c] += wc * ratio * lambda;
  }

  /// Out along the normal, no farther than both sides moved and the push-out speed allow; back along what was slipped,
  /// by at most friction times that.
  static Vec3 response(double depth, const Vec3& n, const Vec3& way, const Vec3& surface_way, double surface_moved,
                       double push_speed_step, double friction) {
    const double push = std::min(depth, way.norm() + surface_moved + push_speed_step);
    const Vec3 slip = way - surface_way, along = slip - slip.dot(n) * n;
    const double length = along.norm();
    return push * n - (length > friction * push ? Vec3(friction * push / length * along) : along);
  }

  /// Moves the corners so that sum_k share_k * corner_k moves by the response, each by its inverse mass times share.
  template <std::size_t N>
  void spread(const std::array<int, N>& corners, const std::array<double, N>& shares, const Searched& contact,
              const TwinCollider& collider, std::int64_t* contacts) {
    double weights = 0.0, mass = 0.0, most = 0.0;
    Vec3 way = Vec3::Zero();
    for (std::size_t k = 0; k < N; ++k) {
      weights += inverse_mass_[corners[k]] * shares[k] * shares[k];
      mass += inverse_mass_[corners[k]];
      most = std::max(most, inverse_mass_[corners[k]] * shares[k]);
      way += shares[k] * (x[corners[k]] - was[corners[k]]);
    }
    if (mass == 0.0) return;
    ++*contacts;
    if (weights == 0.0) return;                                 // at a pinned corner exactly
    weights = std::max(weights, most / cloth::k_longest_lever); // near one the others are not thrown
    const Vec3 moved = response(-contact.distance, contact.normal, way, collider.surface_way(contact.t, contact.normal),
                                collider.moved(), collider.push_speed_step, collider.friction);
    for (std::size_t k = 0; k < N; ++k) x[corners[k]] += inverse_mass_[corners[k]] * shares[k] / weights * moved;
  }

  void edge_contact(int a, int b, const TwinCollider& collider, std::int64_t* contacts) {
    if (least_distance(0.5 * (x[a] + x[b]), 0.5 * (x[b] - x[a]).norm(), collider.now) > k_grazing) return;
    const Searched contact = search_edge(x[a], x[b], collider.now, 46); // places to 1e-14
    grazing += std::abs(contact.distance) < k_grazing;
    if (contact.distance < 0.0) spread<2>({a, b}, {1.0 - contact.s, contact.s}, contact, collider, contacts);
  }

  /// An end of the axis over the inside of a triangle: of the points of the plane by least squares the nearest one.
  void face_contact(const std::array<int, 3>& corners, int end, const TwinCollider& collider, std::int64_t* contacts) {
    const Vec3 &origin = x[corners[0]], &centre = end == 0 ? collider.now.a : collider.now.b;
    Eigen::Matrix<double, 3, 2> sides;
    sides << x[corners[1]] - origin, x[corners[2]] - origin;
    const Eigen::Vector2d foot = sides.colPivHouseholderQr().solve(centre - origin);
    const std::array<double, 3> shares = {1.0 - foot.sum(), foot[0], foot[1]};
    if (*std::min_element(shares.begin(), shares.end()) < 0.0) return;
    const Vec3 away = origin + sides * foot - centre;
    const Searched contact{
        away.norm() - collider.now.radius_at(end), {}, static_cast<double>(end), 0.0, away.normalized()};
    grazing += std::abs(contact.distance) < k_grazing;
    if (contact.distance < 0.0) spread<3>(corners, shares, contact, collider, contacts);
  }

  const cloth::Garment* garment_;
  int blocks_, rows_, columns_;
  std::vector<std::vector<int>> columns_of_; ///< each block
  std::vector<double> inverse_mass_;
  std::vector<Edge> warp_, weft_, falling_, rising_; ///< at their upper left particle
  std::vector<cloth::Tether> tethers_;               ///< none where most threads are held
  bool whole_ = true;
};

} // namespace tutu::test
