// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: optical depths of Gaussian media.
#include <cassert>
#include <memory>
#include <optional>

#include "cli/eval_functions.h"
#include "cli/eval_rows.h"
#include "medium/average_depth.h"
#include "medium/gaussian_density.h"
#include "medium/gaussian_line_batch.h"
#include "medium/gaussian_line_method.h"

namespace airlight {
namespace {

EvalColumn finite_not_negative(const std::string& name) {
    return {name, "[0, inf)", 0, std::numeric_limits<double>::infinity(), true};
}

Evaluator make_line(const std::string& name, EvalPrecision precision) {
    if (name == "batch") {
        return in_batches<5>([](std::size_t count, const auto& x, float* out) {
            gaussian_line_batch(count, x[0], x[1], x[2], x[3], x[4], out);
        });
    }
    const std::optional<GaussianLineMethod> method = method_from_name(kGaussianLineMethods, name);
    assert(method.has_value());
    return in_precision<5>(
        precision, [method = *method](auto a, auto c, auto rho_perp, auto m_proj, auto dist) {
            return gaussian_line(method, a, c, rho_perp, m_proj, dist);
        });
}

Evaluator make_mean_depth(const std::string& name, EvalPrecision precision) {
    if (name == "exact") {
        return in_precision<1>(precision, [](auto u) { return mean_gaussian_depth(u); });
    }
    // The tables are in double: a float result is theirs, rounded.
    const auto table = std::make_shared<const MeanDepthTable>(name == "table64" ? 64 : 256);
    return in_precision<1>(precision,
                           [table](auto u) { return static_cast<decltype(u)>((*table)(u)); });
}

}  // namespace

std::vector<EvalFunction> gaussian_functions() {
    return {
        {"gauss_line",
         "c exp(-a^2 rho_perp^2) int_0^dist exp(-a^2 (t - m_proj)^2) dt",
         {finite_not_negative("a"), finite_not_negative("c"), finite_not_negative("rho_perp"),
          any_number("m_proj"), not_negative("dist")},
         method_names(kGaussianLineMethods, GaussianLineMethod::exact, {"batch"}),
         make_line},
        {"avg_depth_gauss",
         "T(u) = sqrt(pi) / (2 u) Dawson(u)",
         {not_negative("u")},
         {"exact", "table64", "table256"},
         make_mean_depth},
    };
}

}  // namespace airlight
