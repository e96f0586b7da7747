// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: density fields and what they are computed with.
#include "cli/eval_functions.h"
#include "cli/eval_rows.h"
#include "medium/height_density.h"
#include "medium/height_density_batch.h"
#include "medium/scaled_erfc.h"

namespace airlight {
namespace {

template <class Infos>
std::vector<std::string> names_of(const Infos& infos) {
    std::vector<std::string> names;
    for (const auto& info : infos) names.emplace_back(info.name);
    return names;
}

Evaluator make_erfcx(const std::string& method, EvalPrecision precision) {
    if (method == "rational9") {
        return pointwise([](const EvalArguments& a) -> double {
            return erfcx_rational9(static_cast<float>(a[0]));
        });
    }
    return in_precision<1>(precision, [](auto x) { return erfcx(x); });
}

Evaluator make_exponential_height(const std::string& method, EvalPrecision precision) {
    if (method == "batch") {
        return in_batches<4>([](std::size_t count, const auto& x, float* out) {
            exponential_height_depth_batch(count, x[0], x[1], x[2], x[3], out);
        });
    }
    return in_precision<4>(precision, [](auto height, auto up, auto dist, auto n) {
        return exponential_height_depth(height, up, dist, n);
    });
}

}  // namespace

std::vector<EvalFunction> density_functions() {
    return {
        {"exp2erfc",
         "exp(x^2) erfc(x)",
         {{"x", "[-inf, inf]", -std::numeric_limits<double>::infinity()}},
         names_of(kErfcxMethods),
         make_erfcx},
        {"rectexp",
         "column of exp(-n height) along a ray",
         {any_number("height"), cosine("dirZ"), not_negative("dist"), any_number("n")},
         {"exact", "batch"},
         make_exponential_height},
        {"rectexp_inverse",
         "distance at which rectexp has a value",
         {not_negative("tau_over_seaLvlAtt"), any_number("height"), cosine("dirZ"),
          any_number("n")},
         {"exact"},
         [](const std::string&, EvalPrecision precision) {
             return in_precision<4>(precision, [](auto tau, auto height, auto up, auto n) {
                 return exponential_height_distance(tau, height, up, n);
             });
         },
         [](const EvalArguments& a, double distance) {
             return exponential_height_depth(a[1], a[2], distance, a[3]);
         }},
        {"linear",
         "column of max(0, a height + k) along a ray",
         {any_number("a"), any_number("k"), any_number("height"), cosine("dirZ"),
          not_negative("dist")},
         {"exact"},
         [](const std::string&, EvalPrecision precision) {
             return in_precision<5>(precision, [](auto a, auto k, auto height, auto up, auto dist) {
                 return linear_height_depth(a, k, height, up, dist);
             });
         }},
        {"linear_inverse",
         "distance at which linear has a value",
         {not_negative("tau_over_sigma"), any_number("a"), any_number("k"), any_number("height"),
          cosine("dirZ")},
         {"exact"},
         [](const std::string&, EvalPrecision precision) {
             return in_precision<5>(precision, [](auto tau, auto a, auto k, auto height, auto up) {
                 return linear_height_distance(tau, a, k, height, up);
             });
         },
         [](const EvalArguments& a, double distance) {
             return linear_height_depth(a[1], a[2], a[3], a[4], distance);
         }},
    };
}

}  // namespace airlight
