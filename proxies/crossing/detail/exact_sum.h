// Sums of products of doubles without error, for their sign alone.
#pragma once

#include <array>
#include <cmath>

namespace tutu::proxies {

/// a - b exactly: head is the rounded difference, tail what rounding lost.
struct ExactDifference {
  double head, tail;
};

/// Two-Diff [Knuth; Shewchuk 1997, theorem 7]: exact for all finite doubles whose difference is finite, rounded to
/// nearest.
inline ExactDifference exact_difference(double a, double b) {
  const double head = a - b;
  const double virtual_b = a - head, virtual_a = head + virtual_b;
  return {head, (a - virtual_a) + (virtual_b - b)};
}

/// A sum kept as doubles that do not overlap, in order of size [Shewchuk 1997, Adaptive Precision Floating-Point
/// Arithmetic and Fast Robust Geometric Predicates]. It is exact as long as no product overflows and all factors are
/// multiples of 2^-340, so that no bit of a product of three falls below the least double.
class ExactSum {
public:
  /// Grow-Expansion [Shewchuk 1997, theorem 10], zeros left out.
  void add(double b) {
    double q = b;
    int kept = 0;
    for (int k = 0; k < count_; ++k) {
      const double sum = q + terms_[k]; // Two-Sum [theorem 7]
      const double virtual_term = sum - q, virtual_q = sum - virtual_term;
      const double lost = (q - virtual_q) + (terms_[k] - virtual_term);
      if (lost != 0.0) terms_[kept++] = lost;
      q = sum;
    }
    if (q != 0.0) terms_[kept++] = q;
    count_ = kept;
  }

  void add_product(double a, double b) {
    const double head = a * b;
    if (head == 0.0) return;
    add(std::fma(a, b, -head));
    add(head);
  }

  void add_product(double a, double b, double c) {
    const double head = a * b;
    add_product(std::fma(a, b, -head), c);
    add_product(head, c);
  }

  /// The largest term outweighs all others together.
  int sign() const {
    if (count_ == 0) return 0;
    return terms_[count_ - 1] > 0.0 ? 1 : -1;
  }

private:
  /// As many as are ever added: six products of three differences, of two doubles each, are 6 * 8 * 4.
  std::array<double, 192> terms_;
  int count_ = 0;
};

} // namespace tutu::proxies
