// SPDX-License-Identifier: Apache-2.0
// The ladder of methods for the point light over a slab, by name.
#pragma once

#include "core/method_names.h"

namespace airlight {

/// The rungs of slab_near() (medium/slab.h). Nanoseconds per call and errors
/// relative to the exact value on the sets of bench/slab_bench.cpp, max / median:
///
///     method            ns A    B      A (thin)            B (any)
///     thin              51     57     .80   / 1.4e-2      2.1    / 8.6e-2
///     equiangular-gl8   200    205    1.1e-4 / 2e-16      1      / 1.2e-7
///     panels-gl6        250    770    1.8e-6 / 7e-15      2.3e-5 / 2.3e-9
///     panels-gl8        285    910    1.5e-8 / 2e-16      2.9e-7 / 1.7e-12
///     equiangular-gl16  340    350    6.1e-8 / 2e-16      1      / 2e-15
///     panels-gl12       350    1180   1.1e-12 / 1e-16     3.4e-11 / 2e-16
///     exact             420    1470   its own is under 1e-13
///     march64           540    545    1.4e-3 / 1.2e-5     1      / 5.5e-4
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

/// Every method with its name, in the order of the enum.
inline constexpr NamedMethod<SlabMethod> kSlabMethods[] = {
    {SlabMethod::thin, "thin"},
    {SlabMethod::equiangular_gl8, "equiangular-gl8"},
    {SlabMethod::equiangular_gl16, "equiangular-gl16"},
    {SlabMethod::march64, "march64"},
    {SlabMethod::panels_gl6, "panels-gl6"},
    {SlabMethod::panels_gl8, "panels-gl8"},
    {SlabMethod::panels_gl12, "panels-gl12"},
    {SlabMethod::exact, "exact"},
};

/// slab_near() by one of the rungs, with its domain and corners; never negative.
double slab_near(SlabMethod method, double sigma_t, double s, double l, double w_dot_n,
                 double wl_dot_n, double w_dot_wl);

}  // namespace airlight
