// Which triangles of a mesh touch: shells, openings, and who is around a vertex.
#pragma once

#include "rig/mesh.h"

#include <span>
#include <vector>

namespace tutu::proxies {

/// Made once from the bind pose. Vertices at the same place there are one "place".
struct MeshTopology {
  int places = 0;
  std::vector<rig::Triangle> corners; ///< triangle: places of its corners
  std::vector<int> around_begin;      ///< places + 1 entries
  std::vector<int> around;         ///< triangles at place p: around[around_begin[p]] .. around[around_begin[p + 1] - 1]
  std::vector<int> shell_of;       ///< triangle: its shell
  std::vector<int> first_of_shell; ///< shells + 1 entries into by_shell
  std::vector<int> by_shell;       ///< triangles, shell after shell, rising in each

  int open_edges = 0, nonmanifold_edges = 0, pinched_vertices = 0;
  int one_sided_edges = 0;             ///< where a surface comes back to itself the other way round (Moebius)
  std::vector<bool> closed, one_sided; ///< shell: each of its edges joins two triangles; it is joined to itself the
                                       ///< other way round somewhere
  std::vector<bool> turned; ///< triangle: runs against most (by number) of those it is joined to by manifold edges

  int shells() const { return static_cast<int>(first_of_shell.size()) - 1; }
  std::span<const int> at(std::uint32_t place) const {
    return {around.data() + around_begin[place],
            static_cast<std::size_t>(around_begin[place + 1] - around_begin[place])};
  }
  std::span<const int> shell(int s) const {
    return {by_shell.data() + first_of_shell[s], static_cast<std::size_t>(first_of_shell[s + 1] - first_of_shell[s])};
  }
};

/// Indices must be in range. Triangles that use a place twice have no edges; they are shells of their own.
MeshTopology find_topology(std::span<const Vec3f> bind_positions, std::span<const rig::Triangle> triangles);

} // namespace tutu::proxies
