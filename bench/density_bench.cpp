// SPDX-License-Identifier: Apache-2.0
// Accuracy against time of the density fields, one pass over 4096 rays of the Earth's atmosphere
// per iteration; time is per ray.
//
// Rays start up to 100 km above R = 6371 km, H = 8 km or 1.2 km. Sets: "metre", 1 cm to 1 m;
// "short", 1 m to 100 m; "long", 1 km to 700 km; "crossing", through the periapsis. Counters:
// largest and median relative error against the double function at the floats that are given, over
// the rays whose depth is at least 1e-30 and finite.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "medium/chapman.h"
#include "medium/height_density.h"
#include "medium/scaled_erfc.h"
#include "medium/spherical_density.h"
#include "medium/spherical_rungs.h"

namespace airlight {
namespace {

constexpr int kRays = 4096;

struct Ray {
    float radius, scale_height, r, cosine, distance;
};

std::vector<Ray> rays_of(const std::string& set) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Ray> rays;
    while (rays.size() < kRays) {
        Ray ray = {6371, unit(random) < 0.5 ? 8.0f : 1.2f, 0, 0, 0};
        ray.r = static_cast<float>(6371 + std::pow(10, -2 + 4 * unit(random)));
        ray.cosine = static_cast<float>(2 * unit(random) - 1);
        if (set == "metre") {
            ray.distance = static_cast<float>(std::pow(10, -5 + 2 * unit(random)));
        } else if (set == "short") {
            ray.distance = static_cast<float>(std::pow(10, -3 + 2 * unit(random)));
        } else {
            ray.distance = static_cast<float>(std::pow(10, 2.85 * unit(random)));
        }
        if (set == "crossing") {
            ray.cosine = static_cast<float>(-0.05 * unit(random));
            ray.distance = static_cast<float>(-ray.r * ray.cosine * (1 + unit(random)));
        }
        rays.push_back(ray);
    }
    return rays;
}

double exact_depth(const Ray& ray) {
    return spherical_depth(SphericalProfile{ray.radius, ray.scale_height},
                           SphericalRay{ray.r, ray.cosine}, double{ray.distance});
}

template <class Method>
void run(benchmark::State& state, const std::string& set, const Method& method) {
    const std::vector<Ray> rays = rays_of(set);
    std::vector<double> errors;
    for (const Ray& ray : rays) {
        const double exact = exact_depth(ray);
        if (!(exact > 1e-30) || exact > 1e30) continue;
        const double error = std::abs(double{method(ray)} / exact - 1);
        errors.push_back(std::isnan(error) ? HUGE_VAL : error);
    }
    std::sort(errors.begin(), errors.end());
    for (auto _ : state) {
        for (const Ray& ray : rays) benchmark::DoNotOptimize(method(ray));
    }
    state.SetItemsProcessed(state.iterations() * kRays);
    state.counters["per_ray"] = benchmark::Counter(
        kRays, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["max_error"] = errors.back();
    state.counters["median_error"] = errors[errors.size() / 2];
}

template <class Method>
void add_spherical(const std::string& name, const Method& method) {
    for (const std::string set : {"metre", "short", "long", "crossing"}) {
        benchmark::RegisterBenchmark(
            ("spherical_depth/" + name + "/" + set).c_str(),
            [set, method](benchmark::State& state) { run(state, set, method); });
    }
}

template <class Function>
void add_per_ray(const std::string& name, const Function& function) {
    benchmark::RegisterBenchmark(name.c_str(), [function](benchmark::State& state) {
        const std::vector<Ray> rays = rays_of("long");
        for (auto _ : state) {
            for (const Ray& ray : rays) benchmark::DoNotOptimize(function(ray));
        }
        state.counters["per_ray"] = benchmark::Counter(
            kRays, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    });
}

void add_chapman() {
    for (const NamedMethod<ChapmanMethod>& info : kChapmanMethods) {
        benchmark::RegisterBenchmark(
            ("chapman/" + std::string(info.name)).c_str(),
            [method = info.method](benchmark::State& state) {
                const std::vector<Ray> rays = rays_of("long");
                double largest = 0;
                for (const Ray& ray : rays) {
                    const double z = ray.r / ray.scale_height, c = std::abs(ray.cosine);
                    largest =
                        std::max(largest, std::abs(ln_chapman(z, c, method) - ln_chapman(z, c)));
                }
                for (auto _ : state) {
                    for (const Ray& ray : rays) {
                        benchmark::DoNotOptimize(ln_chapman(ray.r / ray.scale_height,
                                                            std::abs(double{ray.cosine}), method));
                    }
                }
                state.counters["max_error"] = largest;
                state.counters["per_ray"] =
                    benchmark::Counter(kRays, benchmark::Counter::kIsIterationInvariantRate |
                                                  benchmark::Counter::kInvert);
            });
    }
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    using namespace airlight;
    add_spherical("article-float", [](const Ray& ray) {
        return spherical_depth_article(ray.radius, ray.scale_height, ray.r, ray.cosine,
                                       ray.distance);
    });
    add_spherical("float", [](const Ray& ray) {
        return spherical_depth(ray.radius, ray.scale_height, ray.r, ray.cosine, ray.distance);
    });
    add_spherical("double", exact_depth);
    add_spherical("flat", [](const Ray& ray) {
        return spherical_depth_flat({ray.radius, ray.scale_height}, {ray.r, ray.cosine},
                                    ray.distance);
    });
    add_chapman();
    add_per_ray("erfcx/exact", [](const Ray& ray) { return erfcx(double{ray.r} - 6371); });
    add_per_ray("erfcx/rational9", [](const Ray& ray) { return erfcx_rational9(ray.r - 6371); });
    add_per_ray("spherical_distance", [](const Ray& ray) {
        return spherical_distance(SphericalProfile{ray.radius, ray.scale_height},
                                  SphericalRay{ray.r, ray.cosine}, double{ray.distance}, 1e-3);
    });
    add_per_ray("exponential_height_depth", [](const Ray& ray) {
        return exponential_height_depth(double{ray.r} - 6371, double{ray.cosine},
                                        double{ray.distance}, 1 / double{ray.scale_height});
    });
    add_per_ray("exponential_height_distance", [](const Ray& ray) {
        return exponential_height_distance(1e-3, double{ray.r} - 6371, double{ray.cosine},
                                           1 / double{ray.scale_height});
    });
    add_per_ray("linear_height_depth", [](const Ray& ray) {
        return linear_height_depth(-0.01, 1.0, double{ray.r} - 6371, double{ray.cosine},
                                   double{ray.distance});
    });
    add_per_ray("linear_height_distance", [](const Ray& ray) {
        return linear_height_distance(0.1, -0.01, 1.0, double{ray.r} - 6371, double{ray.cosine});
    });
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
