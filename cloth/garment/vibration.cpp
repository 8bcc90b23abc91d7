#include "cloth/garment/vibration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace tutu::cloth {
namespace {

/// Steps of Lanczos: the top of a woven sheet's spectrum is crowded, and after so many its largest value has four
/// digits.
constexpr int k_lanczos_steps = 80;

/// M^-1/2 K M^-1/2 of a garment at rest, over the particles that move.
class Stiffness {
public:
  explicit Stiffness(const Garment& garment) {
    const std::vector<int> place = places(garment);
    root_masses_.assign(static_cast<std::size_t>(count_), 0.0);
    for (int i = 0; i < garment.particle_count(); ++i)
      if (place[i] >= 0) root_masses_[place[i]] += garment.masses[i];
    for (double& mass : root_masses_) mass = std::sqrt(mass);
    for (const Spring& spring : garment.springs) {
      const int i = place[spring.i], j = place[spring.j];
      if (i == j) continue; // both held, or the sides of one seam
      rows_.push_back({i, j,
                       std::sqrt(spring.stiffness) *
                           (garment.rest_positions[spring.j] - garment.rest_positions[spring.i]).normalized()});
    }
  }

  int size() const { return rows_.empty() ? 0 : 3 * count_; }

  Eigen::VectorXd times(const Eigen::VectorXd& x) const {
    Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
    for (const Row& row : rows_) {
      Vec3 elongation = Vec3::Zero();
      if (row.j >= 0) elongation += x.segment<3>(3 * row.j) / root_masses_[row.j];
      if (row.i >= 0) elongation -= x.segment<3>(3 * row.i) / root_masses_[row.i];
      const Vec3 pull = row.along.dot(elongation) * row.along;
      if (row.j >= 0) y.segment<3>(3 * row.j) += pull / root_masses_[row.j];
      if (row.i >= 0) y.segment<3>(3 * row.i) -= pull / root_masses_[row.i];
    }
    return y;
  }

private:
  struct Row { ///< a spring: its ends, -1 where they are held, and sqrt(k) n
    int i, j;
    Vec3 along;
  };

  /// Where each particle is among those that move: -1 when it is held, by a pin or by a seam to one that is.
  std::vector<int> places(const Garment& garment) {
    std::vector<std::uint8_t> held = pinned_flags(garment);
    std::vector<int> leader(held.size());
    for (std::size_t i = 0; i < leader.size(); ++i) leader[i] = static_cast<int>(i);
    for (const Seam& seam : garment.seams) {
      const int from = std::max(leader[seam.i], leader[seam.j]), to = std::min(leader[seam.i], leader[seam.j]);
      for (int& l : leader)
        if (l == from) l = to;
      held[to] = held[to] || held[from];
    }
    std::vector<int> place(held.size(), -1);
    for (std::size_t i = 0; i < place.size(); ++i) {
      const int l = leader[i]; // never above i, so it has its place already
      if (!held[l]) place[i] = l == static_cast<int>(i) ? count_++ : place[l];
    }
    return place;
  }

  int count_ = 0;
  std::vector<double> root_masses_; ///< sqrt(kg)
  std::vector<Row> rows_;
};

Eigen::VectorXd random_unit(int size) {
  std::mt19937_64 random(1);
  Eigen::VectorXd v(size);
  for (double& x : v) x = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
  return v.normalized();
}

} // namespace

double fastest_vibration(const Garment& garment) {
  const Stiffness stiffness(garment);
  if (stiffness.size() == 0) return 0.0;
  std::vector<double> diagonal, beside;
  Eigen::VectorXd last = Eigen::VectorXd::Zero(stiffness.size()), now = random_unit(stiffness.size());
  double coupling = 0.0;
  for (int k = 0; k < std::min(k_lanczos_steps, stiffness.size()); ++k) {
    Eigen::VectorXd next = stiffness.times(now) - coupling * last;
    diagonal.push_back(next.dot(now));
    next -= diagonal.back() * now;
    coupling = next.norm();
    if (!(coupling > 1e-12 * diagonal.front())) break; // the space is exhausted
    beside.push_back(coupling);
    last = now;
    now = next / coupling;
  }
  beside.resize(diagonal.size() - 1);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(diagonal.data(), std::ssize(diagonal)),
                                Eigen::Map<Eigen::VectorXd>(beside.data(), std::ssize(beside)), Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

} // namespace tutu::cloth
