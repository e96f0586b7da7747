// SPDX-License-Identifier: Apache-2.0
// The ladder of methods for the point light over a slab, by name.
#pragma once

#include <optional>
#include <string_view>

namespace airlight {

/// The rungs of slab_near() (medium/slab.h), cheapest first. Nanoseconds per call and errors
/// relative to the exact value on the sets of bench/slab_bench.cpp, max / median:
///
///     method            ns     A (thin)          B (all)
///     thin
///     equiangular-gl8
///     equiangular-gl16
///     march64
///     panels-gl6
///     panels-gl8
///     panels-gl12
///     exact
///
/// `thin` is the paper's approximation. `equiangular` is one Gauss-Legendre rule in the angle that
/// the light sees, cut where sigma_t x = 40: the falloff is exact, the exponent need not be.
/// `march64` takes 64 even steps. `panels` and `exact` share their mesh and differ in its rule.
enum class SlabMethod {
    thin,
    equiangular_gl8,
    equiangular_gl16,
    march64,
    panels_gl6,
    panels_gl8,
    panels_gl12,
    exact,
};

struct SlabMethodInfo {
    SlabMethod method;
    std::string_view name;  ///< as on the command line
};

/// Every method with its name, in the order of the enum.
inline constexpr SlabMethodInfo kSlabMethods[] = {
    {SlabMethod::thin, "thin"},
    {SlabMethod::equiangular_gl8, "equiangular-gl8"},
    {SlabMethod::equiangular_gl16, "equiangular-gl16"},
    {SlabMethod::march64, "march64"},
    {SlabMethod::panels_gl6, "panels-gl6"},
    {SlabMethod::panels_gl8, "panels-gl8"},
    {SlabMethod::panels_gl12, "panels-gl12"},
    {SlabMethod::exact, "exact"},
};

std::string_view slab_method_name(SlabMethod method);

/// Nothing when no method has that name.
std::optional<SlabMethod> slab_method_from_name(std::string_view name);

/// slab_near() by one of the rungs, with its domain and corners; never negative.
double slab_near(SlabMethod method, double sigma_t, double s, double l, double w_dot_n,
                 double wl_dot_n, double w_dot_wl);

}  // namespace airlight
