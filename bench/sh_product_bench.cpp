// SPDX-License-Identifier: Apache-2.0
// Rotations and products of spherical-harmonic vectors: error beside time, one thread.
//
// `per_vector` is the time of one vector (of one pair, of one vertex) among 64 that lie in cache;
// `max_error` the largest error of a coefficient over the largest one of the exact result. Names
// end in the SIMD target, where one is forced; the loops without a target are the baselines,
// written as one writes them first.
#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <string>
#include <vector>

#include "sh/index.h"
#include "sh/rotation.h"

namespace airlight {
namespace {

constexpr std::size_t kVectors = 64;

std::vector<float> random_vectors(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<float> out(count);
    for (float& value : out) value = uniform(random);
    return out;
}

std::string name_of(const std::string& what, int order, std::int64_t target) {
    const std::string name = what + "/order:" + std::to_string(order);
    return target == 0 ? name : name + "/" + hwy::TargetName(target);
}

double largest_error(const std::vector<double>& exact, const std::vector<float>& values) {
    double error = 0, size = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        error = std::max(error, std::abs(values[i] - exact[i]));
        size = std::max(size, std::abs(exact[i]));
    }
    return error / size;
}

// run(out) computes kVectors results, each out.size() / kVectors numbers, on the given target, or
// on whatever there is when that is 0.
template <class Run>
void add(const std::string& name, std::int64_t target, const std::vector<double>& exact,
         const Run& run) {
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        std::vector<float> out(exact.size());
        for (auto _ : state) {
            run(out.data());
            benchmark::DoNotOptimize(out.data());
            benchmark::ClobberMemory();
        }
        hwy::SetSupportedTargetsForTest(0);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        state.counters["max_error"] = largest_error(exact, out);
        state.counters["per_vector"] = benchmark::Counter(
            kVectors, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    });
}

void add_rotations(int order) {
    const glm::dquat turn = glm::normalize(glm::dquat(0.3, 0.5, -0.7, 0.2));
    const ShRotation rotation(order, turn);
    const std::size_t size = sh_count(order);
    const auto in = random_vectors(kVectors * size, 1);
    std::vector<double> exact(in.begin(), in.end());
    rotation.rotate(kVectors, exact.data(), exact.data());
    std::vector<float> planes(in.size());
    std::vector<double> exact_planes(in.size());
    for (std::size_t v = 0; v < kVectors; ++v) {
        for (std::size_t k = 0; k < size; ++k) {
            planes[k * kVectors + v] = in[v * size + k];
            exact_planes[k * kVectors + v] = exact[v * size + k];
        }
    }
    std::vector<float> matrices;
    for (int l = 0; l < order; ++l) {
        matrices.insert(matrices.end(), rotation.block(l),
                        rotation.block(l) + (2 * l + 1) * (2 * l + 1));
    }
    add(name_of("rotate/loop", order, 0), 0, exact, [=](float* out) {
        for (std::size_t v = 0; v < kVectors; ++v) {
            const float* entry = matrices.data();
            for (int l = 0; l < order; ++l) {
                const float* band = &in[v * size + static_cast<std::size_t>(l * l)];
                for (int m = 0; m < 2 * l + 1; ++m) {
                    float sum = 0;
                    for (int k = 0; k < 2 * l + 1; ++k) sum += *entry++ * band[k];
                    *out++ = sum;
                }
            }
        }
    });
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        add(name_of("rotate/vectors", order, target), target, exact,
            [=](float* out) { rotation.rotate(kVectors, in.data(), out); });
        add(name_of("rotate/planes", order, target), target, exact_planes,
            [=](float* out) { rotation.rotate_planes(kVectors, kVectors, planes.data(), out); });
    }
    benchmark::RegisterBenchmark(name_of("rotate/build", order, 0).c_str(),
                                 [=](benchmark::State& state) {
                                     for (auto _ : state) {
                                         ShRotation built(order, turn);
                                         benchmark::DoNotOptimize(built.block(0));
                                     }
                                 });
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    for (const int order : {3, 4, 5, 6, 8, 16}) airlight::add_rotations(order);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
}
