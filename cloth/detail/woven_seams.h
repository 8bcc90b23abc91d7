// The seams of a woven sheet. Private to the folder.
#pragma once

#include "cloth/woven/sheet.h"

#include <vector>

namespace tutu::cloth {

/// A seam joins columns that the kernel solves apart: each side follows its own threads, and where they pull against
/// each other, putting both in the middle gives back all that the threads had found, substep after substep. So once
/// they are joined the threads around a seam (up to k_seam_reach from it) are brought back to the lengths they were
/// left at, which hold what elasticity and damping there are, by Gauss-Seidel over particles of which two sewn are one.
template <class T> class WovenSeams {
public:
  static constexpr int k_seam_reach = 2; ///< threads. With 1 the next ones below a slit are torn in place of the first
  static constexpr int k_sweeps = 2;

  explicit WovenSeams(const Garment& garment);

  /// Puts both sides of each seam where they meet.
  void join(WovenSheet<T>& sheet) const;
  /// The same once the constraints were solved, and the threads around as they were then.
  void close(WovenSheet<T>& sheet);

private:
  /// A free particle, or two that are sewn.
  struct Node {
    int particle = 0, sewn = -1;
    double inverse_mass = 0.0; ///< 1/kg; 0: pinned
    Vec3 x;
  };
  struct Thread {
    int i = 0, j = 0; ///< particles,
    int a = 0, b = 0; ///< and their nodes
    double length = 0.0;
  };

  const Garment* garment_;
  std::vector<T> shares_; ///< of each seam
  std::vector<Node> nodes_;
  std::vector<Thread> threads_;
};

} // namespace tutu::cloth
