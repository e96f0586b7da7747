// SPDX-License-Identifier: Apache-2.0
// Precomputed radiance transfer of the vertices of a mesh.
//
// Of a vertex with unit normal n that sees the distant light of directions omega with V = 1, and
// with V = 0 where anything hides it (prt/ray_scene.h), in the world frame of sh/basis.h:
//     visibility             v_lm = int_{n omega > 0} V Y_lm d omega
//     transfer               t_lm = (1/pi) int V max(0, n omega) Y_lm d omega
//     unshadowed transfer    the same with V = 1
//     ambient occlusion      (1/pi) int V max(0, n omega) d omega = sqrt(4 pi) t_00, in [0, 1]
//     bent normal            int_{n omega > 0} V omega d omega, as a unit vector
// Exit radiance of a Lambertian surface is albedo · sum t_lm L_lm, so a white sky of radiance 1
// gives ambient occlusion ([Sloan02] section 4; [Sun05] section 6.5, [Zhou07] section 4.2 multiply
// it by fog). Order n means l < n, slots as in sh/index.h.
//
// V is sampled at `rays` spherical Fibonacci points of the hemisphere over the vertex
// (prt/hemisphere.h). Without V both integrands are zonal about n and known in closed form, so only
// the directions that are blocked are summed, and taken off:
//     v = c (n) - (2 pi / N) sum_blocked Y,  c_l0 = sqrt(pi (2l+1)) int_0^1 P_l,
//     t = a (n) / pi - (2 / N) sum_blocked (n omega) Y,  a the clamped cosine of sh/lobes.h.
// Where nothing is blocked the result is exact to float.
//
// Light that comes back from other parts of the scene is one more term of transfer: with rho and
// t the albedo and the transfer of the nearest point q on the ray, t interpolated between the
// corners of its triangle ([Sloan02] section 4),
//     (B t)_lm = (1/pi) int (1 - V) max(0, n omega) rho(q) t_lm(q) d omega
// over the directions that were found blocked, so nothing else changes. b bounces are b + 1 passes,
// t_k = t_0 + B t_{k-1} (prt/bake_scene.h makes them). Backs of triangles and the ground are black.
//
// Error, relative RMS over 512 vertices at order 6 against 65536 rays, and CPU time of a vertex
// (bench/bake_bench.cpp --vertices 512 --truth 65536; of bunny 15 % of the rays are blocked, of
// nefertiti 10 %):
//     rays                      512    1024    2048    4096    8192
//     visibility, bunny       0.0151  0.0086  0.0051  0.0030  0.0018
//                 nefertiti   0.0135  0.0077  0.0046  0.0026  0.0015
//     transfer,   bunny       0.0083  0.0049  0.0030  0.0018  0.0011
//                 nefertiti   0.0057  0.0033  0.0022  0.0012  0.0007
//     us                        50      95     185     360     700
// The rays are 95 to 97 % of the time of 1024: 0.08 to 0.13 us each, twice as fast as one by one.
// Other choices of directions, transfer of a sphere with hollows, 17 % of the rays blocked
// (airlight ladder transfer; docs/ladder), and their time over Fibonacci's at equal rays:
//     rays                      256    1024    4096   16384    time
//     fibonacci              0.0125  0.0044  0.0017  0.0006    1
//     owen-sobol             0.0168  0.0059  0.0020  0.0007    1.2-1.35
//     stratified             0.0235  0.0081  0.0028  0.0010    1.05-1.15
//     random                 0.0529  0.0262  0.0130  0.0064    1.1-1.25
//
// The method adaptive (prt/adaptive_hemisphere.h), 96 vertices against 262144 rays, beside the fixed
// number of rays in the same run:
//     tolerance                  3e-3     1e-3     5e-4         16384 fixed rays
//     rays, bunny                 800     2200     2740
//     visibility, transfer     9e-4 7e-4  4e-4 3e-4  2e-4 1e-4      8e-4 7e-4
//     us                          230      560      710             1300
//     rays, nefertiti             890     1740     2880
//     visibility, transfer    12e-4 2e-4  5e-4 1e-4  2e-4 1e-4      7e-4 2e-4
//     us                          290      550      860             1450
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/method_names.h"
#include "core/progress.h"
#include "prt/mesh.h"
#include "prt/ray_scene.h"

namespace airlight {

inline constexpr int kLargestBakeOrder = 10;
inline constexpr int kLargestBakeRays = 1 << 20;
/// Enough for any tolerance from 3e-4 on where borders are lines.
inline constexpr int kAdaptiveBakeRays = 16384;
inline constexpr double kSmallestBakeTolerance = 1e-6;

/// How the directions of a vertex are chosen: a fixed number of them (prt/hemisphere.h,
/// prt/random_hemisphere.h), or until an estimate of the error meets a tolerance
/// (prt/adaptive_hemisphere.h).
enum class BakeMethod {
    fibonacci,
    owen_sobol,
    stratified,
    random,
    adaptive,
};

inline constexpr NamedMethod<BakeMethod> kBakeMethods[] = {
    {BakeMethod::fibonacci, "fibonacci"},   {BakeMethod::owen_sobol, "owen-sobol"},
    {BakeMethod::stratified, "stratified"}, {BakeMethod::random, "random"},
    {BakeMethod::adaptive, "adaptive"},
};

struct BakeOptions {
    int order = 6;  ///< 1 … kLargestBakeOrder
    /// Directions of each vertex, 1 … kLargestBakeRays; of the adaptive method about the most,
    /// kFewestAdaptiveRays or more.
    int rays = 1024;
    BakeMethod method = BakeMethod::fibonacci;
    double tolerance = 0;  ///< of the adaptive method, [kSmallestBakeTolerance, 1]; else 0
};

/// Where the results of a run of vertices go, one row per vertex in the order in which they are
/// baked. Null pointers are left out.
struct BakeRows {
    float* visibility = nullptr;           ///< (vertices, order^2)
    float* transfer = nullptr;             ///< (vertices, order^2)
    float* unshadowed_transfer = nullptr;  ///< (vertices, order^2)
    float* ambient_occlusion = nullptr;    ///< (vertices), in [0, 1]
    /// (vertices, 3), unit; the normal where no direction is free, or free ones cancel.
    float* bent_normal = nullptr;
    /// (vertices): estimates of the adaptive method alone, of the errors of a row without reflected
    /// light: |row - truth| / |row of an open hemisphere|.
    float* visibility_error = nullptr;
    float* transfer_error = nullptr;
    std::uint32_t* ray_count = nullptr;      ///< (vertices): rays that were asked for
    std::uint32_t* blocked_count = nullptr;  ///< (vertices): of these

    /// The rows from `row` on.
    BakeRows from(std::size_t row, int order) const;
};

struct BakeReport {
    std::uint64_t vertices = 0;
    std::uint64_t rays = 0;     ///< directions asked for; those under the ground cost nothing
    std::uint64_t blocked = 0;  ///< of these
    /// Vertices more than half of whose directions are blocked.
    std::uint64_t mostly_blocked = 0;
};

/// What a mesh of the scene sends on, at RayHit::mesh = its place in a list. Those that the list
/// lacks, and those without a mesh or transfer, are black.
struct Reflector {
    const Mesh* mesh = nullptr;
    double albedo = 0;                ///< [0, 1]
    const float* transfer = nullptr;  ///< (vertices, order^2) of the mesh, in its order
};

/// Bakes the vertices numbered vertices[0] … vertices[count - 1] of the mesh whose scene is given,
/// into rows 0 … count - 1. In parallel; a row depends on the scene, the options, the reflectors
/// and its vertex's number, position and normal alone, to the bit. For speed, list vertices in the
/// order of prt/morton.h. Reflectors add to the kind transfer only. Counts vertices at `progress`.
///
/// Throws Error: usage for options or an albedo outside their domain; data for a mesh without a
/// normal per vertex or with one whose squared length is not within 1e-5 of 1.
BakeReport bake_vertices(const Mesh& mesh, const RayScene& scene, const BakeOptions& options,
                         const std::uint32_t* vertices, std::size_t count, const BakeRows& rows,
                         const std::vector<Reflector>& reflectors = {},
                         Progress* progress = nullptr);

/// What to keep of a whole mesh.
struct BakeKinds {
    bool visibility = true, transfer = true, unshadowed_transfer = false;
    bool ambient_occlusion = false, bent_normal = false;
};

/// All vertices of a mesh in the order of its file; arrays as in BakeRows, those left out empty.
struct Bake {
    int order = 0;
    std::vector<float> visibility, transfer, unshadowed_transfer, ambient_occlusion, bent_normal;
    BakeReport report;
    RaySceneReport scene;

    BakeRows rows();
};

/// Bakes every vertex. Throws as bake_vertices, and Error(memory) when the results would take more
/// than max_memory.
Bake bake_mesh(const Mesh& mesh, const RayScene& scene, const BakeOptions& options = {},
               const BakeKinds& kinds = {}, std::size_t max_memory = kDefaultMaxMemory,
               const std::vector<Reflector>& reflectors = {}, Progress* progress = nullptr);

}  // namespace airlight
