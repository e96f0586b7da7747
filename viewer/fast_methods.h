// SPDX-License-Identifier: Apache-2.0
// The methods of the fast engine, effect by effect.
#pragma once

#include "core/method_names.h"
#include "medium/gaussian_airlight_method.h"
#include "prt/fog_shading.h"
#include "viewer/effects.h"

namespace airlight {

/// Light of lamps that media send along rays. Where all media are the same everywhere it is a
/// closed form, in float vectors where they scatter evenly (medium/airlight_batch.h); these are for
/// other media: Gauss-Legendre rules in the angle at which the lamp sees the ray, split where that
/// is next to the lamp.
enum class FastAirlight { angle_gl8, angle_gl16, angle_gl32 };
inline constexpr NamedMethod<FastAirlight> kFastAirlights[] = {
    {FastAirlight::angle_gl8, "angle-gl8"},
    {FastAirlight::angle_gl16, "angle-gl16"},
    {FastAirlight::angle_gl32, "angle-gl32"},
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
    gn_table,  ///< medium/surface_batch.h, with the mean extinction on the way to the lamp
};
inline constexpr NamedMethod<FastSurfacePoint> kFastSurfacePoints[] = {
    {FastSurfacePoint::none, "none"},
    {FastSurfacePoint::gn_table, "gn-table"},
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

struct FastMethods {
    FastAirlight airlight = FastAirlight::angle_gl32;
    FastShafts shafts = FastShafts::intervals;
    FastSurfacePoint surface_point = FastSurfacePoint::gn_table;
    FastMapAirlight map_airlight = FastMapAirlight::march32;
    FastSurfaceMap surface_map = FastSurfaceMap::order32;
};

}  // namespace airlight
