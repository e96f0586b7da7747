// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: density fields and what they are computed with.
#include "cli/eval_functions.h"
#include "cli/eval_rows.h"
#include "medium/chapman.h"
#include "medium/height_density.h"
#include "medium/height_density_batch.h"
#include "medium/scaled_erfc.h"
#include "medium/spherical_density.h"
#include "medium/spherical_density_batch.h"
#include "medium/spherical_rungs.h"

namespace airlight {
namespace {

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

Evaluator make_chapman(const std::string& name, EvalPrecision precision) {
    const ChapmanMethod method = *method_from_name(kChapmanMethods, name);
    if (method == ChapmanMethod::exact) {
        return in_precision<2>(precision, [](auto z, auto c) { return ln_chapman(z, c); });
    }
    return in_precision<2>(precision, [method](auto z, auto c) {
        return static_cast<decltype(z)>(ln_chapman(z, c, method));
    });
}

SphericalProfile profile_of(const EvalArguments& a) {
    return {a[0], a[1]};
}

SphericalRay ray_of(const EvalArguments& a) {
    return {a[2], a[3]};
}

Evaluator make_spherical_depth(const std::string& method, EvalPrecision precision) {
    if (method == "batch") {
        // A call has one sphere for all rays, so each run of rows about the same one is a batch.
        return in_batches<5>([](std::size_t count, const auto& x, float* out) {
            for (std::size_t first = 0, i = 1; i <= count; ++i) {
                if (i < count && x[0][i] == x[0][first] && x[1][i] == x[1][first]) continue;
                spherical_depth_batch(x[0][first], x[1][first], i - first, x[2] + first,
                                      x[3] + first, x[4] + first, out + first);
                first = i;
            }
        });
    }
    if (method == "exact" && precision == EvalPrecision::double_precision) {
        return pointwise(
            [](const EvalArguments& a) { return spherical_depth(profile_of(a), ray_of(a), a[4]); });
    }
    if (method == "flat") {
        return in_precision<5>(precision,
                               [](auto radius, auto scale, auto r, auto c, auto distance) {
                                   return static_cast<decltype(r)>(
                                       spherical_depth_flat({radius, scale}, {r, c}, distance));
                               });
    }
    const auto depth =
        method == "article"
            ? &spherical_depth_article
            : static_cast<float (*)(float, float, float, float, float)>(spherical_depth);
    return in_precision<5>(EvalPrecision::float_precision,
                           [depth](float radius, float scale, float r, float c, float distance) {
                               return depth(radius, scale, r, c, distance);
                           });
}

Evaluator make_spherical_distance(const std::string& method, EvalPrecision precision) {
    if (method == "article") {
        return in_precision<6>(
            EvalPrecision::float_precision,
            [](float radius, float scale, float r, float c, float limit, float depth) {
                return spherical_distance_article(radius, scale, r, c, limit, depth);
            });
    }
    if (precision == EvalPrecision::double_precision) {
        return pointwise([](const EvalArguments& a) {
            return spherical_distance(profile_of(a), ray_of(a), a[4], a[5]);
        });
    }
    return in_precision<6>(
        precision, [](float radius, float scale, float r, float c, float limit, float depth) {
            return spherical_distance(radius, scale, r, c, limit, depth);
        });
}

EvalColumn length(const std::string& name) {
    return {name, "[0, inf)", 0, std::numeric_limits<double>::infinity(), true};
}

}  // namespace

std::vector<EvalFunction> density_functions() {
    return {
        {"chapman",
         "ln C(z, cosTheta), Chapman's function",
         {not_negative("z"), cosine("cosTheta")},
         method_names(kChapmanMethods, ChapmanMethod::exact),
         make_chapman,
         nullptr,
         true},
        {"optdepth_sphere",
         "column of exp(-(|x| - R) / H) along a ray",
         {length("R"), not_negative("H"), length("r"), cosine("cosTheta"), not_negative("dist")},
         method_names(kSphericalMethods, SphericalMethod::exact, {"batch"}),
         make_spherical_depth},
        {"sample_sphere",
         "distance at which optdepth_sphere is tau",
         {length("R"), not_negative("H"), length("r"), cosine("cosTheta"), not_negative("maxDist"),
          not_negative("tau")},
         {"exact", "article"},
         make_spherical_distance,
         [](const EvalArguments& a, double distance) {
             return spherical_depth(profile_of(a), ray_of(a), distance);
         }},
        {"exp2erfc",
         "exp(x^2) erfc(x)",
         {{"x", "[-inf, inf]", -std::numeric_limits<double>::infinity()}},
         method_names(kErfcxMethods, ErfcxMethod::exact),
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
