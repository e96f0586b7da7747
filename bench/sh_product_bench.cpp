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

#include "sh/function_grid.h"
#include "sh/index.h"
#include "sh/product.h"
#include "sh/product_matrix.h"
#include "sh/rotation.h"
#include "sh/triple_product.h"

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

std::vector<double> to_planes(const std::vector<double>& vectors, std::size_t size) {
    std::vector<double> out(vectors.size());
    for (std::size_t v = 0; v < kVectors; ++v) {
        for (std::size_t k = 0; k < size; ++k) out[k * kVectors + v] = vectors[v * size + k];
    }
    return out;
}

std::vector<float> to_float(const std::vector<double>& values) {
    return {values.begin(), values.end()};
}

// The terms of the sum over Gamma as one writes them first: one after the other, in float.
struct LooseTerm {
    int i, j, k;
    float value;
};

std::vector<LooseTerm> loose_terms(const TripleProducts& triples) {
    std::vector<LooseTerm> out;
    const auto size = static_cast<int>(sh_count(triples.order()));
    for (int k = 0; k < size; ++k) {
        for (int i = 0; i < size; ++i) {
            for (int j = 0; j < size; ++j) {
                const double value =
                    triples.at(static_cast<std::size_t>(i), static_cast<std::size_t>(j),
                               static_cast<std::size_t>(k));
                if (value != 0) out.push_back({i, j, k, static_cast<float>(value)});
            }
        }
    }
    return out;
}

void add_products(int order) {
    const std::size_t size = sh_count(order);
    const auto a = random_vectors(kVectors * size, 2), b = random_vectors(kVectors * size, 3);
    const std::vector<double> exact_a(a.begin(), a.end()), exact_b(b.begin(), b.end());
    std::vector<double> exact(a.size());
    ShProduct(order, ShProductMethod::sparse)
        .multiply(kVectors, exact_a.data(), exact_b.data(), exact.data());
    const auto plane_a = to_float(to_planes(exact_a, size));
    const auto plane_b = to_float(to_planes(exact_b, size));
    const auto exact_planes = to_planes(exact, size);
    const TripleProducts triples(order);
    add(name_of("product/loop", order, 0), 0, exact, [=, terms = loose_terms(triples)](float* out) {
        std::fill_n(out, kVectors * size, 0.0f);
        for (std::size_t v = 0; v < kVectors; ++v) {
            const float* const x = &a[v * size];
            const float* const y = &b[v * size];
            float* const z = out + v * size;
            for (const LooseTerm& t : terms) z[t.k] += t.value * x[t.i] * y[t.j];
        }
    });
    for (const auto& info : kShProductMethods) {
        if (info.method == ShProductMethod::tree && order > 5) continue;
        const ShProduct product(order, info.method);
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
            const std::string name = "product/" + std::string(info.name);
            add(name_of(name + "/vectors", order, target), target, exact,
                [=](float* out) { product.multiply(kVectors, a.data(), b.data(), out); });
            if (info.method == ShProductMethod::grid) continue;
            add(name_of(name + "/planes", order, target), target, exact_planes, [=](float* out) {
                product.multiply_planes(kVectors, kVectors, plane_a.data(), plane_b.data(), out);
            });
            if (info.method == ShProductMethod::sparse) break;
        }
    }
    const auto light = random_vectors(size, 4);
    const std::vector<double> exact_light(light.begin(), light.end());
    const ShProductMatrix matrix(triples, light.data());
    std::vector<double> integrals(kVectors), dots(kVectors);
    matrix.integral(kVectors, exact_a.data(), exact_b.data(), integrals.data());
    sh_dot(order, exact_light.data(), kVectors, exact_a.data(), dots.data());
    add(name_of("triple/loop", order, 0), 0, integrals,
        [=, terms = loose_terms(triples)](float* out) {
            for (std::size_t v = 0; v < kVectors; ++v) {
                float sum = 0;
                for (const LooseTerm& t : terms) {
                    sum += t.value * light[static_cast<std::size_t>(t.i)] *
                           a[v * size + static_cast<std::size_t>(t.j)] *
                           b[v * size + static_cast<std::size_t>(t.k)];
                }
                out[v] = sum;
            }
        });
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        add(name_of("triple/matrix", order, target), target, integrals,
            [=](float* out) { matrix.integral(kVectors, a.data(), b.data(), out); });
        add(name_of("triple/product", order, target), target, integrals,
            [=, product = ShProduct(order)](float* out) {
                std::vector<float> products(kVectors * size);
                product.multiply(kVectors, a.data(), b.data(), products.data());
                sh_dot(order, light.data(), kVectors, products.data(), out);
            });
        add(name_of("triple/dot", order, target), target, dots,
            [=](float* out) { sh_dot(order, light.data(), kVectors, a.data(), out); });
    }
    benchmark::RegisterBenchmark(name_of("triple/matrix_build", order, 0).c_str(),
                                 [=](benchmark::State& state) {
                                     for (auto _ : state) {
                                         ShProductMatrix built(triples, light.data());
                                         benchmark::DoNotOptimize(built.data());
                                     }
                                 });
}

// exp of f, |f| up to about 3; the error of the float grid over that of the same grid in double.
void add_functions(int order) {
    const std::size_t size = sh_count(order);
    const ShGrid grid(order);
    auto in = random_vectors(kVectors * size, 5);
    for (float& value : in) value /= static_cast<float>(order);
    std::vector<double> exact(in.size()), clamped(in.size()), one(size);
    for (std::size_t v = 0; v < kVectors; ++v) {
        std::copy_n(in.begin() + static_cast<std::ptrdiff_t>(v * size), size, one.begin());
        grid.apply([](double x) { return std::exp(x); }, one.data(), &exact[v * size]);
        grid.apply([](double x) { return std::clamp(x, 0.0, 1.0); }, one.data(),
                   &clamped[v * size]);
    }
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        add(name_of("function/exp", order, target), target, exact,
            [=](float* out) { grid.exponential(kVectors, in.data(), out); });
        add(name_of("function/clamp", order, target), target, clamped,
            [=](float* out) { grid.clamp(kVectors, 0, 1, in.data(), out); });
    }
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    for (const int order : {3, 4, 5, 6, 8, 16}) airlight::add_rotations(order);
    for (const int order : {3, 4, 5, 6, 8}) {
        airlight::add_products(order);
        airlight::add_functions(order);
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
}
