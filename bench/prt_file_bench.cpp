// SPDX-License-Identifier: Apache-2.0
// Writing and reading .prt files beside fwrite and fread of the same numbers. The files go to
// $TMPDIR: on a disk, the disk is measured.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "prt/prt_reader.h"
#include "prt/prt_writer.h"

namespace {

constexpr std::size_t kRows = 400000;
constexpr int kOrder = 6;
constexpr std::size_t kValues = kRows * kOrder * kOrder;

const std::vector<float>& values() {
    static const std::vector<float> all = [] {
        std::vector<float> v(kValues);
        for (std::size_t i = 0; i < v.size(); ++i) v[i] = std::sin(0.37f * static_cast<float>(i));
        return v;
    }();
    return all;
}

std::string path(const char* name) {
    return (std::filesystem::temp_directory_path() / name).string();
}

void write(airlight::PrtType type, const std::string& file) {
    airlight::PrtHeader header;
    header.order = kOrder;
    header.tables = {{airlight::PrtKind::transfer, type}};
    header.rows = header.mesh_vertices = kRows;
    airlight::PrtWriter writer(file, header, true);
    // As a bake gives them.
    constexpr std::size_t kStep = 1000;
    for (std::size_t row = 0; row < kRows; row += kStep) {
        writer.append(kStep, {values().data() + row * kOrder * kOrder});
    }
    writer.finish();
}

void finish(benchmark::State& state, const std::string& file) {
    state.SetBytesProcessed(static_cast<std::int64_t>(4 * kValues) * state.iterations());
    std::filesystem::remove(file);
}

void write_plain(benchmark::State& state) {
    const std::string file = path("airlight-bench.bin");
    values();
    for (auto _ : state) {
        const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "wb"),
                                                                  std::fclose);
        if (!out || std::fwrite(values().data(), 4, kValues, out.get()) != kValues) {
            state.SkipWithError("cannot write");
        }
    }
    finish(state, file);
}

void read_plain(benchmark::State& state) {
    const std::string file = path("airlight-bench.bin");
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "wb"),
                                                        std::fclose);
    std::fwrite(values().data(), 4, kValues, out.get());
    out.reset();
    for (auto _ : state) {
        std::vector<float> back(kValues);
        const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"),
                                                                 std::fclose);
        if (std::fread(back.data(), 4, kValues, in.get()) != kValues) {
            state.SkipWithError("cannot read");
        }
        benchmark::DoNotOptimize(back.data());
    }
    finish(state, file);
}

void write_prt(benchmark::State& state, airlight::PrtType type) {
    const std::string file = path("airlight-bench.prt");
    values();
    for (auto _ : state) write(type, file);
    state.counters["rounding"] = airlight::PrtReader(file).figures()[0].largest_error;
    finish(state, file);
}

void read_prt(benchmark::State& state, airlight::PrtType type) {
    const std::string file = path("airlight-bench.prt");
    write(type, file);
    for (auto _ : state) {
        const airlight::PrtReader reader(file);
        benchmark::DoNotOptimize(reader.read_all(airlight::PrtKind::transfer).data());
    }
    finish(state, file);
}

}  // namespace

BENCHMARK(write_plain)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_prt, float32, airlight::PrtType::float32)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_prt, float16, airlight::PrtType::float16)->Unit(benchmark::kMillisecond);
BENCHMARK(read_plain)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_prt, float32, airlight::PrtType::float32)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_prt, float16, airlight::PrtType::float16)->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
