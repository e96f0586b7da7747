// SPDX-License-Identifier: Apache-2.0
// Accuracy against time of the slab's rungs, and the cost of the functions around it.
//
// Counters: max and median error relative to the exact method on 4000 rays with a light,
//     A: sigma_t s <= 1, sigma_t l <= 10, cosines from .1;   B: lengths and 1 / sigma_t over a
//     factor of 1e4, all cosines;
// time is per call.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/constants.h"
#include "medium/particles.h"
#include "medium/refraction.h"
#include "medium/shafts.h"
#include "medium/slab.h"
#include "medium/slab_method.h"
#include "medium/slab_radiance.h"

namespace airlight {
namespace {

struct Ray {
    double sigma_t, s, l, w_dot_n, wl_dot_n, w_dot_wl;
};

std::vector<Ray> rays(char set) {
    std::mt19937_64 random(set);
    const auto unit = [&random] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
    const double least = set == 'A' ? 0.1 : 0;
    std::vector<Ray> all;
    for (int i = 0; i < 4000; ++i) {
        Ray r;
        r.w_dot_n = least + (1 - least) * unit();
        r.wl_dot_n = least + (1 - least) * unit();
        r.w_dot_wl = r.w_dot_n * r.wl_dot_n +
                     std::sqrt((1 - r.w_dot_n * r.w_dot_n) * (1 - r.wl_dot_n * r.wl_dot_n)) *
                         std::cos(kPi * unit());
        r.sigma_t = set == 'A' ? 1 : std::pow(10, -2 + 4 * unit());
        r.s = set == 'A' ? unit() : std::pow(10, -2 + 4 * unit());
        r.l = set == 'A' ? 0.1 + 9.9 * unit() : std::pow(10, -2 + 4 * unit());
        // What has faded to nothing has no relative error worth a place in the median.
        if (slab_near(r.sigma_t, r.s, r.l, r.w_dot_n, r.wl_dot_n, r.w_dot_wl) > 1e-12) {
            all.push_back(r);
        }
    }
    return all;
}

template <class Method>
void run(benchmark::State& state, char set, const Method& method) {
    const std::vector<Ray> cases = rays(set);
    std::vector<double> errors;
    for (const Ray& r : cases) {
        const double exact = slab_near(r.sigma_t, r.s, r.l, r.w_dot_n, r.wl_dot_n, r.w_dot_wl);
        errors.push_back(std::abs(method(r) / exact - 1));
    }
    std::sort(errors.begin(), errors.end());
    std::size_t i = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(method(cases[i]));
        i = i + 1 < cases.size() ? i + 1 : 0;
    }
    state.counters["max_error"] = errors.back();
    state.counters["median_error"] = errors[errors.size() / 2];
}

void add_rungs() {
    for (const NamedMethod<SlabMethod>& info : kSlabMethods) {
        for (const char set : {'A', 'B'}) {
            const auto method = [info](const Ray& r) {
                return slab_near(info.method, r.sigma_t, r.s, r.l, r.w_dot_n, r.wl_dot_n,
                                 r.w_dot_wl);
            };
            benchmark::RegisterBenchmark(
                ("slab/" + std::string(info.name) + "/" + set).c_str(),
                [set, method](benchmark::State& state) { run(state, set, method); });
        }
    }
}

template <class Function>
void add(const char* name, const Function& function) {
    benchmark::RegisterBenchmark(name, [function](benchmark::State& state) {
        const std::vector<Ray> cases = rays('A');
        std::size_t i = 0;
        for (auto _ : state) {
            benchmark::DoNotOptimize(function(cases[i]));
            i = i + 1 < cases.size() ? i + 1 : 0;
        }
    });
}

void add_others() {
    add("slab_distant",
        [](const Ray& r) { return slab_distant(r.sigma_t, r.s, r.w_dot_n, r.wl_dot_n); });
    add("slab_near_flat", [](const Ray& r) {
        return slab_near_flat(r.sigma_t, r.s, r.l, r.w_dot_n, r.wl_dot_n, r.w_dot_wl);
    });
    add("surface_crossing",
        [](const Ray& r) { return surface_crossing(r.w_dot_n, 1, 1.33).transmittance; });
    for (const SlabLightPath path : {SlabLightPath::straight, SlabLightPath::refracted}) {
        const bool straight = path == SlabLightPath::straight;
        add(straight ? "slab_radiance_of_point/straight" : "slab_radiance_of_point/refracted",
            [path](const Ray& r) {
                SlabMedium medium;
                medium.ior_inside = 1.33;
                SlabSegment segment;
                segment.to_viewer = {std::sqrt(1 - r.w_dot_n * r.w_dot_n), r.w_dot_n, 0};
                segment.length = r.s;
                const double across = std::sqrt(1 - r.wl_dot_n * r.wl_dot_n);
                return slab_radiance_of_point(medium, segment,
                                              r.l * glm::dvec3(0, r.wl_dot_n, across), 1, path);
            });
    }
    add("particle_near", [](const Ray& r) { return particle_near({r.s, r.l, 0.5}).weight; });
    add("particle_irradiance/exact",
        [](const Ray& r) { return particle_irradiance(0.03 * r.s, r.l); });
    const ParticleIrradianceTable table;
    add("particle_irradiance/table", [table](const Ray& r) { return table(0.03 * r.s, r.l); });
    for (const bool particles : {false, true}) {
        add(particles ? "shaft_radiance/64 steps" : "shaft_radiance/64 steps, no particles",
            [table, particles](const Ray& r) {
                ShaftOptions options;
                options.particles = particles;
                ShaftRay ray;
                ray.length = 10 * r.s;
                const auto lit = [](const glm::dvec3&) { return true; };
                return shaft_radiance({}, {{r.l, 0, 3}, 1}, ray, options, lit, table);
            });
    }
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    airlight::add_rungs();
    airlight::add_others();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
