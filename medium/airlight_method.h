// SPDX-License-Identifier: Apache-2.0
// The ladder of airlight methods, by name.
#pragma once

#include <variant>

#include "core/method_names.h"
#include "medium/airlight_tables.h"

namespace airlight {

/// The rungs, cheapest first within their kind. What each computes stands in
/// medium/airlight_tables.h, medium/airlight_rungs.h and medium/airlight.h. Nanoseconds per call on
/// one core of a shared machine and largest relative error on the sets of bench/airlight_bench.cpp:
///
///     method            ns     A        B         method      ns     A        B
///     f-table-nearest   47     79       8e4       sinh-gl12   335    4.0e-6   4.0e-6
///     f-table-bilinear  53     .20      4e9       sinh-gl16   425    6.7e-8   1.8e-7
///     warped-table      150    4.9e-3   3.7e-3    sinh-gl24   580    6.7e-12  3.7e-11
///     march64           450    9.4      4.4       sinh-gl32   740    1.7e-14  1.8e-14
///     sinh-gl6          215    2.9e-3   3.1e-3    e1          620    2.2e-13  9.6e-14
///     sinh-gl8          250    2.2e-4   8.8e-4    exact       110-145  its own is under 1e-13
///
/// Here `exact` is the cheapest of all but Sun's table; the others stay as the measure of what
/// the published methods do, and for arithmetic without a double.
enum class AirlightMethod {
    f_table_nearest,
    f_table_bilinear,
    warped_table,
    march64,
    sinh_gl6,
    sinh_gl8,
    sinh_gl12,
    sinh_gl16,
    sinh_gl24,
    sinh_gl32,
    e1,
    exact,
};

/// Every method with its name, in the order of the enum.
inline constexpr NamedMethod<AirlightMethod> kAirlightMethods[] = {
    {AirlightMethod::f_table_nearest, "f-table-nearest"},
    {AirlightMethod::f_table_bilinear, "f-table-bilinear"},
    {AirlightMethod::warped_table, "warped-table"},
    {AirlightMethod::march64, "march64"},
    {AirlightMethod::sinh_gl6, "sinh-gl6"},
    {AirlightMethod::sinh_gl8, "sinh-gl8"},
    {AirlightMethod::sinh_gl12, "sinh-gl12"},
    {AirlightMethod::sinh_gl16, "sinh-gl16"},
    {AirlightMethod::sinh_gl24, "sinh-gl24"},
    {AirlightMethod::sinh_gl32, "sinh-gl32"},
    {AirlightMethod::e1, "e1"},
    {AirlightMethod::exact, "exact"},
};

struct AirlightOptions {
    AirlightMethod method = AirlightMethod::exact;
    int table_size = 64;      ///< points per axis of the tables, >= 2
    double table_max_u = 10;  ///< end of the u axis of the F tables, > 0
    int march_steps = 64;     ///< >= 1
};

/// One rung, ready to evaluate: the constructor builds the table that the rung needs, if any.
/// Domain and corners as airlight() in medium/airlight.h; never negative. Evaluations are const
/// and may run in parallel.
class AirlightEvaluator {
  public:
    explicit AirlightEvaluator(const AirlightOptions& options = {});

    /// L_a / (beta^2 I_0) for gamma [rad], t_sv and t_vp.
    double operator()(double gamma, double t_sv, double t_vp) const;

    const AirlightOptions& options() const { return options_; }

  private:
    AirlightOptions options_;
    std::variant<std::monostate, SpecialFTable, WarpedAirlightTable> table_;
};

}  // namespace airlight
