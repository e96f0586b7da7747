// SPDX-License-Identifier: Apache-2.0
// Directions of the hemisphere that are drawn anew for each vertex: the rungs below Fibonacci's.
//
// All three put points (u, v) of the unit square at z = 1 - u, azimuth 2 pi v, which keeps areas.
// Their randomness is a hash of the vertex's number in the file, so that neighbours do not share
// their error and a vertex has the same directions whichever thread, shard or run bakes it. They
// fill the out.count() directions of `out`, unit to 1e-6, z > 0; each stands for the solid angle
// 2 pi / count. 8, 9 and 13 ns a direction.
//
// Errors stand beside those of fibonacci_hemisphere() in prt/bake.h.
#pragma once

#include <cstdint>

#include "prt/hemisphere.h"

namespace airlight {

/// Independent, uniform.
void random_hemisphere(std::uint32_t vertex, HemisphereDirections& out);

/// One point, uniform, in each of `count` cells of equal area and about equal sides: rows of u,
/// round(sqrt(count / 2 pi)) of them, each cut into cells of v.
void stratified_hemisphere(std::uint32_t vertex, HemisphereDirections& out);

/// The first `count` points of Sobol's sequence in its first two dimensions, scrambled as Owen
/// does: each binary digit of u and of v is flipped by a hash of the digits before it. For count =
/// 2^k every elementary interval of area 2^-k of the square has one point; after N points the
/// mean square error of a smooth function falls like N^-3, of what has an edge like N^-3/2.
void owen_sobol_hemisphere(std::uint32_t vertex, HemisphereDirections& out);

}  // namespace airlight
