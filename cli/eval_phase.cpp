// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: phase functions, and airlight and the point spread function with them.
#include <cassert>
#include <cmath>
#include <optional>

#include "cli/eval_functions.h"
#include "cli/eval_rows.h"
#include "medium/phase_airlight.h"
#include "medium/phase_airlight_method.h"

namespace airlight {
namespace {

EvalColumn asymmetry() {
    return {"g", "(-1, 1)", std::nextafter(-1.0, 0.0), std::nextafter(1.0, 0.0)};
}

Evaluator make_airlight_hg(const std::string& name, EvalPrecision precision) {
    const std::optional<PhaseAirlightMethod> method = method_from_name(kPhaseAirlightMethods, name);
    assert(method.has_value());
    // The rungs exist in double only: a float result is theirs, rounded.
    return in_precision<4>(precision, [=](auto gamma, auto t_sv, auto t_vp, auto g) {
        return static_cast<decltype(gamma)>(airlight_hg(gamma, t_sv, t_vp, g, *method));
    });
}

}  // namespace

std::vector<EvalFunction> phase_functions() {
    return {
        {"phase_hg",
         "Henyey-Greenstein phase function, 1/sr",
         {cosine("cos_theta"), asymmetry()},
         {"exact"},
         [](const std::string&, EvalPrecision precision) {
             return in_precision<2>(precision, [](auto c, auto g) { return phase_hg(c, g); });
         }},
        {"phase_rayleigh",
         "Rayleigh phase function, 1/sr",
         {cosine("cos_theta")},
         {"exact"},
         [](const std::string&, EvalPrecision precision) {
             return in_precision<1>(precision, [](auto c) { return phase_rayleigh(c); });
         }},
        {"airlight_hg",
         "L_a / (beta^2 I_0), Henyey-Greenstein",
         {angle("gamma"), not_negative("Tsv"), not_negative("Tvp"), asymmetry()},
         method_names(kPhaseAirlightMethods, PhaseAirlightMethod::exact),
         make_airlight_hg},
        {"airlight_rayleigh",
         "L_a / (beta^2 I_0), Rayleigh",
         {angle("gamma"), not_negative("Tsv"), not_negative("Tvp")},
         {"exact"},
         [](const std::string&, EvalPrecision precision) {
             return in_precision<3>(precision, [](auto gamma, auto t_sv, auto t_vp) {
                 return airlight(gamma, t_sv, t_vp, PhaseFunction::rayleigh());
             });
         }},
        {"psf_hg",
         "PSF_T(gamma) of Henyey-Greenstein, 1/sr",
         {not_negative("T"), angle("gamma"), asymmetry()},
         {"exact"},
         [](const std::string&, EvalPrecision precision) {
             return in_precision<3>(precision,
                                    [](auto t, auto gamma, auto g) { return psf_hg(t, gamma, g); });
         }},
        {"psf_rayleigh",
         "PSF_T(gamma) of Rayleigh, 1/sr",
         {not_negative("T"), angle("gamma")},
         {"exact"},
         [](const std::string&, EvalPrecision precision) {
             return in_precision<2>(precision, [](auto t, auto gamma) {
                 return psf(t, gamma, PhaseFunction::rayleigh());
             });
         }},
    };
}

}  // namespace airlight
