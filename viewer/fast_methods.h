// SPDX-License-Identifier: Apache-2.0
// The methods of the fast engine, effect by effect.
//
// Nanoseconds of one thread for a ray of view and a lamp, and errors of a pixel over the brightest,
// root mean square, on data/scenes; the noise of the reference's samples is in the latter:
//     effect                rung          ns            error
//     airlight.point        closed form   40            5.5e-6 of each ray
//                           mixed-gl8     2700          3.4e-4 (air-ground)
//                           mixed-gl16    3800          6e-5
//                           mixed-gl32    6000          5e-7
//     shafts                unshadowed    0             1e-3 (spheres), 2e-2 (room from outside)
//                           map16 … 64    20 … 130      5e-4 … 2e-4
//                           intervals     250 … 1100    2e-5, float
//     airlight.gaussians    fogshop       1200 (3)      3e-2 (halo), 3e-1 (shaft, 68 blobs)
//                           mixed-gl8     3200 (3)      1e-2 (steam), 6e-2 (shaft)
//                           mixed-gl16    4300 (3)      3e-2 (shaft)
//                           mixed-gl32    6700 (3)      3e-2 (shaft: noise)
//     airlight.environment  march4 … 32   150 … 1200    2e-2 (terrain), 5e-2 (city)
//     surface.point         gn16 … gn48   60            1e-2: noise; +180 % of its light in a room
//                           rings         50000         2.6e-3: noise, where gn has 3.9e-2
//                           (air-space)
//     surface.environment   order3 … 32   40            1e-2 (terrain), unshadowed
//     particles             cells1 … 6    4000 … 25000  2e-4 with cells6
//     slab                  straight      3000          2e-2
//                           refracted     8000          1.3e-3
#pragma once

#include "core/method_names.h"
#include "medium/gaussian_airlight_method.h"
#include "prt/fog_shading.h"
#include "viewer/effects.h"

namespace airlight {

/// Light of lamps that media send along rays. Where all media are the same everywhere it is a
/// closed form, in float vectors where they scatter evenly (medium/airlight_batch.h); these are for
/// other media, and for all with Plan::everything: the nodes of viewer/ray_nodes.h on each part of
/// a ray that the lamp reaches.
enum class FastAirlight { mixed_gl8, mixed_gl16, mixed_gl32 };
inline constexpr NamedMethod<FastAirlight> kFastAirlights[] = {
    {FastAirlight::mixed_gl8, "mixed-gl8"},
    {FastAirlight::mixed_gl16, "mixed-gl16"},
    {FastAirlight::mixed_gl32, "mixed-gl32"},
};

/// The same of Gaussians. fogshop and centroid cast no shadows in the media; where media are mixed
/// that they do not take (others than Gaussians over a uniform fog, phase functions, borders) they
/// give way to mixed-gl32.
enum class FastGaussians { fogshop, centroid, mixed_gl8, mixed_gl16, mixed_gl32 };
inline constexpr NamedMethod<FastGaussians> kFastGaussians[] = {
    {FastGaussians::fogshop, "fogshop"},       {FastGaussians::centroid, "centroid"},
    {FastGaussians::mixed_gl8, "mixed-gl8"},   {FastGaussians::mixed_gl16, "mixed-gl16"},
    {FastGaussians::mixed_gl32, "mixed-gl32"},
};

/// Which parts of a ray a lamp reaches.
enum class FastShafts {
    unshadowed,  ///< all, as [Sun05] has it
    map16,       ///< as a map of the lamp's shadows says at 16 points; borders by halving
    map32,
    map64,
    intervals,  ///< viewer/ray_shadows.h, exactly
};
inline constexpr NamedMethod<FastShafts> kFastShafts[] = {
    {FastShafts::unshadowed, "unshadowed"}, {FastShafts::map16, "map16"},
    {FastShafts::map32, "map32"},           {FastShafts::map64, "map64"},
    {FastShafts::intervals, "intervals"},
};

/// Light of lamps that media send onto surfaces.
enum class FastSurfacePoint {
    none,
    gn16,  ///< medium/surface_batch.h, with the mean extinction on the way to the lamp: tables of
           ///< 16 x 16 for each exponent
    gn24,
    gn48,   ///< of 1e-4
    rings,  ///< onto diffuse surfaces from 36 directions, with 8 points on each; glossy lobes by
            ///< gn48. For media that are not the same everywhere, of which gn knows a mean only
};
inline constexpr NamedMethod<FastSurfacePoint> kFastSurfacePoints[] = {
    {FastSurfacePoint::none, "none"},   {FastSurfacePoint::gn16, "gn16"},
    {FastSurfacePoint::gn24, "gn24"},   {FastSurfacePoint::gn48, "gn48"},
    {FastSurfacePoint::rings, "rings"},
};

/// Light of the map that media send along rays. Media that are the same everywhere have tables;
/// these are for others: points along the ray.
enum class FastMapAirlight { march4, march8, march16, march32 };
inline constexpr NamedMethod<FastMapAirlight> kFastMapAirlights[] = {
    {FastMapAirlight::march4, "march4"},
    {FastMapAirlight::march8, "march8"},
    {FastMapAirlight::march16, "march16"},
    {FastMapAirlight::march32, "march32"},
};

/// The order of the map's light on surfaces, where the lobe does not end before.
enum class FastSurfaceMap { order3, order4, order6, order8, order32 };
inline constexpr NamedMethod<FastSurfaceMap> kFastSurfaceMaps[] = {
    {FastSurfaceMap::order3, "order3"},   {FastSurfaceMap::order4, "order4"},
    {FastSurfaceMap::order6, "order6"},   {FastSurfaceMap::order8, "order8"},
    {FastSurfaceMap::order32, "order32"},
};

/// Particles in shafts: points on the ray in each cell that holds one.
enum class FastParticles { cells1, cells2, cells6 };
inline constexpr NamedMethod<FastParticles> kFastParticles[] = {
    {FastParticles::cells1, "cells1"},
    {FastParticles::cells2, "cells2"},
    {FastParticles::cells6, "cells6"},
};

/// How the light of lamps reaches points of slabs, of which there are eight on each piece of a ray.
enum class FastSlab {
    straight,   ///< as if surfaces were not there
    refracted,  ///< by Snell's law through each face, as the reference has it
};
inline constexpr NamedMethod<FastSlab> kFastSlabs[] = {
    {FastSlab::straight, "straight"},
    {FastSlab::refracted, "refracted"},
};

struct FastMethods {
    FastAirlight airlight = FastAirlight::mixed_gl32;
    FastGaussians gaussians = FastGaussians::mixed_gl32;
    FastShafts shafts = FastShafts::intervals;
    FastSurfacePoint surface_point = FastSurfacePoint::gn48;
    FastMapAirlight map_airlight = FastMapAirlight::march32;
    FastSurfaceMap surface_map = FastSurfaceMap::order32;
    FastParticles particles = FastParticles::cells6;
    FastSlab slab = FastSlab::refracted;
};

}  // namespace airlight
