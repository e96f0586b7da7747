// SPDX-License-Identifier: Apache-2.0
// Cost of projecting a 4096 x 2048 map of float RGB beside a pass that does no more than read it.
//
// read      adds up the map's bits from four places of a row at a time, which is twice as fast
//           here as one stream: the rate of memory
// project   project_latlong, to the order in the name
// samples   the same by MapRule::centre_samples
// transform SphericalTransform::analyze to order 64
// batch     project_basis_batch on the directions and weighted values of row after row
// pixels    what one would write first: a recurrence per pixel, times its solid angle
// A name ends with the number of threads; one thread is judged by its own CPU time, several by the
// clock on the wall. max_error is the largest difference from project, over
// the largest coefficient; sums over centres (samples, batch, pixels) answer another question than
// means over pixels, by about (order / rows)^2.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "core/constants.h"
#include "core/parallel.h"
#include "core/threads.h"
#include "sh/basis.h"
#include "sh/basis_batch.h"
#include "sh/index.h"
#include "sh/project.h"
#include "sh/transform.h"

namespace airlight {
namespace {

constexpr int kRows = 2048, kColumns = 4096, kChannels = 3, kOrder = 6;
constexpr std::size_t kRowSize = std::size_t{kColumns} * kChannels;
constexpr std::size_t kSlots = sh_count(kOrder);

/// Smooth light and noise, as maps have.
const std::vector<float>& picture() {
    static const std::vector<float> values = [] {
        std::vector<float> map(kRows * kRowSize);
        std::mt19937 random(1);
        std::uniform_real_distribution<float> unit(0, 1);
        for (std::size_t i = 0; i < map.size(); ++i) {
            const double row = static_cast<double>(i / kRowSize) / kRows;
            map[i] = unit(random) + static_cast<float>(2 * std::sin(3 * row) * std::sin(3 * row));
        }
        return map;
    }();
    return values;
}

std::uint64_t read_map(const std::vector<float>& map) {
    constexpr std::size_t kQuarter = kRowSize / 4;
    const auto add = [](std::uint64_t& sum, std::uint64_t part) { sum += part; };
    return ordered_reduce(
        std::size_t{kRows}, 32, std::uint64_t{0},
        [&](std::size_t begin, std::size_t end) {
            std::uint64_t sums[8] = {}, bits[8];
            for (std::size_t j = begin; j < end; ++j) {
                const float* row = map.data() + j * kRowSize;
                for (std::size_t i = 0; i < kQuarter; i += 4) {
                    for (std::size_t q = 0; q < 4; ++q) {
                        std::memcpy(bits + 2 * q, row + q * kQuarter + i, 4 * sizeof(float));
                    }
                    for (int k = 0; k < 8; ++k) sums[k] += bits[k];
                }
            }
            std::uint64_t sum = 0;
            for (const std::uint64_t part : sums) sum += part;
            return sum;
        },
        add);
}

double column_angle(int column) {
    return kPi - 2 * kPi * (column + 0.5) / kColumns;
}

double solid_angle(double theta) {
    return 4 * kPi / kColumns * std::sin(theta) * std::sin(kPi / (2.0 * kRows));
}

using Rows = std::function<std::vector<double>(std::size_t, std::size_t)>;

std::vector<double> sum_rows(const Rows& rows) {
    const auto add = [](std::vector<double>& sum, const std::vector<double>& part) {
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += part[k];
    };
    return ordered_reduce(std::size_t{kRows}, 32, std::vector<double>(kChannels * kSlots), rows,
                          add);
}

std::vector<double> by_pixels(const std::vector<float>& map) {
    float seed[kOrder], a[kOrder][kOrder] = {}, b[kOrder][kOrder] = {};
    double square = 1 / (4 * kPi);
    for (int m = 0; m < kOrder; ++m) {
        if (m > 0) square *= (2.0 * m + 1) / (2.0 * m);
        seed[m] = static_cast<float>(std::sqrt(m > 0 ? 2 * square : square));
        double previous = 0;
        for (int l = m + 1; l < kOrder; ++l) {
            const double step = std::sqrt((2.0 * l - 1) * (2 * l + 1) / ((l - m) * (l + m)));
            a[m][l] = static_cast<float>(step);
            b[m][l] = static_cast<float>(previous > 0 ? step / previous : 0);
            previous = step;
        }
    }
    std::vector<float> x(kColumns), z(kColumns);
    for (int i = 0; i < kColumns; ++i) {
        x[i] = static_cast<float>(std::sin(column_angle(i)));
        z[i] = static_cast<float>(std::cos(column_angle(i)));
    }
    return sum_rows([&](std::size_t begin, std::size_t end) {
        std::vector<double> sums(kChannels * kSlots);
        for (std::size_t j = begin; j < end; ++j) {
            const double theta = kPi * (j + 0.5) / kRows;
            const auto s = static_cast<float>(std::sin(theta));
            const auto up = static_cast<float>(std::cos(theta));
            const auto weight = static_cast<float>(solid_angle(theta));
            for (int i = 0; i < kColumns; ++i) {
                const float* pixel = map.data() + j * kRowSize + std::size_t{kChannels} * i;
                const float r = weight * pixel[0], g = weight * pixel[1], bl = weight * pixel[2];
                float re = 1, im = 0;
                for (int m = 0; m < kOrder; ++m) {
                    float q = seed[m], before = 0;
                    for (int l = m; l < kOrder; ++l) {
                        if (l > m) {
                            const float next = a[m][l] * (s * z[i]) * q - b[m][l] * before;
                            before = q;
                            q = next;
                        }
                        double* c = sums.data() + l * (l + 1);
                        c[m] += r * (q * re);
                        c[m + kSlots] += g * (q * re);
                        c[m + 2 * kSlots] += bl * (q * re);
                        if (m > 0) {
                            *(c - m) += r * (q * im);
                            *(c - m + kSlots) += g * (q * im);
                            *(c - m + 2 * kSlots) += bl * (q * im);
                        }
                    }
                    const float turned = s * x[i] * re - up * im;
                    im = s * x[i] * im + up * re;
                    re = turned;
                }
            }
        }
        return sums;
    });
}

std::vector<double> by_batches(const std::vector<float>& map) {
    std::vector<float> sine(kColumns), cosine(kColumns);
    for (int i = 0; i < kColumns; ++i) {
        sine[i] = static_cast<float>(std::sin(column_angle(i)));
        cosine[i] = static_cast<float>(std::cos(column_angle(i)));
    }
    return sum_rows([&](std::size_t begin, std::size_t end) {
        std::vector<double> sums(kChannels * kSlots);
        std::vector<float> x(kColumns), y(kColumns), z(kColumns), values(kRowSize);
        for (std::size_t j = begin; j < end; ++j) {
            const double theta = kPi * (j + 0.5) / kRows;
            const auto s = static_cast<float>(std::sin(theta));
            const auto weight = static_cast<float>(solid_angle(theta));
            std::fill(y.begin(), y.end(), static_cast<float>(std::cos(theta)));
            for (int i = 0; i < kColumns; ++i) {
                x[i] = s * sine[i];
                z[i] = s * cosine[i];
                for (int c = 0; c < kChannels; ++c) {
                    values[c * kColumns + i] =
                        weight * map[j * kRowSize + std::size_t{kChannels} * i + c];
                }
            }
            project_basis_batch(kOrder, kColumns, x.data(), y.data(), z.data(), kChannels,
                                values.data(), sums.data());
        }
        return sums;
    });
}

double difference(const std::vector<double>& values, const std::vector<double>& exact) {
    double worst = 0, largest = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        worst = std::max(worst, std::abs(values[i] - exact[i]));
        largest = std::max(largest, std::abs(exact[i]));
    }
    return worst / largest;
}

using Projection = std::function<std::vector<double>(const std::vector<float>&)>;

std::vector<double> project(const std::vector<float>& map, int order, MapRule rule) {
    return project_latlong(map.data(), kRows, kColumns, kChannels, order, rule);
}

void add(const std::string& name, int threads, bool judged, const Projection& body) {
    const std::string full = name + '/' + std::to_string(threads);
    benchmark::RegisterBenchmark(full.c_str(),
                                 [=](benchmark::State& state) {
                                     const ThreadLimit limit(threads);
                                     const std::vector<float>& map = picture();
                                     std::vector<double> result;
                                     for (auto _ : state)
                                         benchmark::DoNotOptimize(result = body(map));
                                     if (!judged) return;
                                     state.counters["max_error"] = difference(
                                         result, project(map, kOrder, MapRule::pixel_means));
                                 })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
}

void add_all(int threads) {
    add("read", threads, false, [](const std::vector<float>& map) {
        return std::vector<double>(1, static_cast<double>(read_map(map)));
    });
    for (const int order : {3, 6, 12, 24}) {
        add("project/" + std::to_string(order), threads, order == kOrder,
            [=](const std::vector<float>& map) {
                return project(map, order, MapRule::pixel_means);
            });
    }
    add("samples/6", threads, true, [](const std::vector<float>& map) {
        return project(map, kOrder, MapRule::centre_samples);
    });
    add("transform/64", threads, false, [](const std::vector<float>& map) {
        std::vector<float> out(kChannels * sh_count(64));
        SphericalTransform(kRows, kColumns, 63).analyze(map.data(), kChannels, out.data());
        return std::vector<double>(out.begin(), out.end());
    });
    add("batch/6", threads, true, by_batches);
    add("pixels/6", threads, true, by_pixels);
}

/// Prints the usual table and keeps the fastest time of each.
class Reporter : public benchmark::ConsoleReporter {
  public:
    Reporter() : ConsoleReporter(OO_Tabular) {}

    void ReportRuns(const std::vector<Run>& runs) override {
        ConsoleReporter::ReportRuns(runs);
        for (const Run& run : runs) {
            if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
            const std::string& name = run.run_name.function_name;
            const bool alone = name.substr(name.rfind('/')) == "/1";
            const double time = alone ? run.GetAdjustedCPUTime() : run.GetAdjustedRealTime();
            double& best = best_[name];
            if (best == 0 || time < best) best = time;
        }
    }

    void line(const std::string& a, const std::string& b, const char* promise) const {
        const auto first = best_.find(a), second = best_.find(b);
        if (first == best_.end() || second == best_.end()) return;
        std::printf("%-14s : %-12s %8.2f ms : %7.2f ms = %7.3f  %s\n", a.c_str(), b.c_str(),
                    first->second, second->second, first->second / second->second, promise);
    }

  private:
    std::map<std::string, double> best_;
};

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    std::vector<int> counts = {1};
    if (airlight::thread_count() > 1) counts.push_back(airlight::thread_count());
    for (const int threads : counts) airlight::add_all(threads);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    airlight::Reporter reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    std::printf("\n4096 x 2048 float RGB, the fastest of each\n");
    for (const int threads : counts) {
        const std::string end = '/' + std::to_string(threads);
        reporter.line("project/6" + end, "read" + end, "(<= 3, aim 1.5)");
        for (const char* name : {"project/3", "project/12", "project/24", "samples/6",
                                 "transform/64", "batch/6", "pixels/6"}) {
            reporter.line(name + end, "read" + end, "");
        }
    }
    benchmark::Shutdown();
    return 0;
}
