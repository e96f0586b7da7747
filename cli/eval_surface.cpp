// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: light that reaches a surface by way of the fog.
#include <cassert>
#include <functional>
#include <map>
#include <memory>
#include <utility>

#include "cli/eval_functions.h"
#include "cli/eval_rows.h"
#include "medium/surface_batch.h"
#include "medium/surface_radiance.h"
#include "medium/surface_radiance_method.h"

namespace airlight {
namespace {

// A table of 128 x 129 points takes half a second to build and 130 KB to keep.
constexpr std::size_t kKeptTables = 64;

std::vector<std::string> surface_methods() {
    std::vector<std::string> names = {"exact"};
    for (const SurfaceMethodInfo& info : kSurfaceMethods) {
        if (info.name != names[0]) names.emplace_back(info.name);
    }
    names.emplace_back("batch");
    return names;
}

/// Evaluates rows (T, theta, n) with one table for each exponent. `make(n)` builds a
/// function(T, theta).
Evaluator by_exponent(std::function<std::function<double(double, double)>(double)> make,
                      EvalPrecision precision) {
    using Tables = std::map<double, std::function<double(double, double)>>;
    return [=, tables = std::make_shared<Tables>()](const std::vector<EvalArguments>& arguments,
                                                    std::vector<double>& values) {
        std::map<double, std::vector<std::size_t>> rows;
        for (std::size_t i = 0; i < arguments.size(); ++i) {
            const double n = in_argument_precision(arguments[i][2], precision);
            values[i] = std::nan("");
            if (!std::isnan(n)) rows[n].push_back(i);
        }
        for (const auto& [n, of_exponent] : rows) {
            if (tables->count(n) == 0) {
                if (tables->size() >= kKeptTables) tables->clear();
                tables->emplace(n, make(n));
            }
            const auto& table = tables->at(n);
            for (const std::size_t i : of_exponent) {
                const double value = table(in_argument_precision(arguments[i][0], precision),
                                           in_argument_precision(arguments[i][1], precision));
                values[i] = in_argument_precision(value, precision);
            }
        }
    };
}

Evaluator make_surface(const std::string& name, EvalPrecision precision) {
    if (name == "batch") {
        return by_exponent(
            [](double n) {
                const auto table = std::make_shared<const SurfaceBatchTable>(n);
                return [table](double t, double theta) {
                    const float in[] = {static_cast<float>(t), static_cast<float>(theta)};
                    float out;
                    table->surface_batch(1, in, in + 1, &out);
                    return double{out};
                };
            },
            EvalPrecision::float_precision);
    }
    const std::optional<SurfaceMethod> method = surface_method_from_name(name);
    assert(method.has_value());
    if (*method == SurfaceMethod::exact) {
        return in_precision<3>(precision, [](auto t_sp, auto theta_s, auto exponent) {
            return surface_radiance(t_sp, theta_s, exponent);
        });
    }
    // The tables exist in double only: a float result is theirs, rounded.
    return by_exponent(
        [method = *method](double n) {
            SurfaceOptions options;
            options.method = method;
            options.exponent = n;
            const auto rung = std::make_shared<const SurfaceEvaluator>(options);
            return [rung](double t, double theta) { return (*rung)(t, theta); };
        },
        precision);
}

}  // namespace

std::vector<EvalFunction> surface_functions() {
    return {
        {"surface_Gn",
         "G_n(T_sp, theta_s)",
         {not_negative("Tsp"), angle("theta_s"), {"n", "[1, 1000]", 1, 1000}},
         surface_methods(),
         make_surface},
    };
}

}  // namespace airlight
