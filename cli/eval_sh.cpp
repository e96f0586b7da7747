// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: zonal coefficients of the point spread function.
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "cli/eval_functions.h"
#include "cli/eval_rows.h"
#include "core/parallel.h"
#include "sh/npsf.h"

namespace airlight {
namespace {

constexpr double kLargestDegree = 65535;
constexpr std::size_t kCachedCoefficients = std::size_t{8} << 20;

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
            values[i] = in_argument_precision(g, precision);
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

Evaluator make_npsf_sh(const std::string&, EvalPrecision precision) {
    // NPSF is PSF_1 e^1 / 1.
    const auto cache = std::make_shared<ZonalCache>(&psf_zonal_scaled);
    return [=](const std::vector<EvalArguments>& arguments, std::vector<double>& values) {
        std::vector<std::pair<double, double>> rows;
        rows.reserve(arguments.size());
        for (const EvalArguments& a : arguments) rows.emplace_back(1.0, a[0]);
        cache->evaluate(rows, precision, values);
    };
}

Evaluator make_psf_sh(const std::string&, EvalPrecision precision) {
    const auto cache = std::make_shared<ZonalCache>(&psf_zonal);
    return [=](const std::vector<EvalArguments>& arguments, std::vector<double>& values) {
        std::vector<std::pair<double, double>> rows;
        rows.reserve(arguments.size());
        for (const EvalArguments& a : arguments) {
            rows.emplace_back(in_argument_precision(a[0], precision), a[1]);
        }
        cache->evaluate(rows, precision, values);
    };
}

}  // namespace

std::vector<EvalFunction> sh_functions() {
    const EvalColumn degree = {"l", "the integers 0 ... 65535", 0, kLargestDegree, true, true};
    EvalColumn thickness = not_negative("T");
    thickness.limits = "[0, inf)";
    thickness.finite = true;
    return {
        {"npsf_sh", "zonal coefficient g_l of NPSF", {degree}, {"exact"}, make_npsf_sh},
        {"psf_sh", "zonal coefficient g_l of PSF_T", {thickness, degree}, {"exact"}, make_psf_sh},
    };
}

}  // namespace airlight
