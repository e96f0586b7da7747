// SPDX-License-Identifier: Apache-2.0
// The ladder of methods for airlight with Henyey-Greenstein scattering, by name.
#pragma once

#include "core/method_names.h"

namespace airlight {

/// The rungs. All have the meaning, the domain and the corners of airlight_hg() in
/// medium/phase_airlight.h. Nanoseconds per call on one core of a shared machine and largest
/// relative error on the sets of bench/phase_bench.cpp, which are A and B of
/// bench/airlight_bench.cpp with g in (-0.95, 0.95):
///
///     method     ns    A    B
///     march64    775   1.9      3.9
///     gl8        305   3.7e-2   2.5e-2
///     gl16       470   2.9e-4   1.4e-3
///     gl32       800   1.2e-8   1.6e-7
///     exact      400-430, its own error is 2e-15
///
/// march64 is the midpoint rule in t, a ray marcher's; the gl ones are Gauss-Legendre with that
/// many nodes on one panel of the variable of medium/phase_integral.h, over the whole ray. The
/// exact method takes as many panels of 16 nodes as the ray needs, mostly one: only gl8 is cheaper.
enum class PhaseAirlightMethod { march64, gl8, gl16, gl32, exact };

/// Every method with its name, in the order of the enum.
inline constexpr NamedMethod<PhaseAirlightMethod> kPhaseAirlightMethods[] = {
    {PhaseAirlightMethod::march64, "march64"}, {PhaseAirlightMethod::gl8, "gl8"},
    {PhaseAirlightMethod::gl16, "gl16"},       {PhaseAirlightMethod::gl32, "gl32"},
    {PhaseAirlightMethod::exact, "exact"},
};

/// L_a / (beta^2 I_0) for g in (-1, 1) by that method.
double airlight_hg(double gamma, double t_sv, double t_vp, double g, PhaseAirlightMethod method);

}  // namespace airlight
