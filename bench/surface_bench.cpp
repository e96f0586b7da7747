// SPDX-License-Identifier: Apache-2.0
// Accuracy against time of every surface radiance rung and of the batch call, one thread.
//
// Counters: max and rms error of G_n relative to the exact integral on 2000 cases of set A of
// medium/surface_sets.h (T < 10, theta in (0, pi)); time is per call, and `per_call` of the batch
// that of one of its 4096 values, whose inputs are rounded to float first.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "medium/surface_batch.h"
#include "medium/surface_radiance_method.h"
#include "medium/surface_sets.h"

namespace airlight {
namespace {

constexpr int kCases = 2000;

std::string with_exponent(std::string_view name, double exponent) {
    std::string text = std::to_string(exponent);
    text.erase(text.find_last_not_of("0.") + 1);
    if (exponent >= 10 && exponent == std::floor(exponent)) text = std::to_string(int(exponent));
    return std::string(name) + "/n=" + text;
}

void add_rung(SurfaceMethod method, double exponent) {
    benchmark::RegisterBenchmark(
        with_exponent("surface/" + std::string(method_name(kSurfaceMethods, method)), exponent)
            .c_str(),
        [=](benchmark::State& state) {
            SurfaceOptions options;
            options.method = method;
            options.exponent = exponent;
            const SurfaceEvaluator rung(options);
            const SurfaceSet set('A', exponent, kCases);
            const RelativeErrors errors = set.errors(rung);
            std::size_t i = 0;
            for (auto _ : state) {
                const SurfaceCase& c = set.cases()[i];
                benchmark::DoNotOptimize(rung(c.t, c.theta));
                i = i + 1 < set.cases().size() ? i + 1 : 0;
            }
            state.counters["max_error"] = errors.max;
            state.counters["rms_error"] = errors.rms;
        });
}

void add_batch(double exponent) {
    benchmark::RegisterBenchmark(
        with_exponent("surface/batch", exponent).c_str(), [=](benchmark::State& state) {
            const SurfaceBatchTable table(exponent);
            const SurfaceSet set('A', exponent, kCases);
            const RelativeErrors errors = set.errors([&](double t, double theta) {
                const float in[] = {static_cast<float>(t), static_cast<float>(theta)};
                float out;
                table.surface_batch(1, in, in + 1, &out);
                return double{out};
            });
            constexpr std::size_t kValues = 4096;
            std::vector<float> t(kValues), theta(kValues), out(kValues);
            for (std::size_t i = 0; i < kValues; ++i) {
                t[i] = static_cast<float>(set.cases()[i % kCases].t);
                theta[i] = static_cast<float>(set.cases()[i % kCases].theta);
            }
            for (auto _ : state) {
                table.surface_batch(kValues, t.data(), theta.data(), out.data());
                benchmark::DoNotOptimize(out.data());
                benchmark::ClobberMemory();
            }
            state.counters["max_error"] = errors.max;
            state.counters["rms_error"] = errors.rms;
            state.counters["per_call"] =
                benchmark::Counter(kValues, benchmark::Counter::kIsIterationInvariantRate |
                                                benchmark::Counter::kInvert);
        });
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    using airlight::SurfaceMethod;
    for (const double exponent : {1.0, 20.0}) {
        for (const airlight::NamedMethod<SurfaceMethod>& info : airlight::kSurfaceMethods) {
            airlight::add_rung(info.method, exponent);
        }
        airlight::add_batch(exponent);
    }
    for (const double exponent : {1.1, 1.5, 2.5, 5.0, 10.0, 100.0, 1000.0}) {
        airlight::add_rung(SurfaceMethod::exact, exponent);
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
