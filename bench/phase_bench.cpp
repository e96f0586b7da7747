// SPDX-License-Identifier: Apache-2.0
// Accuracy against time of airlight with Henyey-Greenstein scattering, and the cost of the other
// phase functions.
//
// Counters: max and rms error relative to the exact method on 20000 rays of sets A and B of
// bench/airlight_bench.cpp, g evenly spread over (-0.95, 0.95); time is per call.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "medium/airlight_sets.h"
#include "medium/phase_airlight.h"
#include "medium/phase_airlight_method.h"

namespace airlight {
namespace {

constexpr int kRays = 20000;

double asymmetry(std::size_t i) {
    return 0.95 * (2 * std::fmod(static_cast<double>(i) * 0.6180339887498949, 1.0) - 1);
}

void add_rungs() {
    for (const NamedMethod<PhaseAirlightMethod>& info : kPhaseAirlightMethods) {
        for (const char set : {'A', 'B'}) {
            const std::string name = "airlight_hg/" + std::string(info.name) + "/" + set;
            benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
                const auto cases = airlight_set(set, kRays);
                double most = 0, squares = 0;
                for (std::size_t i = 0; i < cases.size(); ++i) {
                    const AirlightCase& c = cases[i];
                    const double g = asymmetry(i);
                    const double error = airlight_hg(c.gamma, c.t_sv, c.t_vp, g, info.method) /
                                             airlight_hg(c.gamma, c.t_sv, c.t_vp, g) -
                                         1;
                    most = std::max(most, std::fabs(error));
                    squares += error * error;
                }
                std::size_t i = 0;
                for (auto _ : state) {
                    const AirlightCase& c = cases[i];
                    benchmark::DoNotOptimize(
                        airlight_hg(c.gamma, c.t_sv, c.t_vp, asymmetry(i), info.method));
                    i = i + 1 < cases.size() ? i + 1 : 0;
                }
                state.counters["max_error"] = most;
                state.counters["rms_error"] = std::sqrt(squares / kRays);
            });
        }
    }
}

void add_psf(const std::string& name, const PhaseFunction& phase) {
    benchmark::RegisterBenchmark(("psf/" + name).c_str(), [phase](benchmark::State& state) {
        const auto cases = airlight_set('B', kRays);
        std::size_t i = 0;
        for (auto _ : state) {
            benchmark::DoNotOptimize(psf(cases[i].t_sv, cases[i].gamma, phase));
            i = i + 1 < cases.size() ? i + 1 : 0;
        }
    });
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    using airlight::PhaseFunction;
    airlight::add_rungs();
    airlight::add_psf("isotropic", PhaseFunction());
    airlight::add_psf("rayleigh", PhaseFunction::rayleigh());
    airlight::add_psf("hg:0.8", PhaseFunction::henyey_greenstein(0.8));
    airlight::add_psf("hg:0.999", PhaseFunction::henyey_greenstein(0.999));
    airlight::add_psf("table of 8", PhaseFunction::tabulated(
                                        {{0, 0.1, 0.3, 0.8, 1.5, 2.2, 2.8, 3.1415926535897931},
                                         {90, 50, 20, 3, 0.2, 0.6, 0.35, 1.1}}));
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
