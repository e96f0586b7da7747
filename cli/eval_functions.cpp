// SPDX-License-Identifier: Apache-2.0
#include "cli/eval_functions.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "core/parallel.h"
#include "medium/airlight.h"
#include "medium/airlight_method.h"
#include "medium/airlight_rungs.h"
#include "medium/psf.h"
#include "medium/special_f.h"
#include "sh/npsf.h"

namespace airlight {
namespace {

// The floats next above pi and pi/2: whoever rounds an angle to float may land there.
constexpr double kAbovePi = 3.1415927410125732;
constexpr double kAboveHalfPi = 1.5707963705062866;
constexpr double kLargestDegree = 65535;
constexpr std::size_t kRowsPerTask = 256;
constexpr std::size_t kCachedCoefficients = std::size_t{8} << 20;

EvalColumn not_negative(const std::string& name) {
    return {name, "[0, inf]"};
}

EvalColumn angle(const std::string& name) {
    return {name, "[0, pi]", kAbovePi};
}

EvalColumn quarter_angle(const std::string& name) {
    return {name, "[0, pi/2]", kAboveHalfPi};
}

const EvalColumn kDegree = {"l", "the integers 0 ... 65535", kLargestDegree, true, true};

std::vector<std::string> airlight_methods() {
    std::vector<std::string> names = {"exact"};
    for (const AirlightMethodInfo& info : kAirlightMethods) {
        if (info.name != names[0]) names.emplace_back(info.name);
    }
    return names;
}

template <class Function>
Evaluator pointwise(Function function) {
    return [function = std::move(function)](const std::vector<EvalArguments>& arguments,
                                            std::vector<double>& values) {
        parallel_blocks(arguments.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) values[i] = function(arguments[i]);
        });
    };
}

/// One formula for both precisions: `function` takes the arguments as doubles or as floats.
template <class Function>
Evaluator in_precision(EvalPrecision precision, Function function) {
    if (precision == EvalPrecision::double_precision) {
        return pointwise([function](const EvalArguments& a) { return function(a[0], a[1], a[2]); });
    }
    return pointwise([function](const EvalArguments& a) -> double {
        return function(static_cast<float>(a[0]), static_cast<float>(a[1]),
                        static_cast<float>(a[2]));
    });
}

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
    const std::optional<AirlightMethod> method = airlight_method_from_name(name);
    assert(method.has_value());
    if (*method == AirlightMethod::exact) {
        return in_precision(precision, [](auto gamma, auto t_sv, auto t_vp) {
            return airlight(gamma, t_sv, t_vp);
        });
    }
    if (const std::optional<int> nodes = sinh_gl_nodes(*method)) {
        return in_precision(precision, [nodes = *nodes](auto gamma, auto t_sv, auto t_vp) {
            return airlight_sinh_gl(gamma, t_sv, t_vp, nodes);
        });
    }
    // These rungs exist in double only: a float result is theirs, rounded.
    AirlightOptions options;
    options.method = *method;
    const auto evaluator = std::make_shared<const AirlightEvaluator>(options);
    return in_precision(precision, [evaluator](auto gamma, auto t_sv, auto t_vp) {
        return static_cast<decltype(gamma)>((*evaluator)(gamma, t_sv, t_vp));
    });
}

/// Zonal coefficients by (T, order): all degrees of one T cost little more than the largest. Orders
/// are powers of two, so that a row's value does not depend on its neighbours.
class ZonalCache {
  public:
    /// psf_zonal or psf_zonal_scaled.
    using Function = std::vector<double> (*)(double optical_thickness, int order);
    explicit ZonalCache(Function function) : function_(function) {}

    void evaluate(const std::vector<std::pair<double, double>>& rows, EvalPrecision precision,
                  std::vector<double>& values) {
        std::set<Key> wanted;
        for (const auto& [thickness, degree] : rows) {
            if (!std::isnan(thickness) && !std::isnan(degree))
                wanted.insert(key(thickness, degree));
        }
        if (size_ > kCachedCoefficients) clear();
        std::vector<Key> to_compute;
        for (const Key& each : wanted) {
            if (cache_.count(each) == 0) to_compute.push_back(each);
        }
        std::vector<std::vector<double>> computed(to_compute.size());
        parallel_blocks(to_compute.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                computed[i] = function_(to_compute[i].first, to_compute[i].second);
            }
        });
        for (std::size_t i = 0; i < to_compute.size(); ++i) {
            size_ += computed[i].size();
            cache_[to_compute[i]] = std::move(computed[i]);
        }
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const auto [thickness, degree] = rows[i];
            if (std::isnan(thickness) || std::isnan(degree)) {
                values[i] = std::nan("");
                continue;
            }
            const double g = cache_.at(key(thickness, degree))[static_cast<std::size_t>(degree)];
            values[i] = precision == EvalPrecision::float_precision ? static_cast<float>(g) : g;
        }
    }

  private:
    using Key = std::pair<double, int>;

    static Key key(double thickness, double degree) {
        int order = 64;
        while (order <= degree) order *= 2;
        return {thickness, order};
    }
    void clear() {
        cache_.clear();
        size_ = 0;
    }

    Function function_;
    std::map<Key, std::vector<double>> cache_;
    std::size_t size_ = 0;
};

Evaluator make_zonal(bool normalised, EvalPrecision precision) {
    // NPSF is PSF_1 e^1 / 1.
    const auto cache = std::make_shared<ZonalCache>(normalised ? &psf_zonal_scaled : &psf_zonal);
    return [=](const std::vector<EvalArguments>& arguments, std::vector<double>& values) {
        std::vector<std::pair<double, double>> rows;
        rows.reserve(arguments.size());
        for (const EvalArguments& a : arguments) {
            if (normalised) {
                rows.emplace_back(1.0, a[0]);
            } else if (precision == EvalPrecision::float_precision) {
                rows.emplace_back(static_cast<float>(a[0]), a[1]);
            } else {
                rows.emplace_back(a[0], a[1]);
            }
        }
        cache->evaluate(rows, precision, values);
    };
}

}  // namespace

const std::vector<EvalFunction>& eval_functions() {
    static const std::vector<EvalFunction> kFunctions = {
        {"F", "int_0^v exp(-u tan x) dx", {not_negative("u"), quarter_angle("v")}, {"exact"}},
        {"F_diff",
         "F(u, v_hi) - F(u, v_lo)",
         {not_negative("u"), quarter_angle("v_lo"), quarter_angle("v_hi")},
         {"exact"}},
        {"airlight",
         "L_a / (beta^2 I_0)",
         {angle("gamma"), not_negative("Tsv"), not_negative("Tvp")},
         airlight_methods()},
        {"npsf", "NPSF(gamma), 1/sr", {angle("gamma")}, {"exact"}},
        {"psf", "PSF_T(gamma), 1/sr", {not_negative("T"), angle("gamma")}, {"exact", "factored"}},
        {"npsf_sh", "zonal coefficient g_l of NPSF", {kDegree}, {"exact"}},
        {"psf_sh",
         "zonal coefficient g_l of PSF_T",
         {{"T", "[0, inf)", std::numeric_limits<double>::infinity(), true}, kDegree},
         {"exact"}},
    };
    return kFunctions;
}

Evaluator make_evaluator(const EvalFunction& function, const std::string& method,
                         EvalPrecision precision) {
    const std::string& name = function.name;
    if (name == "F") {
        return in_precision(precision, [](auto u, auto v, auto) { return special_f(u, v); });
    }
    if (name == "F_diff") {
        return in_precision(precision, [](auto u, auto v_lo, auto v_hi) {
            return special_f_difference(u, v_lo, v_hi);
        });
    }
    if (name == "airlight") return make_airlight(method, precision);
    if (name == "npsf") {
        return in_precision(precision, [](auto gamma, auto, auto) { return npsf(gamma); });
    }
    if (name == "psf" && method == "factored") {
        return in_precision(precision,
                            [](auto t, auto gamma, auto) { return psf_factored(t, gamma); });
    }
    if (name == "psf") {
        return in_precision(precision, [](auto t, auto gamma, auto) { return psf(t, gamma); });
    }
    assert(name == "npsf_sh" || name == "psf_sh");
    return make_zonal(name == "npsf_sh", precision);
}

}  // namespace airlight
