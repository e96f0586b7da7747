// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: airlight of a point light and the point spread function in a uniform medium.
#include <cassert>
#include <memory>
#include <optional>

#include "cli/eval_functions.h"
#include "cli/eval_rows.h"
#include "medium/airlight.h"
#include "medium/airlight_batch.h"
#include "medium/airlight_method.h"
#include "medium/airlight_rungs.h"
#include "medium/psf.h"
#include "medium/psf_batch.h"
#include "medium/special_f.h"

namespace airlight {
namespace {

std::optional<int> sinh_gl_nodes(AirlightMethod method) {
    switch (method) {
        case AirlightMethod::sinh_gl6:
            return 6;
        case AirlightMethod::sinh_gl8:
            return 8;
        case AirlightMethod::sinh_gl12:
            return 12;
        case AirlightMethod::sinh_gl16:
            return 16;
        case AirlightMethod::sinh_gl24:
            return 24;
        case AirlightMethod::sinh_gl32:
            return 32;
        default:
            return std::nullopt;
    }
}

Evaluator make_airlight(const std::string& name, EvalPrecision precision) {
    if (name == "batch") {
        return in_batches<3>([](std::size_t count, const auto& x, float* out) {
            airlight_batch(count, x[0], x[1], x[2], out);
        });
    }
    if (name == "batch-table") {
        return in_batches<3>([table = std::make_shared<const AirlightBatchTable>()](
                                 std::size_t count, const auto& x, float* out) {
            table->airlight_batch(count, x[0], x[1], x[2], out);
        });
    }
    const std::optional<AirlightMethod> method = method_from_name(kAirlightMethods, name);
    assert(method.has_value());
    if (*method == AirlightMethod::exact) {
        return in_precision<3>(precision, [](auto gamma, auto t_sv, auto t_vp) {
            return airlight(gamma, t_sv, t_vp);
        });
    }
    if (const std::optional<int> nodes = sinh_gl_nodes(*method)) {
        return in_precision<3>(precision, [nodes = *nodes](auto gamma, auto t_sv, auto t_vp) {
            return airlight_sinh_gl(gamma, t_sv, t_vp, nodes);
        });
    }
    // These rungs exist in double only: a float result is theirs, rounded.
    AirlightOptions options;
    options.method = *method;
    const auto evaluator = std::make_shared<const AirlightEvaluator>(options);
    return in_precision<3>(precision, [evaluator](auto gamma, auto t_sv, auto t_vp) {
        return static_cast<decltype(gamma)>((*evaluator)(gamma, t_sv, t_vp));
    });
}

Evaluator make_psf(const std::string& method, EvalPrecision precision) {
    if (method == "factored") {
        return in_precision<2>(precision,
                               [](auto t, auto gamma) { return psf_factored(t, gamma); });
    }
    if (method == "batch") {
        return in_batches<2>([](std::size_t count, const auto& x, float* out) {
            psf_batch(count, x[0], x[1], out);
        });
    }
    return in_precision<2>(precision, [](auto t, auto gamma) { return psf(t, gamma); });
}

}  // namespace

std::vector<EvalFunction> airlight_functions() {
    return {
        {"F",
         "int_0^v exp(-u tan x) dx",
         {not_negative("u"), quarter_angle("v")},
         {"exact"},
         [](const std::string&, EvalPrecision precision) {
             return in_precision<2>(precision, [](auto u, auto v) { return special_f(u, v); });
         }},
        {"F_diff",
         "F(u, v_hi) - F(u, v_lo)",
         {not_negative("u"), quarter_angle("v_lo"), quarter_angle("v_hi")},
         {"exact"},
         [](const std::string&, EvalPrecision precision) {
             return in_precision<3>(precision, [](auto u, auto v_lo, auto v_hi) {
                 return special_f_difference(u, v_lo, v_hi);
             });
         }},
        {"airlight",
         "L_a / (beta^2 I_0)",
         {angle("gamma"), not_negative("Tsv"), not_negative("Tvp")},
         method_names(kAirlightMethods, AirlightMethod::exact, {"batch", "batch-table"}),
         make_airlight},
        {"npsf",
         "NPSF(gamma), 1/sr",
         {angle("gamma")},
         {"exact"},
         [](const std::string&, EvalPrecision precision) {
             return in_precision<1>(precision, [](auto gamma) { return npsf(gamma); });
         }},
        {"psf",
         "PSF_T(gamma), 1/sr",
         {not_negative("T"), angle("gamma")},
         {"exact", "factored", "batch"},
         make_psf},
    };
}

}  // namespace airlight
