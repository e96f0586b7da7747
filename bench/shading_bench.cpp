// SPDX-License-Identifier: Apache-2.0
// Nanoseconds of one vertex's exit radiance, R, G and B, on one thread; and errors in fog.
//
// In each round every contender shades all vertices once. The floor is a loop that reads the rows
// and nothing else; ratios are to it, medians over the rounds. With --vertices 2000 the rows lie in
// the second level of cache, with 400000 in memory. Rows are those of surfaces that face anywhere.
#include <fmt/format.h>
#include <hwy/targets.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "bench/rounds.h"
#include "core/constants.h"
#include "core/threads.h"
#include "prt/fog_shading.h"
#include "prt/lobe_shading.h"
#include "prt/shading.h"
#include "sh/basis.h"
#include "sh/brdf_models.h"
#include "sh/index.h"
#include "sh/lobes.h"

namespace airlight {
namespace {

float read_all(const std::vector<float>& values) {
    constexpr std::size_t kLanes = 64;
    float sums[kLanes] = {};
    for (std::size_t i = 0; i + kLanes <= values.size(); i += kLanes) {
        for (std::size_t k = 0; k < kLanes; ++k) sums[k] += values[i + k];
    }
    float sum = 0;
    for (const float value : sums) sum += value;
    return sum;
}

struct Vertices {
    int order;
    std::vector<float> rows, thickness;
    std::vector<glm::vec3> axes, views;
    ShLight light;

    Vertices(int n, std::size_t count) : order(n) {
        std::mt19937 random(1);
        std::normal_distribution<double> normal;
        const auto direction = [&] {
            const glm::dvec3 v(normal(random), normal(random), normal(random));
            return glm::vec3(v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z));
        };
        const std::size_t size = sh_count(order);
        std::vector<double> basis(size), cosine = clamped_cosine_eigenvalues(order);
        std::vector<double> lamps(3 * size);
        for (std::size_t c = 0; c < 12; ++c) {
            const glm::vec3 lamp = direction();
            evaluate_basis(order, lamp.x, lamp.y, lamp.z, basis.data());
            for (std::size_t k = 0; k < size; ++k) lamps[c % 3 * size + k] += basis[k];
        }
        light = sh_light(order, lamps.data());
        for (std::size_t v = 0; v < count; ++v) {
            axes.push_back(direction());
            views.push_back(direction());
            evaluate_basis(order, axes[v].x, axes[v].y, axes[v].z, basis.data());
            for (std::size_t k = 0; k < size; ++k) {
                const auto l = static_cast<std::size_t>(sh_degree(k).l);
                rows.push_back(static_cast<float>(cosine[l] / kPi * basis[k]));
            }
            thickness.push_back(0.01f * static_cast<float>(v % 300));
        }
    }
    VertexRows run() const { return {order, axes.size(), rows.data()}; }
};

struct Contender {
    std::string name;
    std::function<void(float*)> shade;
    std::size_t share = 1;  ///< of the vertices, for slow ones
    std::vector<double> nanoseconds = {}, ratios = {};
};

void time_all(int order, std::size_t count, int rounds) {
    const Vertices all(order, count);
    const Vertices few(order, std::max<std::size_t>(1, count / 100));
    std::vector<float> radiance(3 * count);
    std::vector<Contender> contenders;
    float kept = 0;
    contenders.push_back({"floor: rows read", [&](float*) { kept += read_all(all.rows); }});
    contenders.push_back(
        {"dot", [&](float* out) { shade_transfer(all.run(), all.light, glm::vec3(0.5f), out); }});
    struct Fog {
        FogShading shading;
        FogLight light;
        FogWeights weights;
    };
    std::vector<Fog> fogs;
    fogs.reserve(8);
    for (const NamedMethod<FogShadingMethod>& each : kFogShadingMethods) {
        if (each.method == FogShadingMethod::exact) continue;
        const FogShading fog(order, each.method);
        fogs.push_back({fog, fog.light(all.light), fog.weights(count, all.thickness.data())});
        const Fog* const made = &fogs.back();
        contenders.push_back({fmt::format("dot, fog {}", each.name), [&all, made](float* out) {
                                  shade_transfer(all.run(), made->light, made->weights,
                                                 glm::vec3(0.5f), out);
                              }});
        contenders.push_back({fmt::format("  its weights"), [&all, made, count](float*) {
                                  made->shading.weights(count, all.thickness.data());
                              }});
    }
    const auto lobe = phong_eigenvalues(10, order, LobeScale::integral);
    const LobeShader by_product(lobe), by_matrix(lobe, LobeShadingMethod::matrix);
    contenders.push_back({"triple, product", [&](float* out) {
                              by_product.shade(all.run(), all.axes.data(), all.light,
                                               glm::vec3(0.5f), out);
                          }});
    contenders.push_back({"triple, matrix", [&](float* out) {
                              by_matrix.shade(all.run(), all.axes.data(), all.light,
                                              glm::vec3(0.5f), out);
                          }});
    for (const std::size_t i : {std::size_t{0}, std::size_t{3}, std::size_t{4}}) {
        const Fog* const made = &fogs[i];
        contenders.push_back({fmt::format("triple, product, fog {}",
                                          method_name(kFogShadingMethods, made->shading.method())),
                              [&, made](float* out) {
                                  by_product.shade(all.run(), all.axes.data(), made->light,
                                                   made->weights, glm::vec3(0.5f), out);
                              }});
    }
    const BrdfShader metal(order, tabulate(RoughMetal{0.5}), 16);
    contenders.push_back({"triple, tabulated BRDF",
                          [&](float* out) {
                              metal.shade(few.run(), few.axes.data(), few.views.data(), few.light,
                                          out);
                          },
                          100});
    // A round shades at least a million vertices in cache, so that the clock does not matter.
    const std::size_t repeats = std::max<std::size_t>(1, 400000 / count);
    for (int round = 0; round < rounds; ++round) {
        for (Contender& each : contenders) {
            const double vertices = static_cast<double>(repeats) *
                                    static_cast<double>(each.share == 1 ? count : few.axes.size());
            const Seconds seconds = measure([&] {
                for (std::size_t i = 0; i < repeats; ++i) each.shade(radiance.data());
            });
            each.nanoseconds.push_back(1e9 * seconds.cpu / vertices);
            each.ratios.push_back(each.nanoseconds.back() / contenders.front().nanoseconds.back());
        }
    }
    fmt::print("\norder {}, {} vertices of {} bytes, {} rounds{}\n", order, count,
               sizeof(float) * sh_count(order), rounds, kept == 1e30f ? "!" : "");
    for (const Contender& each : contenders) {
        fmt::print("  {:36}{:10.2f} ns{:10.2f} floors\n", each.name, median(each.nanoseconds),
                   median(each.ratios));
    }
}

// Against `exact`: largest and root-mean-square error over vertices, relative to their mean.
void print_errors(int order) {
    const Vertices all(order, 300);
    fmt::print("\nerror of the exit radiance in fog, order {}, of the mean radiance at that T\n",
               order);
    fmt::print("  {:10}", "T");
    for (const auto& each : kFogShadingMethods) {
        if (each.method != FogShadingMethod::exact) fmt::print("{:>22}", each.name);
    }
    for (const float t : {0.01f, 0.1f, 0.3f, 1.0f, 2.0f, 4.0f, 10.0f}) {
        const auto shade = [&](FogShadingMethod method) {
            const FogShading fog(order, method);
            // One weight for all.
            const std::vector<float> one = fog.weights(1, &t).values;
            FogWeights weights{1, one.size(), all.axes.size(), {}};
            for (const float weight : one) {
                weights.values.insert(weights.values.end(), weights.vertices, weight);
            }
            std::vector<float> radiance(3 * all.axes.size());
            shade_transfer(all.run(), fog.light(all.light), weights, glm::vec3(1), radiance.data());
            return radiance;
        };
        const std::vector<float> truth = shade(FogShadingMethod::exact);
        double mean = 0;
        for (const float value : truth) mean += double{value} / double(truth.size());
        fmt::print("\n  {:<10}", t);
        for (const auto& each : kFogShadingMethods) {
            if (each.method == FogShadingMethod::exact) continue;
            const std::vector<float> radiance = shade(each.method);
            double most = 0, square = 0;
            for (std::size_t i = 0; i < truth.size(); ++i) {
                const double error = (double{radiance[i]} - double{truth[i]}) / mean;
                most = std::max(most, std::abs(error));
                square += error * error / double(truth.size());
            }
            fmt::print("{:>12.1e}{:>10.1e}", most, std::sqrt(square));
        }
    }
    fmt::print("\n");
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    CLI::App app("Nanoseconds of one vertex's exit radiance, and errors in fog");
    std::vector<int> orders = {4, 5, 6};
    std::vector<std::size_t> counts = {2000, 400000};
    int rounds = 5;
    app.add_option("--order", orders)->check(CLI::Range(1, 10));
    app.add_option("--vertices", counts)->check(CLI::Range(1, 10000000));
    app.add_option("--rounds", rounds)->check(CLI::Range(1, 1000));
    bool avx2 = false;
    app.add_flag("--avx2", avx2, "AVX2 where there is more");
    CLI11_PARSE(app, argc, argv);
    if (avx2) {
        hwy::SetSupportedTargetsForTest(HWY_AVX2);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    }
    const airlight::ThreadLimit one(1);
    for (const int order : orders) {
        for (const std::size_t count : counts) airlight::time_all(order, count, rounds);
    }
    airlight::print_errors(orders.back());
    return 0;
}
