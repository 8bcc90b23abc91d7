// The numbers that decide, in one place: unit, reason, and what each must be smaller or larger than.
#pragma once

namespace tutu::cloth {

/// Stretch (length / rest length - 1) of a structural spring at which a run counts as diverged. Larger than anything a
/// loose garment shows (the report's own springs reached 4.6), smaller than what an explosion passes through within a
/// few substeps.
inline constexpr double k_diverged_stretch = 10.0;

/// m. A particle farther from the origin than this has been thrown there: farther than any stage, and near enough for
/// collision queries to be exact to a micrometre.
inline constexpr double k_world_radius = 1e6;

/// m. Least distance a particle may wander from where its candidates were found before they are found again. Larger
/// than a resting particle's tremble, so that still cloth searches once a frame; smaller than a limb, so that
/// candidates stay few.
inline constexpr double k_least_margin = 0.005;

/// How much farther than its speed promises a particle may go within a frame before its candidates are found again. At
/// 1 every accelerating particle would ask twice; beyond 2 the boxes catch colliders that are never met.
inline constexpr double k_margin_growth = 1.5;

/// m. Rounding slack of the "cannot have arrived yet" test: far above the rounding of metre-sized sums of 1e3 steps
/// (1e-13), far below any thickness.
inline constexpr double k_travel_slack = 1e-9;

/// m. The same for a tile of a woven sheet, which asks for many particles at once: a wider margin costs it a box or
/// two, a second search in a frame much more.
inline constexpr double k_least_tile_margin = 0.01;

/// m. Rounding slack of "cannot have arrived yet" for tiles, whose distances may be in single precision: above the
/// rounding of coordinates of two metres (1e-7), below any thickness.
inline constexpr double k_tile_travel_slack = 1e-5;

/// How much longer than at rest a cell may be and still be found by its corners.
inline constexpr double k_cell_stretch = 1.5;

/// m. How far a collider may poke into the middle of a cell whose corners clear it: below what is seen, and below
/// k_most_rise.
inline constexpr double k_tolerated_poke = 0.0003;

/// m. Corners may keep so much more than the cloth's thickness from a collider to meet k_tolerated_poke; where they
/// would have to keep more, the cloth would float, and edges and triangles are asked instead.
inline constexpr double k_most_rise = 0.003;

/// How much longer than at rest a cell is taken to be for that.
inline constexpr double k_worn_cell = 1.15;

/// m/s. A collider and cloth this fast, together, tear cells longer than that for a moment, however short the substeps:
/// up to k_torn_cell times their length at rest. Where it then fits between two corners, all features of the cells near
/// it are asked. Measured with a limb of 12 mm and corners of 26 mm that keep 2 to 16 mm from it: with 5 m/s it slips
/// at 7 m/s, with a factor of 2 at 14 m/s.
inline constexpr double k_hasty_speed = 3.0;
inline constexpr double k_torn_cell = 3.0;

/// m. How deep a feature of the true body may have come through cloth and still be met. Above what one substep of the
/// dance brings (5 mm), below the thickness of an arm.
inline constexpr double k_body_depth = 0.02;

/// How many times as far as a contact point itself its corners may be moved to bring it out. A point beside a pinned
/// corner would throw the free one by any lever. Above what equal masses ask for (1.2), and those of a border (1.9).
inline constexpr double k_longest_lever = 2.0;

/// What a mesh's constraint pulls its edge back to at least, over its length at rest; others of the sweep and contacts
/// may leave it longer [after Provot 1995, Deformation Constraints in a Mass-Spring Model, whose bound is 1.1 for all
/// of cloth's life; no cloth is worn so long]. A blow that is faster than sound in the cloth (16 m/s in a soft one)
/// else stretches it without end, however short the substeps: a limb of 30 m/s to 11 times its length. With 1.5, 2 and
/// 3 that limb is stopped alike.
inline constexpr double k_longest_edge = 2.0;

/// Of its length at rest: no contact makes a thread of pinched cloth longer than that
/// (cloth/contact/between_colliders.h).
inline constexpr double k_pinched_thread = 1.1;

/// m. Where cloth is that much deeper in a collider than this came in the substep, it is looked at whether it is
/// pinched; in the dance it never is.
inline constexpr double k_left_deep = 0.003;

/// Of the way along the cloth: how far from a held particle within a collider cloth can reach out of it. Less than 1,
/// since threads that are straight already pull.
inline constexpr double k_pinched_reach = 0.8;

/// m/s. How fast cloth that began inside a collider is worked out of it: within a second out of any limb, and too slow
/// to be thrown.
inline constexpr double k_push_out_speed = 1.0;

/// m/s. A faster particle has been thrown, by a start in disorder or a jump that was not told: it is slowed to this.
/// Above any limb (a kick reaches 20 m/s).
inline constexpr double k_fastest_particle = 50.0;

/// Edges that turn farther within a substep than to this 1 - cosine (26 degrees), or grow or shrink by such a share,
/// pull where they have come to, not where they were: what holds them by the old direction would hold them by a lever.
/// With 0.03 a sheet that swings from 80 degrees in 6 substeps a frame loses half as much again as with this.
inline constexpr double k_most_turn = 0.1;

/// As do those whose pull, all of the substep's, moves both ends together farther than this share of the length: along
/// the old direction a pull stands no wave across the thread that turns faster than the substep sees, which begins at 2
/// for one thread alone, and as measured at 0.5 in cloth (the tremble of a skirt of 30 x 30 doubles from 0.25 to 1).
/// All of it, so that each step of an iteration has the direction of the one before, without which it does not end.
inline constexpr double k_most_pull = 0.25;

/// m/s. A drape has settled when no particle is faster: 1 mm of creep a second is not seen.
inline constexpr double k_settled_speed = 0.001;

/// How many times a frame that diverged may be taken again, each time with twice the substeps: 64 times as many in the
/// end, which stands springs 4096 times as stiff as the first try did. Beyond it is not the step that is wrong.
inline constexpr int k_recovery_tries = 6;

/// Substeps a frame beyond which no try goes, unless a frame that asks for more itself: 2000 are 120 000 a second, 8
/// microseconds each, in which the stiffest cloth of a centimetre's cells is followed; and a second or so of computing.
inline constexpr int k_most_recovery_substeps = 2000;

/// Frames in a row that may be carried only by taking them for jumps. Cloth that is stopped that often is not simulated
/// any more; few enough that nobody takes it for a run, more than a bad start or a blow needs.
inline constexpr int k_stops_in_a_row = 10;

/// Stretch that mending leaves to an edge: cloth that wears it is far from k_diverged_stretch, and a solver does the
/// rest.
inline constexpr double k_mended_stretch = 0.5;

/// Passes over all edges that mending takes at most. A pass carries a correction from row to row, so more than a fine
/// garment has rows.
inline constexpr int k_mending_passes = 400;

/// Good frames after which the substeps that a recovery left behind are halved: half a second at 60 frames/s, longer
/// than a kick or a landing, so that the same blow is not met unprepared twice.
inline constexpr int k_calm_frames = 30;

/// Share of what is safe that cloth and a collider may move against each other within a substep. Safe is what keeps a
/// particle on its side of the collider's axis; half of it, since constraints and pushes move particles besides.
inline constexpr double k_safe_share = 0.5;

/// Substeps a frame that adaptive substeps never go beyond (a scene may ask for more itself). At 60 frames/s a limb of
/// 6 cm is then safe up to 180 m/s: beyond it is no motion but a jump.
inline constexpr int k_most_adaptive_substeps = 100;

/// Distance that particles of a garment keep from each other, over the covering radius of its cells: above k_worn_cell,
/// or stretched cells would let a particle through; below sqrt(2), at which neighbours in a square cell would touch.
inline constexpr double k_cover = 1.25;

/// Share of that distance which must be left to a pair, one pass of pushing being inexact, for self-collision to claim
/// its bound. Above k_worn_cell / k_cover.
inline constexpr double k_held = 0.95;

/// Particles closer at rest than this many times the distance they keep belong to one patch of cloth: above the
/// diagonal of a square cell, 2 / k_cover = 1.6; below two of its sides, 2.26, so that a fold is seen.
inline constexpr double k_same_patch = 2.0;

/// How much beyond the distance it keeps, over that, a pair is looked at in a substep: a push of one pair may bring
/// another nearer by so much. More would be asked in vain.
inline constexpr double k_near = 0.1;

/// Passes over touching pairs a substep: the second mends what the first one's pushes did to each other.
inline constexpr int k_self_passes = 2;

/// The way in a substep, over the distance it keeps, beyond which a particle has been thrown. At 10 substeps a frame
/// and 1 cm, 16 m/s against the rest of the garment.
inline constexpr double k_farthest_way = 3.0;

/// How far the way that slowed particles are given may be from the garment's mean way, over the least distance kept:
/// what is slowed then stays within k_most_room.
inline constexpr double k_most_off = 2.0;

/// Substeps that the candidates of self-collision are meant to last where cloth is fast (more cost more than they
/// save), and the least and most room (over the distance kept) they are given for it. The cost rises with the square of
/// the room; flat cloth has no candidates up to 0.58. The most must not be below k_farthest_way.
inline constexpr double k_substeps_a_search = 1.3, k_least_room = 0.5, k_most_room = 3.0;

/// Coulomb coefficient of cloth on cloth: woven cotton on itself measures 0.2 to 0.5.
inline constexpr double k_cloth_friction = 0.3;

} // namespace tutu::cloth
