// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: light that reaches a surface by way of the fog.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "cli/eval_functions.h"
#include "cli/eval_rows.h"
#include "medium/surface_batch.h"
#include "medium/surface_radiance.h"
#include "medium/surface_radiance_method.h"

namespace airlight {
namespace {

// A table of 128 x 129 points takes half a second to build and 130 KB to keep.
constexpr std::size_t kKeptTables = 64;

/// One exponent, ready to evaluate: values of count pairs (T, theta).
using SurfaceRows = std::function<void(
    const std::vector<double>& t, const std::vector<double>& theta, std::vector<double>& values)>;

/// Evaluates rows (T, theta, n) exponent by exponent, each of which `make` builds once.
Evaluator by_exponent(std::function<SurfaceRows(double exponent)> make, EvalPrecision precision) {
    using Kept = std::map<double, SurfaceRows>;
    return [=, kept = std::make_shared<Kept>()](const std::vector<EvalArguments>& arguments,
                                                std::vector<double>& values) {
        std::map<double, std::vector<std::size_t>> rows;
        for (std::size_t i = 0; i < arguments.size(); ++i) {
            const double n = in_argument_precision(arguments[i][2], precision);
            values[i] = std::nan("");
            if (!std::isnan(n)) rows[n].push_back(i);
        }
        std::vector<double> t, theta, found;
        for (const auto& [n, indices] : rows) {
            if (kept->count(n) == 0) {
                if (kept->size() >= kKeptTables) kept->clear();
                kept->emplace(n, make(n));
            }
            t.clear();
            theta.clear();
            for (const std::size_t i : indices) {
                t.push_back(in_argument_precision(arguments[i][0], precision));
                theta.push_back(in_argument_precision(arguments[i][1], precision));
            }
            found.resize(indices.size());
            kept->at(n)(t, theta, found);
            for (std::size_t k = 0; k < indices.size(); ++k) {
                values[indices[k]] = in_argument_precision(found[k], precision);
            }
        }
    };
}

SurfaceRows batch_rows(double exponent) {
    const auto table = std::make_shared<const SurfaceBatchTable>(exponent);
    return [table](const std::vector<double>& t, const std::vector<double>& theta,
                   std::vector<double>& values) {
        const std::vector<float> t_float(t.begin(), t.end());
        const std::vector<float> theta_float(theta.begin(), theta.end());
        std::vector<float> out(t.size());
        table->surface_batch(t.size(), t_float.data(), theta_float.data(), out.data());
        std::copy(out.begin(), out.end(), values.begin());
    };
}

SurfaceRows table_rows(SurfaceMethod method, double exponent) {
    SurfaceOptions options;
    options.method = method;
    options.exponent = exponent;
    const auto rung = std::make_shared<const SurfaceEvaluator>(options);
    return [rung](const std::vector<double>& t, const std::vector<double>& theta,
                  std::vector<double>& values) {
        for (std::size_t i = 0; i < t.size(); ++i) values[i] = (*rung)(t[i], theta[i]);
    };
}

Evaluator make_surface(const std::string& name, EvalPrecision precision) {
    if (name == "batch") return by_exponent(batch_rows, EvalPrecision::float_precision);
    const std::optional<SurfaceMethod> method = method_from_name(kSurfaceMethods, name);
    assert(method.has_value());
    if (*method == SurfaceMethod::exact) {
        return in_precision<3>(precision, [](auto t_sp, auto theta_s, auto exponent) {
            return surface_radiance(t_sp, theta_s, exponent);
        });
    }
    // The tables exist in double only: a float result is theirs, rounded.
    return by_exponent([method = *method](double n) { return table_rows(method, n); }, precision);
}

}  // namespace

std::vector<EvalFunction> surface_functions() {
    return {
        {"surface_Gn",
         "G_n(T_sp, theta_s)",
         {not_negative("Tsp"), angle("theta_s"), {"n", "[1, 1000]", 1, 1000}},
         method_names(kSurfaceMethods, SurfaceMethod::exact, {"batch"}),
         make_surface},
    };
}

}  // namespace airlight
