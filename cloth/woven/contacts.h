// Which tiles of a woven sheet meet which colliders, and when each pair has to be looked at. Private to the folder.
#pragma once

#include "cloth/state/frame.h"
#include "cloth/state/solver_options.h"
#include "cloth/woven/hit_keeper.h"
#include "cloth/woven/pinched.h"
#include "cloth/woven/sheet.h"
#include "proxies/query/collision_query.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tutu::cloth {

/// For backends that leave contacts to who asks (CollisionQuery::leaves_contacts): boxes of tiles against the swept
/// boxes of colliders once a frame, the closed forms for whole vectors in each substep.
///
/// A tile is some rows of one block. Pairs that cannot have met since they were last measured are skipped, exactly:
/// distance is 1-Lipschitz, so a pair at distance d stays apart until the tile's fastest particle and the collider have
/// together travelled d. The same sum says when the frame's boxes no longer cover a tile; then it looks for colliders
/// anew.
inline constexpr int k_tile_rows =
    8; ///< of 16 particles: small enough for few colliders, large enough to ask once for many

template <class T> class WovenContacts {
public:
  /// `sheet`: of the garment, for its blocks.
  WovenContacts(const Garment& garment, const SolverOptions& options, const WovenSheet<T>& sheet);

  /// The cloth was put elsewhere: its speed so far says nothing, and whether it was pinched.
  void forget() {
    for (Tile& tile : tiles_) {
      tile.speed = 0.0;
      tile.pinched = 0;
    }
  }

  void begin_frame(proxies::CollisionQuery& query, const FrameInput& input, const WovenSheet<T>& sheet);

  /// Puts the colliders to `s` in (0, 1] of the frame, `h` seconds after the last call, and pushes the cloth out of
  /// them. Returns false when a particle's place is no number.
  bool resolve(proxies::CollisionQuery& query, const WovenKernel<T>& kernel, WovenSheet<T>& sheet, double s, double h);

  /// After resolve: velocities by `kernel`, and how far each tile went. Returns false like resolve.
  bool finish(WovenFinish<T> kernel, const WovenSheetView<T>& view, const WovenStep<T>& step);
  double fastest() const; ///< m/s, of any particle as of the last finish(); what is no number does not count

  const ContactCounts& counts() const { return counts_; }
  BroadPhaseView broad_phase() const { return {boxes_, candidates_.begin, candidates_.colliders}; }

private:
  struct Tile {
    WovenRows rows;
    double weft = 0.0, warp = 0.0; ///< m, the longest of a cell's edges at rest
    double reach = 0.0;            ///< m: no point of a cell is farther from a corner
    double margin = 0.0;           ///< m its particles may go before colliders are looked for again
    double travelled = 0.0;        ///< m since then, of its fastest particle
    double way = 0.0;              ///< m in this substep, before contacts
    double speed = 0.0;            ///< m/s in the last one
    bool touched = false;          ///< in this substep
    int pinched = 0;               ///< substeps that it is still settled one by one (contacts.cpp)
  };
  struct Pair {
    int collider = 0;
    T rise = 0; ///< m
    CellFeatures features;
    double within = 0.0;       ///< m: only cells with a corner so near to the surface may meet it
    bool fits_through = false; ///< the collider, between two corners that a blow tears apart
    bool in_haste = false;     ///< in this substep
    double wake = 0.0;         ///< sum of travels at which the two may meet,
    double cells_wake = 0.0;   ///< and at which its cells may
  };

  void find_pairs(proxies::CollisionQuery& query, const WovenSheet<T>& sheet);
  void place(const Vec3& origin, double s, double h);
  void sweep(WovenSheet<T>& sheet, const Tile& tile, const Pair& pair);
  /// What may be a pinched tile; false where it is not, and nothing was done.
  bool settle(WovenSheet<T>& sheet, std::size_t t, double h);
  void spread_pinches();
  bool is_pinched_around(std::size_t t) const;
  std::uint8_t* marks_of(const WovenSheetView<T>& view, int collider, int block) {
    return marks_.data() + static_cast<std::ptrdiff_t>(collider * view.blocks + block) * view.rows;
  }
  /// Into asked_rows_; false where there are none.
  bool find_asked_rows(const WovenSheetView<T>& view, const Tile& tile, const Pair& pair);
  void resolve_cells(const WovenKernel<T>& kernel, const WovenSheetView<T>& view);
  void take(const Pair& pair, double rise); ///< what a call met, for who watches
  /// How the cells of a tile are kept from a collider of this radius.
  Pair pair_of(const Tile& tile, int collider) const;

  double offset_ = 0.0; ///< m, what particles keep from colliders
  ContactFeatures features_ = ContactFeatures::automatic;
  bool swept_ = true;
  std::vector<Tile> tiles_; ///< block by block, down each
  std::size_t tiles_per_block_ = 0;
  std::vector<proxies::Box> boxes_;
  proxies::Candidates candidates_;
  std::vector<int> begin_; ///< of each tile in pairs_; tiles + 1 entries
  std::vector<Pair> pairs_;

  const FrameInput* input_ = nullptr;
  std::vector<proxies::Capsule> placed_, placed_before_;
  std::vector<WovenCollider<T>> colliders_;
  std::optional<WovenPlane<T>> ground_;
  std::vector<double> collider_travel_; ///< m since pairs were found; the ground, last, stays at 0
  /// Of each collider, block and row: whether a particle of it is within what may let its cells meet the collider, in
  /// this substep. Particles that other colliders push there later in it are met in the next.
  std::vector<std::uint8_t> marks_;
  bool any_wide_ = false; ///< of the pairs: else nobody marks anything
  std::array<std::uint8_t, k_tile_rows> asked_rows_ = {};
  double s_before_ = 0.0, s_step_ = 0.0; ///< of the frame
  PinchedCloth<T> pinched_cloth_;
  std::vector<AskedCollider> asked_;
  HitKeeper<T> keeper_;
  ContactCounts counts_;
};

} // namespace tutu::cloth
