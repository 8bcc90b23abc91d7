// The inner loops of cloth made of threads, on plain arrays: what WovenSheet hands to the code that is compiled once
// for each SIMD target, in float and in double. Private to the folder.
//
// Layout. Columns are dealt to k_lanes lanes in runs of neighbours, one a block. The 16 columns of a block are
// therefore far apart on the sheet and share no constraint, and the weft neighbour of a whole block is simply the next
// block. Element (block, row, lane) of an array is at block * block_stride + row * k_lanes + lane. The neighbour of the
// last block is block 0 with its lanes turned by one: two blocks behind the last (halo 0 and 1) are room for copies of
// block 0 and 1 turned so.
//
// A ring whose columns the lanes do not divide has runs of `blocks` columns in its first `long_lanes` lanes, and one
// less in the others, the short ones. What comes after a short run stands one block nearer: its place in the last block
// holds, while constraints that reach there are solved, a copy of (block 0, next lane), and halo 0 one of (block 1,
// next lane). For the rest of the time, and for all that begins at the last block, these places hold no cloth.
//
//   11 columns, 3 lanes:  block   0  1  2  3  halo 0  1
//                         lane 0  0  1  2  3       4  5    long
//                         lane 1  4  5  6  7       8  9    long
//                         lane 2  8  9 10 (0)     (1)      short
//
// Lanes without a column hold copies of lane 0 at rest with inverse mass 0; constraints that do not exist have the
// compliance k_no_constraint.
//
// Arithmetic: each lane is computed by the same operations in the same order on every target, none of them approximate,
// and no lane decides for another. Products are fused with sums where the target can: the bits are the same on all
// targets that fuse (x86: from AVX2 on) and on all that do not, whatever their width.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace tutu::cloth {

inline constexpr int k_lanes = 16;
/// m/N; over any real one by fifteen orders, and over the square of the smallest substep a number in float.
inline constexpr double k_no_constraint = 1e24;

/// One number an element. A sheet whose rows are uniform stores one block for all (block_stride 0).
template <class T> struct WovenTable {
  const T* data = nullptr;
  std::ptrdiff_t block_stride = 0;
};

/// Springs of one direction: rest lengths (m) and compliances (m/N).
template <class T> struct WovenSprings { WovenTable<T> length, compliance; };

/// Curvature along threads, element (block, row) the middle of three: c = (x_next - x) * ratio - (x - x_previous),
/// ratio the rest length of the first edge over that of the second.
template <class T> struct WovenBends { WovenTable<T> ratio, compliance; };

/// A free particle keeps within `length`, m, of a pinned one: `anchor` is the latter's element. One entry an element of
/// the view; far longer than any sheet where there is no tether.
template <class T> struct WovenTethers {
  using Element = std::conditional_t<sizeof(T) == sizeof(std::int32_t), std::int32_t, std::int64_t>; ///< as wide as T
  const T* length = nullptr; ///< null: no particle has one
  const Element* anchor = nullptr;
};

/// A sheet. Positions are in metres from an origin near the garment; arrays are aligned to 64 bytes.
template <class T> struct WovenSheetView {
  int rows = 0, blocks = 0, lanes = 0;
  int long_lanes = 0; ///< lanes, the first, that have a column in the last block too; `lanes` in all but some rings
  std::ptrdiff_t block_stride = 0;
  T* x[3] = {};                   ///< positions, m
  T* was[3] = {};                 ///< positions at the substep's start
  T* v[3] = {};                   ///< velocities, m/s
  WovenTable<T> inverse_mass;     ///< 1/kg; 0 for pinned particles; copies have that of what they are of
  WovenTable<T> own_inverse_mass; ///< the same but 0 for copies: for motion and contacts, which are not theirs
  WovenSprings<T> warp;           ///< (block, row) joins row and row + 1
  WovenSprings<T> weft;           ///< (block, row) joins block and block + 1
  WovenSprings<T> falling;        ///< (block, row) joins it and (block + 1, row + 1)
  WovenSprings<T> rising;         ///< (block + 1, row) and (block, row + 1)
  WovenBends<T> warp_bend, weft_bend;
  bool has_shear = false, has_bend = false;
  WovenTethers<T> tethers;
  T* multipliers[4] = {}; ///< of warp, weft, falling, rising; those of diagonals only for more than one pass
  T* workspace = nullptr; ///< 6 blocks, for the line solve
};

/// Lanes, the first, that have a column in this block.
template <class T> int lanes_in(const WovenSheetView<T>& sheet, int block) {
  return block + 1 == sheet.blocks ? sheet.long_lanes : sheet.lanes;
}
template <class T> bool has_short_lanes(const WovenSheetView<T>& sheet) { return sheet.long_lanes < sheet.lanes; }

/// Whether cells right of the block's columns reach a copy.
template <class T> bool needs_halo(const WovenSheetView<T>& sheet, int block) {
  return block + (has_short_lanes(sheet) ? 2 : 1) >= sheet.blocks;
}

template <class T> struct WovenStep {
  T h = 0;                  ///< s
  T gravity[3] = {};        ///< m/s2
  T kept = 1;               ///< share of the velocity that drag leaves in h
  T taken = 1, elastic = 0; ///< as those of DampedStep (cloth/damping.h)
  T fastest = 0;            ///< m/s; faster particles are slowed to this
  int passes = 1;           ///< over all constraints
  int weft_sweeps = 2;      ///< Gauss-Seidel over the weft edges, a pass, back and forth, beyond the first
  int newton_steps = 2;     ///< of each thread's line solve, a pass
  int closing_sweeps = 1;   ///< Gauss-Seidel over the warp edges after it
};

/// The air of a substep: AirInStep of cloth/air/air_inl.h in plain numbers.
template <class T> struct WovenAir {
  T pressure = 0, lift = 0, friction = 0; ///< kg s/m3
  T wind[3] = {};                         ///< m/s
};

/// Rows first..last-1 of one block.
struct WovenRows {
  int block = 0, first = 0, last = 0;
};

/// How a surface treats what it meets.
template <class T> struct WovenSurface {
  T friction = 0;
  T moved = 0;           ///< m its fastest point moved since the substep's start
  T push_speed_step = 0; ///< m a point may be pushed beyond what it and the surface moved: h * push-out speed
};

/// A placed collider. With no direction (a == b) it is a sphere. A capsule whose one end ball holds the other comes as
/// that ball.
template <class T> struct WovenCollider : WovenSurface<T> {
  T a[3] = {}, axis[3] = {};           ///< axis = b - a, m
  T per_axis_squared = 0;              ///< 1 / |axis|^2; 0 for a sphere
  T radius = 0;                        ///< at a, with the contact offset, m
  T taper = 0;                         ///< added by b, m
  T lean = 0;                          ///< taper / (|axis| sqrt(|axis|^2 - taper^2)), 1/m
  T move_a[3] = {}, move_axis[3] = {}; ///< since the substep's start: of a, and of b less that of a
  T spin[3] = {};                      ///< rotation vector since then about the own axis (a sphere: about any), rad
  T on_axis[3] = {};                   ///< normal for points on the axis
};

/// Which features of a cell are asked besides its corners.
struct CellFeatures {
  bool wide = false; ///< weft edges and diagonals
  bool high = false; ///< warp edges and faces as well
};

/// Rows of a tile that a collider is near to, for who asks about their cells next: pinned particles too.
template <class T> struct WovenMarks {
  T within = 0;                 ///< m from the collider's surface (with the offset and `rise`)
  std::uint8_t* rows = nullptr; ///< one a row, from the first: set to whether a particle of it is
  T nearest = 0;                ///< m, set to how far the nearest is
};

/// The half space normal . x <= offset.
template <class T> struct WovenPlane : WovenSurface<T> {
  T normal[3] = {};
  T offset = 0; ///< with the contact offset, m
};

/// A point of the cloth that was pushed, for who watches: ClothContact in plain numbers, elements for particles.
template <class T> struct WovenHit {
  std::ptrdiff_t cell = 0;                  ///< the element whose turn it was
  std::ptrdiff_t corners[3] = {-1, -1, -1}; ///< elements, halo included
  T weights[3] = {}, levers[3] = {};
  T point[3] = {}, normal[3] = {}, moved[3] = {}; ///< m from the view's origin; unit; m
  T depth = 0, push = 0; ///< m, inside the collider with its offset and `rise`; m along the normal
};

/// What a call met. Lanes come in the order of the elements within a vector, so that those of one cell come in order on
/// every target, but cells do not.
template <class T> struct WovenHits {
  std::int64_t count = 0;
  void (*keep)(void* keeper, const WovenHit<T>&) = nullptr; ///< null: nobody watches
  void* keeper = nullptr;
};

template <class T>
using WovenFinish = T (*)(const WovenSheetView<T>&, const WovenStep<T>&, int block, int first, int last);

/// One target's functions. Those with `first` and `last` work on rows first..last-1 of one block.
template <class T> struct WovenKernel {
  using Sheet = const WovenSheetView<T>&;
  using Step = const WovenStep<T>&;

  const char* target; ///< as Highway calls it

  /// v of free particles takes what the air takes from the triangles of each cell, block by block.
  void (*air)(Sheet, const WovenAir<T>&);
  /// x goes to was and moves on by h v, v having taken gravity and drag. Pinned particles stay.
  void (*predict)(Sheet, Step);
  /// Bending, tethers, then all passes over the springs. False when an edge or a taut tether was longer than (1 +
  /// k_diverged_stretch) of its length, or an edge no number.
  bool (*constraints)(Sheet, Step);
  /// The same once more for a substep in which it was false, from where constraints() began: ends, false, with the
  /// positions that the first broken edge was met in. `room` is for `6 * block_stride` numbers.
  bool (*constraints_to_break)(Sheet, Step, T* room);
  /// Undoes what was done to predict()'s positions since, from was and v; pinned particles are where they were.
  void (*predict_again)(Sheet, Step);
  /// Largest squared way since the substep's start, m2; not a number when any is not.
  T (*farthest)(Sheet, int block, int first, int last);
  /// v takes what constraints and contacts did to the prediction. Returns the largest squared way since the substep's
  /// start, m2.
  WovenFinish<T> finish;
  WovenFinish<T> finish_and_predict; ///< both in one go
  /// Lowest and highest coordinates, 3 numbers each.
  void (*bounds)(Sheet, int block, int first, int last, T* low, T* high);

  /// Pushes free particles out of a collider and rubs. Returns the smallest distance of a free one to the surface (with
  /// the offset) before that, m, marks rows (null: none), and adds to `hits`. `rise` adds to the collider's radius.
  T(*contact_capsule)
  (Sheet, const WovenRows&, const WovenCollider<T>&, T rise, WovenMarks<T>* marks, WovenHits<T>* hits);
  T (*contact_plane)(Sheet, const WovenRows&, const WovenPlane<T>&, WovenHits<T>* hits);

  /// Edges and faces of the cells between a block and the next, from row `first` to the one below `last` - 1, of rows
  /// that are `asked`, one number a row; cells no corner of which can reach the collider are passed over. Before
  /// those of the first block that needs_halo() the halo must be fetched (positions and starts), and given back after
  /// the last block's.
  void (*fetch_halo)(Sheet);
  void (*contact_cells)(Sheet, const WovenRows&, const WovenCollider<T>&, CellFeatures features,
                        const std::uint8_t* asked, WovenHits<T>* hits);
  void (*return_halo)(Sheet);
};

/// For the best target of this processor (or the one that a test has chosen). T: float, double.
template <class T> WovenKernel<T> woven_kernel();
template <> WovenKernel<float> woven_kernel<float>();
template <> WovenKernel<double> woven_kernel<double>();

} // namespace tutu::cloth
