// SPDX-License-Identifier: Apache-2.0
// The speed of full spherical-harmonics transforms of an RGB map against libsharp, in one run.
//
// Each round runs three analyses and three syntheses of libsharp, then ours of all channels at
// once, in double and in float, at lmax = rows - 1 on pixel-centre rows. The table gives medians of
// CPU times and of the ratios within a round. libsharp's analysis is inexact above rows / 2 on
// these rows; ours is exact, and `error` is the largest error of its bands over the largest band,
// for a map that was synthesised in double from random bands (for a float map, rounded).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bench/rounds.h"
#include "bench/sharp_pairs.h"
#include "core/threads.h"
#include "sh/transform.h"

namespace airlight {
namespace {

constexpr int kChannels = 3;

struct Contender {
    std::string name;
    std::function<void()> run;
    double error = 0;
    bool yardstick = false;
    std::vector<double> cpu = {}, ratio = {};
};

template <class T>
double largest_error(const std::vector<T>& values, const std::vector<double>& exact) {
    double error = 0, largest = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        error = std::max(error, std::abs(static_cast<double>(values[i]) - exact[i]));
        largest = std::max(largest, std::abs(exact[i]));
    }
    return error / largest;
}

void run(int columns, int rows, int rounds, int threads) {
    const ThreadLimit limit(threads);
    const std::size_t pixels = static_cast<std::size_t>(rows) * columns * kChannels;
    const std::size_t bands = static_cast<std::size_t>(rows) * rows * kChannels;
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::vector<double> exact(bands), map(pixels), coefficients(bands), map_back(pixels);
    for (double& value : exact) value = static_cast<float>(normal(random));
    const SphericalTransform transform(rows, columns, rows - 1);
    transform.synthesize(exact.data(), kChannels, map.data());
    const SphericalTransform fast(rows, columns, rows - 1, TransformPrecision::single);
    const std::vector<float> exact_float(exact.begin(), exact.end());
    const std::vector<float> map_float(map.begin(), map.end());
    std::vector<float> coefficients_float(bands), map_back_float(pixels);

    std::vector<Contender> list;
    std::unique_ptr<SharpPairs> sharp;
    if (SharpPairs::available()) {
        sharp = std::make_unique<SharpPairs>(rows, columns, threads);
        list.push_back({"analysis, libsharp, 3", [&] { sharp->analyze(); }, NAN, true});
    }
    list.push_back({"analysis, double",
                    [&] { transform.analyze(map.data(), kChannels, coefficients.data()); }});
    list.push_back({"analysis, float",
                    [&] { fast.analyze(map_float.data(), kChannels, coefficients_float.data()); }});
    if (sharp) list.push_back({"synthesis, libsharp, 3", [&] { sharp->synthesize(); }, NAN, true});
    list.push_back({"synthesis, double",
                    [&] { transform.synthesize(exact.data(), kChannels, map_back.data()); }});
    list.push_back({"synthesis, float", [&] {
                        fast.synthesize(exact_float.data(), kChannels, map_back_float.data());
                    }});

    for (int round = -1; round < rounds; ++round) {
        double yardstick = NAN;
        for (Contender& contender : list) {
            const double cpu = measure(contender.run).cpu;
            if (contender.yardstick) yardstick = cpu;
            if (round < 0) continue;
            contender.cpu.push_back(1e3 * cpu);
            contender.ratio.push_back(cpu / yardstick);
        }
    }
    const double errors[] = {largest_error(coefficients, exact),
                             largest_error(coefficients_float, exact), largest_error(map_back, map),
                             largest_error(map_back_float, map)};
    fmt::print("RGB map {} x {}, lmax {}, {} thread{}, {} rounds\n\n{:<24}{:>10}{:>12}{:>12}\n",
               columns, rows, rows - 1, threads, threads == 1 ? "" : "s", rounds, "", "CPU ms",
               "/ libsharp", "error");
    int next = 0;
    for (const Contender& contender : list) {
        fmt::print("{:<24}{:>10.1f}", contender.name, median(contender.cpu));
        if (sharp) fmt::print("{:>12.3f}", median(contender.ratio));
        if (!contender.yardstick) fmt::print("{:>12.1e}", errors[next++]);
        fmt::print("\n");
    }
    if (!sharp) fmt::print("\nThis build has no libsharp (Debian: libsharp-dev).\n");
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    CLI::App program("The speed of full transforms, interleaved with libsharp's",
                     "transform_bench");
    std::string size = "2048x1024";
    int threads = 1, rounds = 7, columns = 0, rows = 0;
    program.add_option("size", size, "WIDTHxHEIGHT of the map (default: 2048x1024)");
    program.add_option("--threads", threads, "Threads (default: 1)")->check(CLI::Range(1, 4096));
    program.add_option("--rounds", rounds, "Rounds (default: 7)")->check(CLI::Range(1, 1000));
    CLI11_PARSE(program, argc, argv);
    if (std::sscanf(size.c_str(), "%dx%d", &columns, &rows) != 2 || rows < 2 ||
        columns < 2 * rows - 1 || columns > 32768) {
        fmt::print(stderr, "transform_bench: '{}' is no size such as 2048x1024\n", size);
        return 2;
    }
    airlight::run(columns, rows, rounds, threads);
    return 0;
}
