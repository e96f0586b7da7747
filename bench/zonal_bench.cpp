// SPDX-License-Identifier: Apache-2.0
// Cost of zonal eigenvalues beside their error, one thread: the table of PSF_T by rung, and lobes
// in closed form beside quadrature. `error` is the largest relative one over l < order, of PSF_T
// over 2000 thicknesses in [0, 20], of lobes relative to lambda_0.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sh/lobes.h"
#include "sh/npsf.h"
#include "sh/psf_bands.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

void add_bands(const NamedMethod<PsfBandsMethod>& rung, int order) {
    const std::string name = "psf/" + std::string(rung.name) + "/" + std::to_string(order);
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        const PsfBands bands(order, rung.method);
        std::vector<float> out(static_cast<std::size_t>(order));
        double thickness = 0.1;
        for (auto _ : state) {
            bands.eigenvalues_scaled(thickness, out.data());
            benchmark::DoNotOptimize(out.data());
            benchmark::ClobberMemory();
            thickness = thickness < 19 ? thickness + 0.7 : thickness - 18.9;
        }
        double worst = 0;
        for (int i = 0; i < 2000; ++i) {
            const double t = 20 * std::pow((i + 0.37) / 2000, 4);
            const std::vector<double> exact = psf_eigenvalues_scaled(t, order);
            bands.eigenvalues_scaled(t, out.data());
            for (std::size_t l = 0; l < out.size(); ++l) {
                worst = std::max(worst, std::abs(static_cast<double>(out[l]) / exact[l] - 1));
            }
        }
        state.counters["error"] = worst;
    });
}

void lobe_quadrature(benchmark::State& state) {
    const int order = static_cast<int>(state.range(0));
    std::vector<double> lambda;
    for (auto _ : state) {
        lambda = zonal_eigenvalues(
            [](double g) { return std::pow(std::max(0.0, std::cos(g)), 20); }, order, order);
        benchmark::DoNotOptimize(lambda.data());
    }
    const std::vector<double> exact = phong_eigenvalues(20, order);
    double worst = 0;
    for (std::size_t l = 0; l < exact.size(); ++l) {
        worst = std::max(worst, std::abs(lambda[l] - exact[l]) / exact[0]);
    }
    state.counters["error"] = worst;
}

template <class Lobe>
void lobe_closed(benchmark::State& state, const Lobe& lobe) {
    for (auto _ : state) {
        const std::vector<double> lambda = lobe(static_cast<int>(state.range(0)));
        benchmark::DoNotOptimize(lambda.data());
    }
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    using namespace airlight;
    for (const auto& rung : kPsfBandsMethods) {
        for (const int order : {6, 64}) add_bands(rung, order);
    }
    benchmark::RegisterBenchmark("phong20/quadrature", lobe_quadrature)->Arg(8)->Arg(64);
    const auto add = [](const char* name, auto lobe) {
        benchmark::RegisterBenchmark(name, [=](benchmark::State& s) { lobe_closed(s, lobe); })
            ->Arg(8)
            ->Arg(64);
    };
    add("phong20/closed", [](int order) { return phong_eigenvalues(20, order); });
    add("cone/closed", [](int order) { return cone_eigenvalues(0.3, order); });
    add("gaussian/ratios", [](int order) { return gaussian_eigenvalues(20, order); });
    add("gaussian/sum", [](int order) { return gaussian_eigenvalues(5000, order); });
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
