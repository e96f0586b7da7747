// SPDX-License-Identifier: Apache-2.0
// Cost of the spherical-harmonic calls beside straightforward loops, in one run, one thread.
//
// The counter `per_direction` is the time of one direction. `max_error` is the largest error of
// the basis in units of eps sqrt((2l+1)/(4 pi)) (sh/basis.h), of projections and reconstructions
// relative to the largest result, all against evaluate_basis() in double at the same inputs. Basis
// functions go to a block that fits the first-level cache. A name ends with the SIMD target that a
// batch call was made to use. After the table stand the ratios that the project promises.
//
//     sh_bench --accuracy > docs/BASIS_ACCURACY.md    measures that table instead, in minutes.
#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "bench/basis_accuracy.h"
#include "core/constants.h"
#include "sh/basis.h"
#include "sh/basis_batch.h"
#include "sh/index.h"

namespace airlight {
namespace {

template <class Real>
struct Points {
    std::vector<Real> x, y, z;

    explicit Points(std::size_t count) {
        std::mt19937 bits(7);
        std::normal_distribution<double> normal;
        for (std::size_t i = 0; i < count; ++i) {
            const double a = normal(bits), b = normal(bits), c = normal(bits);
            const double length = std::sqrt(a * a + b * b + c * c);
            x.push_back(static_cast<Real>(a / length));
            y.push_back(static_cast<Real>(b / length));
            z.push_back(static_cast<Real>(c / length));
        }
    }
    std::size_t count() const { return x.size(); }
    std::vector<double> basis(int order, std::size_t i) const {
        std::vector<double> out(sh_count(order));
        evaluate_basis(order, double(x[i]), double(y[i]), double(z[i]), out.data());
        return out;
    }
};

/// What one would write first: the recurrence in loops, order and tables constant.
template <int kOrder, class Real>
struct PlainBasis {
    Real seed[kOrder], a[kOrder][kOrder] = {}, b[kOrder][kOrder] = {};

    PlainBasis() {
        double square = 1 / (4 * kPi);
        for (int m = 0; m < kOrder; ++m) {
            if (m > 0) square *= (2.0 * m + 1) / (2.0 * m);
            seed[m] = static_cast<Real>(std::sqrt(m > 0 ? 2 * square : square));
            for (int l = m + 1; l < kOrder; ++l) {
                const double scale = (2.0 * l + 1) / ((l - m) * (l + m));
                a[l][m] = static_cast<Real>(std::sqrt(scale * (2 * l - 1)));
                if (l == m + 1) continue;
                b[l][m] = static_cast<Real>(
                    std::sqrt(scale * ((l - 1 - m) * (l - 1 + m)) / (2.0 * l - 3)));
            }
        }
    }
    void operator()(Real x, Real y, Real z, Real* out) const {
        Real c = 1, s = 0;
        for (int m = 0; m < kOrder; ++m) {
            Real q = seed[m], before = 0;
            for (int l = m; l < kOrder; ++l) {
                if (l > m) {
                    const Real next = a[l][m] * z * q - b[l][m] * before;
                    before = q;
                    q = next;
                }
                out[l * (l + 1) + m] = q * c;
                if (m > 0) out[l * (l + 1) - m] = q * s;
            }
            const Real turned = x * c - y * s;
            s = x * s + y * c;
            c = turned;
        }
    }
};

double scale(std::size_t slot) {
    return std::sqrt((2.0 * sh_degree(slot).l + 1) / (4 * kPi));
}

void report(benchmark::State& state, std::size_t count, double max_error) {
    state.counters["max_error"] = max_error;
    state.counters["per_direction"] = benchmark::Counter(
        static_cast<double>(count),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Error of out[slot * slot_stride + i * point_stride].
template <class Real>
double basis_error(int order, const Points<Real>& points, const std::vector<Real>& out,
                   std::size_t slot_stride, std::size_t point_stride) {
    double worst = 0;
    for (std::size_t i = 0; i < points.count(); ++i) {
        const std::vector<double> exact = points.basis(order, i);
        for (std::size_t slot = 0; slot < exact.size(); ++slot) {
            const double error =
                std::abs(out[slot * slot_stride + i * point_stride] - exact[slot]) / scale(slot);
            worst = std::max(worst, error / std::numeric_limits<Real>::epsilon());
        }
    }
    return worst;
}

template <class Result, class Real>
double relative_error(const std::vector<Result>& values, const std::vector<Real>& exact) {
    double worst = 0, largest = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        worst = std::max(worst, std::abs(double(values[i]) - exact[i]));
        largest = std::max(largest, std::abs(double(exact[i])));
    }
    return worst / largest;
}

using Benchmark = std::function<void(benchmark::State&)>;

void add(const std::string& name, const Benchmark& body) {
    benchmark::RegisterBenchmark(name.c_str(), body);
}

void add_targets(const std::string& name, const Benchmark& body) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        add(name + '/' + hwy::TargetName(target), [=](benchmark::State& state) {
            hwy::SetSupportedTargetsForTest(target);
            hwy::GetChosenTarget().Update(hwy::SupportedTargets());
            body(state);
            hwy::SetSupportedTargetsForTest(0);
            hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        });
    }
}

template <class Real>
void add_evaluate(const std::string& precision, int order) {
    // 36 functions of 512 bytes each take 18 KiB.
    const Points<Real> points((order <= 8 ? 512 : 128) / sizeof(Real));
    const std::size_t count = points.count();
    const std::string end = '/' + precision + '/' + std::to_string(order);
    add("evaluate/single" + end, [=](benchmark::State& state) {
        std::vector<Real> out(sh_count(order) * count);
        for (auto _ : state) {
            for (std::size_t i = 0; i < count; ++i) {
                evaluate_basis(order, points.x[i], points.y[i], points.z[i],
                               out.data() + i * sh_count(order));
            }
            benchmark::ClobberMemory();
        }
        report(state, count, basis_error(order, points, out, 1, sh_count(order)));
    });
    add_targets("evaluate/batch" + end, [=](benchmark::State& state) {
        std::vector<Real> out(sh_count(order) * count);
        for (auto _ : state) {
            evaluate_basis_batch(order, count, points.x.data(), points.y.data(), points.z.data(),
                                 out.data(), count);
            benchmark::ClobberMemory();
        }
        report(state, count, basis_error(order, points, out, count, 1));
    });
}

template <int kOrder, class Real>
void add_plain(const std::string& precision) {
    const Points<Real> points(512 / sizeof(Real));
    const std::size_t count = points.count(), slots = sh_count(kOrder);
    const std::string end = '/' + precision + '/' + std::to_string(kOrder);
    add("evaluate/plain" + end, [=, plain = PlainBasis<kOrder, Real>()](benchmark::State& state) {
        std::vector<Real> out(slots * count);
        for (auto _ : state) {
            for (std::size_t i = 0; i < count; ++i) {
                plain(points.x[i], points.y[i], points.z[i], out.data() + i * slots);
            }
            benchmark::ClobberMemory();
        }
        report(state, count, basis_error(kOrder, points, out, 1, slots));
    });
}

constexpr std::size_t kFused = 2048;

template <class Real>
struct Sums {
    Points<Real> points{kFused};
    std::size_t slots, channels;
    std::vector<Real> values, coefficients;
    std::vector<double> projected;
    std::vector<double> reconstructed;

    Sums(int order, int number) : slots(sh_count(order)), channels(number) {
        std::mt19937 bits(8);
        std::uniform_real_distribution<Real> unit(-1, 1);
        for (std::size_t i = 0; i < channels * kFused; ++i) values.push_back(unit(bits));
        for (std::size_t i = 0; i < channels * slots; ++i) coefficients.push_back(unit(bits));
        projected.resize(channels * slots);
        reconstructed.resize(channels * kFused);
        for (std::size_t i = 0; i < kFused; ++i) {
            const std::vector<double> y = points.basis(order, i);
            for (std::size_t k = 0; k < channels * slots; ++k) {
                projected[k] += double(values[k / slots * kFused + i]) * y[k % slots];
                reconstructed[k / slots * kFused + i] += double(coefficients[k]) * y[k % slots];
            }
        }
    }
};

template <int kOrder, class Real>
void add_plain_sums(const std::string& precision) {
    const Sums<Real> sums(kOrder, 1);
    const PlainBasis<kOrder, Real> plain;
    constexpr std::size_t kSlots = sh_count(kOrder);
    const std::string end = '/' + precision + '/' + std::to_string(kOrder) + "/1";
    add("project/plain" + end, [=](benchmark::State& state) {
        std::vector<double> out(kSlots);
        for (auto _ : state) {
            std::fill(out.begin(), out.end(), 0.0);
            Real y[kSlots];
            for (std::size_t i = 0; i < kFused; ++i) {
                plain(sums.points.x[i], sums.points.y[i], sums.points.z[i], y);
                for (std::size_t k = 0; k < kSlots; ++k) out[k] += sums.values[i] * y[k];
            }
            benchmark::ClobberMemory();
        }
        report(state, kFused, relative_error(out, sums.projected));
    });
    add("reconstruct/plain" + end, [=](benchmark::State& state) {
        std::vector<Real> out(kFused);
        for (auto _ : state) {
            Real y[kSlots];
            for (std::size_t i = 0; i < kFused; ++i) {
                plain(sums.points.x[i], sums.points.y[i], sums.points.z[i], y);
                Real sum = 0;
                for (std::size_t k = 0; k < kSlots; ++k) sum += sums.coefficients[k] * y[k];
                out[i] = sum;
            }
            benchmark::ClobberMemory();
        }
        report(state, kFused, relative_error(out, sums.reconstructed));
    });
}

template <class Real>
void add_sums(const std::string& precision, int order, int channels) {
    const Sums<Real> sums(order, channels);
    const Points<Real>& p = sums.points;
    const std::string end =
        '/' + precision + '/' + std::to_string(order) + '/' + std::to_string(channels);
    add_targets("project/batch" + end, [=](benchmark::State& state) {
        std::vector<double> out(sums.projected.size());
        for (auto _ : state) {
            std::fill(out.begin(), out.end(), 0.0);
            project_basis_batch(order, kFused, p.x.data(), p.y.data(), p.z.data(), channels,
                                sums.values.data(), out.data());
            benchmark::ClobberMemory();
        }
        report(state, kFused, relative_error(out, sums.projected));
    });
    add_targets("reconstruct/batch" + end, [=](benchmark::State& state) {
        std::vector<Real> out(sums.reconstructed.size());
        for (auto _ : state) {
            reconstruct_basis_batch(order, kFused, p.x.data(), p.y.data(), p.z.data(), channels,
                                    sums.coefficients.data(), out.data());
            benchmark::ClobberMemory();
        }
        report(state, kFused, relative_error(out, sums.reconstructed));
    });
}

struct Measured {
    double time = 0;  // per direction
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
            const auto error = run.counters.find("max_error");
            const auto time = run.counters.find("per_direction");
            if (error == run.counters.end() || time == run.counters.end()) continue;
            Measured& m = measured_[run.run_name.function_name];
            if (m.time == 0 || time->second < m.time) m.time = time->second;
            m.max_error = error->second;
        }
    }

    void line(const std::string& a, const std::string& b, const char* promise) const {
        const auto first = measured_.find(a), second = measured_.find(b);
        if (first == measured_.end() || second == measured_.end()) return;
        std::printf("%-30s : %-30s %6.2f ns : %7.2f ns = %6.3f  %-16s error %.1e : %.1e\n",
                    a.c_str(), b.c_str(), 1e9 * first->second.time, 1e9 * second->second.time,
                    first->second.time / second->second.time, promise, first->second.max_error,
                    second->second.max_error);
    }

  private:
    std::map<std::string, Measured> measured_;
};

template <class Real>
void add_all(const std::string& precision) {
    for (const int order : {4, 6, 8, 16, 32}) add_evaluate<Real>(precision, order);
    add_plain<4, Real>(precision);
    add_plain<6, Real>(precision);
    add_plain<16, Real>(precision);
    for (const int order : {4, 6}) {
        for (const int channels : {1, 3, 16}) add_sums<Real>(precision, order, channels);
    }
    for (const int channels : {1, 3}) add_sums<Real>(precision, 16, channels);
    add_plain_sums<4, Real>(precision);
    add_plain_sums<6, Real>(precision);
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    if (argc == 2 && std::string(argv[1]) == "--accuracy") {
        airlight::print_basis_accuracy();
        return 0;
    }
    airlight::add_all<float>("float");
    airlight::add_all<double>("double");
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    airlight::Reporter reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    std::printf("\nper direction, one thread\n");
    for (const std::string precision : {"/float", "/double"}) {
        for (const std::string order : {"/4", "/6", "/8", "/16", "/32"}) {
            const std::string end = precision + order, batch = "evaluate/batch" + end + "/AVX2";
            const bool six = order == "/6", single = precision == "/float";
            reporter.line(batch, "evaluate/single" + end,
                          six ? single ? "(<= 2.5 ns)" : "(<= 4.6 ns)" : "");
            reporter.line(batch, "evaluate/plain" + end, "");
            for (const std::string form : {"project", "reconstruct"}) {
                const std::string one = form + "/batch" + end + "/1/AVX2";
                reporter.line(one, batch, six && form == "project" ? "(<= 1.3)" : "");
                reporter.line(one, form + "/plain" + end + "/1", "");
                reporter.line(form + "/batch" + end + "/3/AVX2", batch, "");
                reporter.line(form + "/batch" + end + "/16/AVX2", batch, "");
            }
        }
    }
    benchmark::Shutdown();
    return 0;
}
