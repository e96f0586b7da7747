// SPDX-License-Identifier: Apache-2.0
// Accuracy against time of every airlight rung, and the cost of the functions around it.
//
// Counters: max and rms error relative to the exact method on 20000 rays of the benchmark's set,
//     A: t_sv, t_vp < 2, gamma in [.02, 2.5];   B: t_sv, t_vp < 10, gamma in (0, pi);
// time is per call. The float rungs see rounded inputs, and their errors include that rounding.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "medium/airlight.h"
#include "medium/airlight_method.h"
#include "medium/airlight_rungs.h"
#include "medium/airlight_sets.h"
#include "medium/psf.h"
#include "medium/special_f.h"

namespace airlight {
namespace {

constexpr int kRays = 20000;

template <class Method>
void run(benchmark::State& state, char set, const Method& method) {
    const auto cases = airlight_set(set, kRays);
    const RelativeErrors errors = airlight_errors(cases, method);
    std::size_t i = 0;
    for (auto _ : state) {
        const AirlightCase& c = cases[i];
        benchmark::DoNotOptimize(method(c.gamma, c.t_sv, c.t_vp));
        i = i + 1 < cases.size() ? i + 1 : 0;
    }
    state.counters["max_error"] = errors.max;
    state.counters["rms_error"] = errors.rms;
}

template <class Method>
void add(const std::string& name, const Method& method) {
    for (const char set : {'A', 'B'}) {
        benchmark::RegisterBenchmark(
            ("airlight/" + name + "/" + set).c_str(),
            [set, method](benchmark::State& state) { run(state, set, method); });
    }
}

void add_airlight() {
    for (const NamedMethod<AirlightMethod>& info : kAirlightMethods) {
        AirlightOptions options;
        options.method = info.method;
        add(std::string(info.name), AirlightEvaluator(options));
    }
    for (const int nodes : {16, 32}) {
        add("sinh-gl" + std::to_string(nodes) + "-float", [nodes](double g, double s, double v) {
            return double{airlight_sinh_gl(float(g), float(s), float(v), nodes)};
        });
    }
}

// Infinite rays of set B, where the point spread function lives.
template <class Function>
void add_unary(const std::string& name, const Function& function) {
    benchmark::RegisterBenchmark(name.c_str(), [function](benchmark::State& state) {
        const auto cases = airlight_set('B', kRays);
        std::size_t i = 0;
        for (auto _ : state) {
            benchmark::DoNotOptimize(function(cases[i].t_sv, cases[i].gamma));
            i = i + 1 < cases.size() ? i + 1 : 0;
        }
    });
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    airlight::add_airlight();
    airlight::add_unary("psf_scaled",
                        [](double t, double g) { return airlight::psf_scaled(t, g); });
    airlight::add_unary("psf_factored",
                        [](double t, double g) { return airlight::psf_factored(t, g); });
    airlight::add_unary("special_f",
                        [](double u, double g) { return airlight::special_f(u, 0.5 * g); });
    airlight::add_unary("special_f_difference", [](double u, double g) {
        return airlight::special_f_difference(u, 0.25 * g, 0.5 * g);
    });
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
