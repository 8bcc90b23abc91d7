// A garment of threads as the kernels want it: columns in lanes, one array a coordinate. Private to the folder.
#pragma once

#include "cloth/garment/garment.h"
#include "cloth/state/particles.h"
#include "cloth/woven/kernel.h"

#include <memory>
#include <span>
#include <vector>

namespace tutu::cloth {

/// Memory aligned for any vector. Sized once.
template <class T> class AlignedArray {
public:
  explicit AlignedArray(std::size_t count = 0);
  T* data() const { return data_.get(); }

private:
  struct Free {
    void operator()(T* p) const;
  };
  std::unique_ptr<T[], Free> data_;
};

/// Which way a garment lies in a view. Threads solved as wholes run along the view's columns; they are to run to where
/// the cloth is held.
struct Weave {
  explicit Weave(const Garment& garment);

  bool turned = false; ///< the garment's rows are the view's columns
  int rows = 0, columns = 0;

  int row(int particle) const { return turned ? particle % rows : particle / columns; }
  int column(int particle) const { return turned ? particle / rows : particle % columns; }
  int particle(int row, int column) const { return turned ? column * rows + row : row * columns + column; }
};

/// Owns what a WovenSheetView shows. Every particle of a garment with rows and columns has its element; the garment
/// must outlive the sheet.
template <class T> class WovenSheet {
public:
  /// `with_multipliers`: a substep will have more than one pass.
  WovenSheet(const Garment& garment, bool with_multipliers);

  const WovenSheetView<T>& view() const { return view_; }
  const Weave& weave() const { return weave_; }
  const Vec3& origin() const { return origin_; } ///< of the view's positions, world, m; whole metres

  /// Puts particles there; the origin follows them.
  void set(std::span<const Vec3> positions, std::span<const Vec3> velocities);
  void get(Particles& out) const;
  void get_positions(std::span<Vec3> out) const;
  void get_starts(std::span<Vec3> out) const; ///< positions at the substep's start

  /// Once a frame: keeps coordinates small when the garment has travelled, and takes lanes without a column along.
  void follow();

  std::ptrdiff_t element_of(int particle) const { return elements_[particle]; }
  /// One an element, copies behind the lanes' ends too: of what they copy. -1 where there is no cloth.
  std::vector<int> particles_of_elements() const;
  Vec3 position(int particle) const { return at(view_.x, particle) + origin_; }
  Vec3 start_position(int particle) const { return at(view_.was, particle) + origin_; }
  double inverse_mass(int particle) const;  ///< 1/kg, 0 for pinned particles
  int column_of(int block, int lane) const; ///< of the weave; -1 where there is none
  /// Calls visit(particle) for the free ones of rows of a block, row by row.
  template <class Visit> void for_free(const WovenRows& rows, const Visit& visit) const {
    for (int row = rows.first; row < rows.last; ++row)
      for (int lane = 0; lane < view_.lanes; ++lane) {
        const int column = column_of(rows.block, lane);
        if (column < 0) continue;
        if (const int i = weave_.particle(row, column); inverse_mass(i) > 0.0) visit(i);
      }
  }
  bool is_ring() const { return garment_->woven_shut; }
  void move_to(int particle, const Vec3& position);
  void move_start_to(int particle, const Vec3& position); ///< where the substep began
  /// As a pinned particle: at `position` with the velocity that takes it there in h.
  void pin_to(int particle, const Vec3& position, double h);
  void set_velocity(int particle, const Vec3& velocity);
  /// Back to the positions at the substep's start.
  void take_back();
  /// Both at one point between them: the first's place at a share of 0, the second's at 1.
  void join(int first, int second, T share_of_second);

private:
  Vec3 at(T* const* field, int particle) const;
  void put(T* const* field, int particle, const Vec3& position);
  void build_springs(const Garment& garment);
  void build_bends(const Garment& garment);
  void place_tethers(const Garment& garment);
  WovenTable<T> table(std::vector<T> values);

  const Garment* garment_;
  Weave weave_;
  WovenSheetView<T> view_;
  Vec3 origin_ = Vec3::Zero();
  std::vector<std::ptrdiff_t> elements_;      ///< one a particle
  std::vector<std::ptrdiff_t> empty_, twins_; ///< elements without a particle, and whose places they take
  std::vector<AlignedArray<T>> arrays_;
  AlignedArray<typename WovenTethers<T>::Element> anchors_;
};

} // namespace tutu::cloth
