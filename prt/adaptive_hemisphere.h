// SPDX-License-Identifier: Apache-2.0
// Which part of a hemisphere is blocked, from few rays: they go where the answer changes.
//
// The hemisphere about +Z is a unit square. Its points (u, v) go to the unit disk by the concentric
// map, which keeps areas, and the point (r, phi) of the disk to
//     z = t (1 + t) / 2,  t = 1 - r^2,   d omega = pi (1 + 2 t) du dv,
// at azimuth phi: equal areas of the square are three times as large about the pole as at the
// horizon, where what hides light is, and is flat. With z = t, all areas equal, errors at
// equal rays are 1.6 times as large for visibility, 1.0 to 1.2 times for transfer (24 cells along a
// side, bunny and nefertiti).
//
// prt/border_grid.h finds the borders of what is blocked in the square. They are cut once below a
// lattice of about 16 sqrt(0.0018 / tolerance) cells along a side, placed to 1/8 of a cell, and the
// blocked parts of cells become weighted directions. The error is estimated from what was seen:
//     places    every place of a border is off by the deviation of a uniform number, at random;
//     bends     0.35 of the difference that cutting cells made: borders are not straight;
//     hidden    short runs of blocked or free nodes between others (prt/border_grid.h), which stand
//               for more of their kind that no node met: 0.3 of them where their sum over the
//               hemisphere could be chance, and twice the excess where it is more;
//     prior     0.02 cells at the horizon, for what left no trace at all;
// and 1.15 times their norm, which was fitted to five meshes and to thickets. A thing thinner than
// a cell that no ray met is not in it: of 20 blades that take 2 % of the sky, the estimate at 1e-3
// is a quarter short. Of 49 points of a floor, 4 units wide under 60 poles 1e-3 to 2e-2 thick, 12
// miss the tolerance 3e-2 by up to 1.7 times in visibility, 2 miss 1e-2 by up to 4.6 times, and 1
// misses 3e-3 by 1.1 times.
// As long as the estimate is over the tolerance, the lattice is made twice as fine where the hidden
// part has the larger share of it, else borders are cut once more. Where things are thinner than
// any affordable cell (grass), lines between places miss more than they gain; then the nodes of the
// lattice are counted instead, with an estimate from the number of edges between nodes that differ.
//
// Errors fall like rays^-1.35, those of a fixed number like rays^-0.75 (bunny), as long as borders
// are lines at the scale of a cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>

#include "prt/border_grid.h"
#include "sh/aligned.h"

namespace airlight {

inline constexpr int kFewestAdaptiveRays = 64;

struct AdaptiveOptions {
    int order = 6;
    double tolerance = 1e-3;
    /// A step that is expected to exceed it is not begun; at least kFewestAdaptiveRays.
    int most_rays = 16384;
    bool visibility = true, transfer = true;  ///< which estimates have to meet the tolerance
};

/// Of the error of a row of prt/bake.h, as the norm of its difference from the truth over the norm
/// of the row of an open hemisphere.
struct AdaptiveEstimate {
    double visibility = 0, transfer = 0;
};

/// The direction of the point (u, v) of [0, 1]^2. Its z is 3e-5 or more: rays along the tangent
/// plane itself would be stopped by rounding.
glm::dvec3 adaptive_direction(double u, double v);

/// d omega / (du dv) at a direction's z.
double adaptive_density(double z);

/// Directions that stand for what is blocked, each for its solid angle.
struct BlockedPoints {
    AlignedVector<float> x, y, z, weight;

    std::size_t count() const { return weight.size(); }
    void clear();
    /// The direction of (u, v), for an area of the square about it.
    void add(double u, double v, double area);
};

/// For one thread. Holds arrays that vertices share one after the other; a result depends on the
/// options and on the answers alone. Cost: 0.09 us a ray, without the answers.
class AdaptiveHemisphere {
  public:
    /// Answers which of `count` directions are blocked: writes their numbers to `hits`, ascending,
    /// and returns how many.
    using FindBlocked = std::function<std::size_t(std::size_t count, const float* x, const float* y,
                                                  const float* z, std::uint32_t* hits)>;

    explicit AdaptiveHemisphere(const AdaptiveOptions& options);

    /// Asks until the estimates meet the tolerance or the rays are spent.
    AdaptiveEstimate sample(const FindBlocked& find_blocked);

    /// Of the last call of sample(). Whole cells have as many points as their order needs: what is
    /// all blocked, or all free, is known to 2e-5.
    const BlockedPoints& blocked() const { return points_; }
    std::size_t rays() const { return grid_.asked(); }

  private:
    double worst(const AdaptiveEstimate& estimate) const;
    AdaptiveEstimate estimate_borders(int finished, double* hidden);
    AdaptiveEstimate estimate_counted(int level);
    AdaptiveEstimate sample_borders(const BorderGrid::Ask& ask, int* finished, bool* count);
    void write_points(const BorderGrid::Result& result);
    void write_whole(double u, double v, double edge);

    AdaptiveOptions options_;
    double norm_[2];  ///< of the rows of an open hemisphere
    BorderGrid grid_;
    BorderGrid::Result borders_, counted_;
    BlockedPoints points_;
    AlignedVector<float> x_, y_, z_;
};

}  // namespace airlight
