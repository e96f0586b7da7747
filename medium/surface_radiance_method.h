// SPDX-License-Identifier: Apache-2.0
// The ladder of surface radiance methods, by name.
#pragma once

#include <variant>

#include "core/method_names.h"
#include "medium/surface_radiance_tables.h"

namespace airlight {

/// The rungs, cheapest first. What each computes stands in medium/surface_radiance_tables.h and
/// medium/surface_radiance.h. Nanoseconds per call on one core of a shared machine and largest
/// relative error for T < 10, theta in (0, pi), by bench/surface_bench.cpp:
///
///     method               ns             n = 1     n = 20
///     raw-table-nearest    4              0.38      0.41
///     raw-table-bilinear   7              0.11      0.12
///     warped-table         19             1.4e-3    2.0e-3
///     cubic-table          32             9.0e-7    2.6e-6
///     exact                12000-34000    its own is under 1e-13
///
/// The tables take 20 to 100 ms to build at 64, 0.1 to 0.4 s at 128, on two cores.
enum class SurfaceMethod {
    raw_table_nearest,
    raw_table_bilinear,
    warped_table,
    cubic_table,
    exact,
};

/// Every method with its name, in the order of the enum.
inline constexpr NamedMethod<SurfaceMethod> kSurfaceMethods[] = {
    {SurfaceMethod::raw_table_nearest, "raw-table-nearest"},
    {SurfaceMethod::raw_table_bilinear, "raw-table-bilinear"},
    {SurfaceMethod::warped_table, "warped-table"},
    {SurfaceMethod::cubic_table, "cubic-table"},
    {SurfaceMethod::exact, "exact"},
};

struct SurfaceOptions {
    SurfaceMethod method = SurfaceMethod::exact;
    double exponent = 1;      ///< n in [1, 1000]
    int table_size = 0;       ///< points per axis; 0: 64, and 128 for cubic-table
    double table_max_t = 10;  ///< end of the T axis of the raw tables, > 0
};

/// One rung for one exponent, ready to evaluate: the constructor builds what the rung needs and
/// throws Error (usage) when an option is outside its limits. Domain and corners as
/// surface_radiance() in medium/surface_radiance.h; never negative. Evaluations are const and may
/// run in parallel.
class SurfaceEvaluator {
  public:
    explicit SurfaceEvaluator(const SurfaceOptions& options = {});

    /// G_n(t_sp, theta_s).
    double operator()(double t_sp, double theta_s) const;

    const SurfaceOptions& options() const { return options_; }

  private:
    SurfaceOptions options_;
    std::variant<std::monostate, RawSurfaceTable, WarpedSurfaceTable> table_;
};

}  // namespace airlight
