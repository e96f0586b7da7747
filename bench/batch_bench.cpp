// SPDX-License-Identifier: Apache-2.0
// Cost of the batch calls beside their scalar functions and a ray march, in one run, one thread.
//
// Every iteration computes kRays values; the counter per_call is the time of one. Errors are
// relative to the double function at the inputs as rounded to float, on the sets
//     A: t_sv, t_vp < 2, gamma in [.02, 2.5];   B: t_sv, t_vp < 10, gamma in (0, pi).
// A name ends with the SIMD target that the batch call was made to use. After the table stand the
// ratios that the project promises.
#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "bench/march_batch.h"
#include "medium/airlight.h"
#include "medium/airlight_batch.h"
#include "medium/airlight_rungs.h"
#include "medium/airlight_sets.h"
#include "medium/gaussian_density.h"
#include "medium/gaussian_line_batch.h"
#include "medium/height_density.h"
#include "medium/height_density_batch.h"
#include "medium/psf.h"
#include "medium/psf_batch.h"
#include "medium/spherical_density.h"
#include "medium/spherical_density_batch.h"

namespace airlight {
namespace {

constexpr std::size_t kRays = 4096;

using Column = std::vector<float>;
using Columns = std::vector<Column>;
using Batch = std::function<void(const Columns&, float* out)>;
using Scalar = std::function<double(const double* x)>;

/// Lines of equal length; the double function over them.
struct Inputs {
    Columns columns;
    std::vector<double> exact;

    Inputs(Columns values, const Scalar& reference) : columns(std::move(values)) {
        for (std::size_t i = 0; i < columns[0].size(); ++i)
            exact.push_back(reference(row(i).data()));
    }
    std::vector<double> row(std::size_t i) const {
        std::vector<double> x;
        for (const Column& column : columns) x.push_back(column[i]);
        return x;
    }
};

void report(benchmark::State& state, const std::vector<double>& exact,
            const std::vector<double>& values) {
    RelativeErrors e;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const double error = std::abs(values[i] / exact[i] - 1);
        e.max = error <= e.max ? e.max : error;
        e.rms += error * error / static_cast<double>(exact.size());
    }
    state.counters["max_error"] = e.max;
    state.counters["rms_error"] = std::sqrt(e.rms);
    state.counters["per_call"] = benchmark::Counter(
        static_cast<double>(exact.size()),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void add_batch(const std::string& name, const Inputs& inputs, const Batch& batch) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        benchmark::RegisterBenchmark((name + "/" + hwy::TargetName(target)).c_str(),
                                     [=](benchmark::State& state) {
                                         hwy::SetSupportedTargetsForTest(target);
                                         hwy::GetChosenTarget().Update(hwy::SupportedTargets());
                                         Column out(inputs.exact.size());
                                         for (auto _ : state) {
                                             batch(inputs.columns, out.data());
                                             benchmark::DoNotOptimize(out.data());
                                             benchmark::ClobberMemory();
                                         }
                                         report(state, inputs.exact, {out.begin(), out.end()});
                                         hwy::SetSupportedTargetsForTest(0);
                                         hwy::GetChosenTarget().Update(hwy::SupportedTargets());
                                     });
    }
}

template <class Function, std::size_t... kIndex>
void add_scalar(const std::string& name, const Inputs& inputs, const Function& function,
                std::index_sequence<kIndex...>) {
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        const std::vector<double> x[] = {
            {inputs.columns[kIndex].begin(), inputs.columns[kIndex].end()}...};
        std::vector<double> out(inputs.exact.size());
        for (auto _ : state) {
            for (std::size_t i = 0; i < out.size(); ++i) out[i] = function(x[kIndex][i]...);
            benchmark::DoNotOptimize(out.data());
            benchmark::ClobberMemory();
        }
        report(state, inputs.exact, out);
    });
}

/// The double function of kInputs numbers, value by value.
template <std::size_t kInputs, class Function>
void add_scalar(const std::string& name, const Inputs& inputs, const Function& function) {
    add_scalar(name, inputs, function, std::make_index_sequence<kInputs>());
}

void add_airlight(char set) {
    Columns columns(3);
    for (const AirlightCase& c : airlight_set(set, kRays)) {
        columns[0].push_back(static_cast<float>(c.gamma));
        columns[1].push_back(static_cast<float>(c.t_sv));
        columns[2].push_back(static_cast<float>(c.t_vp));
    }
    const Inputs inputs(columns, [](const double* x) { return airlight(x[0], x[1], x[2]); });
    const std::string end = std::string("/") + set;
    add_scalar<3>("airlight/march64" + end, inputs,
                  [](double g, double s, double v) { return airlight_march(g, s, v, 64); });
    add_scalar<3>("airlight/exact" + end, inputs,
                  [](double g, double s, double v) { return airlight(g, s, v); });
    add_batch("airlight/batch-march64" + end, inputs, [](const Columns& x, float* out) {
        airlight_march_batch(kRays, x[0].data(), x[1].data(), x[2].data(), 64, out);
    });
    add_batch("airlight/batch-table" + end, inputs,
              [table = AirlightBatchTable()](const Columns& x, float* out) {
                  table.airlight_batch(kRays, x[0].data(), x[1].data(), x[2].data(), out);
              });
    add_batch("airlight/batch" + end, inputs, [](const Columns& x, float* out) {
        airlight_batch(kRays, x[0].data(), x[1].data(), x[2].data(), out);
    });
}

void add_psf() {
    Columns columns(2);
    for (const AirlightCase& c : airlight_set('B', kRays)) {
        columns[0].push_back(static_cast<float>(c.t_sv));
        columns[1].push_back(static_cast<float>(c.gamma));
    }
    const Inputs inputs(columns, [](const double* x) { return psf(x[0], x[1]); });
    add_scalar<2>("psf/exact", inputs, [](double t, double g) { return psf(t, g); });
    add_batch("psf/batch", inputs, [](const Columns& x, float* out) {
        psf_batch(kRays, x[0].data(), x[1].data(), out);
    });
    const Inputs scaled(columns, [](const double* x) { return psf_scaled(x[0], x[1]); });
    add_scalar<2>("psf_scaled/exact", scaled, [](double t, double g) { return psf_scaled(t, g); });
    add_batch("psf_scaled/batch", scaled, [](const Columns& x, float* out) {
        psf_scaled_batch(kRays, x[0].data(), x[1].data(), out);
    });
}

// Rays of a fog bank: heights of -1 to 5 scale heights, every direction, up to 10 of them long.
void add_height() {
    std::mt19937 bits(3);
    std::uniform_real_distribution<float> unit(0, 1);
    Columns columns(4);
    for (std::size_t i = 0; i < kRays; ++i) {
        columns[0].push_back(8 * (-1 + 6 * unit(bits)));
        columns[1].push_back(-1 + 2 * unit(bits));
        columns[2].push_back(80 * unit(bits));
        columns[3].push_back(1 / 8.0f);
    }
    const Inputs inputs(
        columns, [](const double* x) { return exponential_height_depth(x[0], x[1], x[2], x[3]); });
    add_scalar<4>("exponential_height/exact", inputs, [](double h, double u, double d, double n) {
        return exponential_height_depth(h, u, d, n);
    });
    add_batch("exponential_height/batch", inputs, [](const Columns& x, float* out) {
        exponential_height_depth_batch(kRays, x[0].data(), x[1].data(), x[2].data(), x[3].data(),
                                       out);
    });
}

// Segments through and beside blobs, up to 3 radii away and 6 long.
void add_gaussian() {
    std::mt19937 bits(4);
    std::uniform_real_distribution<float> unit(0, 1);
    Columns columns(5);
    for (std::size_t i = 0; i < kRays; ++i) {
        const float a = 0.5f + unit(bits);
        columns[0].push_back(a);
        columns[1].push_back(unit(bits));
        columns[2].push_back(3 * unit(bits) / a);
        columns[3].push_back((-3 + 6 * unit(bits)) / a);
        columns[4].push_back(6 * unit(bits) / a);
    }
    const Inputs inputs(
        columns, [](const double* x) { return gaussian_line(x[0], x[1], x[2], x[3], x[4]); });
    add_scalar<5>("gaussian_line/exact", inputs,
                  [](double a, double c, double rho, double m, double d) {
                      return gaussian_line(a, c, rho, m, d);
                  });
    add_batch("gaussian_line/batch", inputs, [](const Columns& x, float* out) {
        gaussian_line_batch(kRays, x[0].data(), x[1].data(), x[2].data(), x[3].data(), x[4].data(),
                            out);
    });
}

// Rays in the Earth's air: from 8 to 40 km, none into the ground, one metre to 1000 km long.
void add_spherical() {
    std::mt19937 bits(5);
    std::uniform_real_distribution<float> unit(0, 1);
    const float radius = 6371000, scale_height = 8000;
    Columns columns(3);
    for (std::size_t i = 0; i < kRays; ++i) {
        columns[0].push_back(8000 + 32000 * unit(bits));
        columns[1].push_back(-0.05f + 1.05f * unit(bits) * unit(bits));
        columns[2].push_back(std::pow(10.0f, 6 * unit(bits)));
    }
    const SphericalProfile profile = {radius, scale_height};
    const auto exact = [=](double altitude, double c, double distance) {
        return spherical_depth_at_altitude(profile, altitude, c, distance);
    };
    const Inputs inputs(columns, [=](const double* x) { return exact(x[0], x[1], x[2]); });
    add_scalar<3>("spherical/exact", inputs, exact);
    add_scalar<3>("spherical/float", inputs, [=](double altitude, double c, double distance) {
        return spherical_depth_at_altitude(radius, scale_height, static_cast<float>(altitude),
                                           static_cast<float>(c), static_cast<float>(distance));
    });
    add_batch("spherical/batch", inputs, [=](const Columns& x, float* out) {
        spherical_depth_at_altitude_batch(radius, scale_height, kRays, x[0].data(), x[1].data(),
                                          x[2].data(), out);
    });
}

struct Measured {
    double time = 0;
    double max_error = 0;
};

/// Prints the usual table and keeps what the ratios need: the fastest of the repetitions.
class Reporter : public benchmark::ConsoleReporter {
  public:
    Reporter() : ConsoleReporter(OO_Tabular) {}

    void ReportRuns(const std::vector<Run>& runs) override {
        ConsoleReporter::ReportRuns(runs);
        for (const Run& run : runs) {
            if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
            const auto counter = run.counters.find("max_error");
            if (counter == run.counters.end()) continue;
            const double time = run.cpu_accumulated_time / static_cast<double>(run.iterations);
            Measured& m = measured_[run.run_name.function_name];
            if (m.time == 0 || time < m.time) m.time = time;
            m.max_error = counter->second;
        }
    }

    /// cost of `a` / cost of `b`, with their errors; nothing if a filter left one of them out.
    void ratio(const std::string& a, const std::string& b, const char* promise) const {
        const auto first = measured_.find(a), second = measured_.find(b);
        if (first == measured_.end() || second == measured_.end()) return;
        std::printf("%-28s : %-28s %7.2f  %-10s max error %.1e : %.1e\n", a.c_str(), b.c_str(),
                    first->second.time / second->second.time, promise, first->second.max_error,
                    second->second.max_error);
    }

  private:
    std::map<std::string, Measured> measured_;
};

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    airlight::add_airlight('A');
    airlight::add_airlight('B');
    airlight::add_psf();
    airlight::add_height();
    airlight::add_gaussian();
    airlight::add_spherical();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    airlight::Reporter reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    std::printf("\ncost ratios, one thread\n");
    for (const std::string set : {"/A", "/B"}) {
        const std::string march = "airlight/march64" + set;
        reporter.ratio(march, "airlight/batch-table" + set + "/AVX2", "(>= 20)");
        reporter.ratio(march, "airlight/batch" + set + "/AVX2", "(>= 20)");
        reporter.ratio("airlight/exact" + set, march, "(<= 1.5)");
        reporter.ratio("airlight/batch-march64" + set + "/AVX2", "airlight/batch" + set + "/AVX2",
                       "");
    }
    for (const std::string name :
         {"psf", "psf_scaled", "exponential_height", "gaussian_line", "spherical"}) {
        reporter.ratio(name + "/exact", name + "/batch/AVX2", "");
    }
    benchmark::Shutdown();
    return 0;
}
