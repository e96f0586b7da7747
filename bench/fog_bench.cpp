// SPDX-License-Identifier: Apache-2.0
// The speed of fog against libsharp, in one run on one map.
//
// Each round runs three analysis and synthesis pairs of libsharp, then every method of fog once
// (plan, scattered light and direct light of an RGB map), so that whatever else the machine does
// meets both. The table gives medians over the rounds, of times and of the ratios within a round.
// CPU time is the whole process's; on a busy machine its ratio is the steadier one.
//
// Memory is measured in a process of its own per method: the peak beyond what the process held
// before it had the map, over the bytes of the map (float RGB). The map itself and the result are
// 2 of that.
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/rounds.h"
#include "bench/sharp_pairs.h"
#include "cli/ladder_map.h"
#include "core/memory.h"
#include "core/threads.h"
#include "envmap/fog.h"

namespace airlight {
namespace {

struct BenchOptions {
    int width = 2048, height = 1024;
    int threads = 1;
    int rounds = 7;
    double thickness = 1;
};

struct Contender {
    std::string name;
    FogOptions options;
};

// Rings cost rows^2 columns: minutes on large maps.
constexpr int kLargestRings = 256;

std::vector<Contender> contenders(const BenchOptions& bench) {
    std::vector<Contender> list;
    const auto add = [&](const std::string& name, FogMethod method, double tolerance) {
        FogOptions options;
        options.optical_thickness = {bench.thickness};
        options.method = method;
        options.tolerance = tolerance;
        list.push_back({name, options});
    };
    for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
        add(fmt::format("split {:.0e}", tolerance), FogMethod::split, tolerance);
    }
    add("sh, all bands", FogMethod::sh, 1e-3);
    if (bench.height <= kLargestRings) add("rings", FogMethod::rings, 1e-5);
    return list;
}

Image fog(const Image& map, const FogOptions& options) {
    const FogPlan plan = plan_fog(map.height, map.width, map.channels, options);
    Image out = scattered_light(map, plan);
    add_direct_light(map, plan, out);
    return out;
}

// Runs in a child, which must be made before this process has threads.
double peak_over_map(const BenchOptions& bench, const FogOptions& options) {
    int ends[2];
    if (pipe(ends) != 0) return 0;
    const pid_t child = fork();
    if (child == 0) {
        const ThreadLimit limit(bench.threads);
        const std::size_t floor = peak_memory();
        const Image map = sun_and_sky(bench.width, bench.height);
        fog(map, options);
        const double ratio = static_cast<double>(peak_memory() - floor) / map.bytes();
        const bool written = write(ends[1], &ratio, sizeof ratio) == sizeof ratio;
        _exit(written ? 0 : 1);
    }
    close(ends[1]);
    double ratio = 0;
    if (child < 0 || read(ends[0], &ratio, sizeof ratio) != sizeof ratio) ratio = 0;
    close(ends[0]);
    if (child > 0) waitpid(child, nullptr, 0);
    return ratio;
}

std::string plan_text(const BenchOptions& bench, const FogOptions& options) {
    const FogPlan plan = plan_fog(bench.height, bench.width, 3, options);
    std::string text = plan.lmax < 0 ? "" : fmt::format("lmax {}", plan.lmax);
    if (plan.method == FogMethod::split) text += fmt::format(", radius {:.4f}", plan.radius);
    return text;
}

std::string column(const std::vector<double>& values, const char* format) {
    return values.empty() ? "" : fmt::format(fmt::runtime(format), median(values));
}

void run(const BenchOptions& bench) {
    const std::vector<Contender> list = contenders(bench);
    std::vector<double> memory;
    for (const Contender& contender : list) {
        memory.push_back(peak_over_map(bench, contender.options));
    }
    const ThreadLimit limit(bench.threads);
    const Image map = sun_and_sky(bench.width, bench.height);
    const std::size_t first = SharpPairs::available() ? 1 : 0;
    std::vector<std::vector<double>> wall(first + list.size()), cpu(wall), wall_ratio(wall),
        cpu_ratio(wall);
    // The round before the first only warms up.
    for (int round = -1; round < bench.rounds; ++round) {
        std::vector<Seconds> seconds;
        if (first == 1) {
            SharpPairs sharp(bench.height, bench.width, bench.threads);
            seconds.push_back(measure([&] {
                sharp.analyze();
                sharp.synthesize();
            }));
        }
        for (const Contender& contender : list) {
            seconds.push_back(measure([&] { fog(map, contender.options); }));
        }
        for (std::size_t i = 0; i < seconds.size() && round >= 0; ++i) {
            wall[i].push_back(1e3 * seconds[i].wall);
            cpu[i].push_back(1e3 * seconds[i].cpu);
            if (first == 0) continue;
            wall_ratio[i].push_back(seconds[i].wall / seconds[0].wall);
            cpu_ratio[i].push_back(seconds[i].cpu / seconds[0].cpu);
        }
    }
    fmt::print("fog of a {} x {} RGB map, T = {}, {} thread{}, {} rounds\n\n", bench.width,
               bench.height, bench.thickness, bench.threads, bench.threads == 1 ? "" : "s",
               bench.rounds);
    fmt::print("{:<18}{:>10}{:>10}{:>12}{:>12}{:>16}{:>12}\n", "", "wall ms", "CPU ms",
               "/ libsharp", "/ libsharp", "range of", "peak memory");
    fmt::print("{:<18}{:>10}{:>10}{:>12}{:>12}{:>16}{:>12}\n", "method", "", "", "by wall",
               "by CPU", "CPU ratios", "/ map");
    for (std::size_t i = 0; i < wall.size(); ++i) {
        const bool sharp = i < first;
        const std::string range =
            sharp || cpu_ratio[i].empty()
                ? ""
                : fmt::format("{:.2f} - {:.2f}",
                              *std::min_element(cpu_ratio[i].begin(), cpu_ratio[i].end()),
                              *std::max_element(cpu_ratio[i].begin(), cpu_ratio[i].end()));
        fmt::print("{:<18}{:>10}{:>10}{:>12}{:>12}{:>16}{:>12}  {}\n",
                   sharp ? "libsharp, 3 pairs" : list[i - first].name, column(wall[i], "{:.1f}"),
                   column(cpu[i], "{:.1f}"), column(wall_ratio[i], "{:.3f}"),
                   column(cpu_ratio[i], "{:.3f}"), range,
                   sharp ? "" : fmt::format("{:.2f}", memory[i - first]),
                   sharp ? "" : plan_text(bench, list[i - first].options));
    }
    if (first == 0) fmt::print("\nThis build has no libsharp (Debian: libsharp-dev).\n");
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    CLI::App program("The speed of fog, interleaved with libsharp's transforms", "fog_bench");
    airlight::BenchOptions bench;
    std::string size = "2048x1024";
    program.add_option("size", size, "WIDTHxHEIGHT of the map (default: 2048x1024)");
    program.add_option("--threads", bench.threads, "Threads (default: 1)")
        ->check(CLI::Range(1, 4096));
    program.add_option("--rounds", bench.rounds, "Rounds (default: 7)")->check(CLI::Range(1, 1000));
    program.add_option("--optical-thickness", bench.thickness, "T (default: 1)")
        ->check(CLI::PositiveNumber);
    CLI11_PARSE(program, argc, argv);
    if (std::sscanf(size.c_str(), "%dx%d", &bench.width, &bench.height) != 2 || bench.height < 2 ||
        bench.width < 2 || bench.width > 32768 || bench.height > 16384) {
        fmt::print(stderr, "fog_bench: '{}' is no size such as 2048x1024\n", size);
        return 2;
    }
    airlight::run(bench);
    return 0;
}
