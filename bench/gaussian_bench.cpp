// SPDX-License-Identifier: Apache-2.0
// Gaussian media: accuracy against time of the line integral, the mean depth and the airlight, and
// the cost of finding the blobs that matter.
//
// Counters. line: absolute error in units of c sqrt(pi) / a on 4096 segments near and beside a
// blob. mean_depth: absolute error on u in [0, 10). airlight: relative error, median, 90th
// percentile and largest, on 200 scenes of medium/gaussian_airlight_sets.h; its time is per ray,
// the evaluator built before. tree: nodes and blobs looked at and blobs kept per ray, at a
// tolerance of .01.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "medium/average_depth.h"
#include "medium/gaussian_airlight_sets.h"
#include "medium/gaussian_line_method.h"
#include "medium/gaussian_tree.h"

namespace airlight {
namespace {

class Uniform {
  public:
    double operator()(double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53;
    }

  private:
    std::mt19937_64 bits_{1};
};

struct Line {
    double a, c, rho, m, dist;
};

std::vector<Line> lines() {
    Uniform uniform;
    std::vector<Line> all(4096);
    for (Line& line : all) {
        line = {uniform(.5, 2), uniform(.1, 3), uniform(0, 3), uniform(-4, 8), uniform(0, 6)};
    }
    return all;
}

template <class Real>
void add_line(const std::string& name, GaussianLineMethod method) {
    benchmark::RegisterBenchmark(name.c_str(), [method](benchmark::State& state) {
        const std::vector<Line> all = lines();
        double largest = 0;
        for (const Line& line : all) {
            const Real a = Real(line.a), c = Real(line.c), rho = Real(line.rho), m = Real(line.m),
                       dist = Real(line.dist);
            const double exact =
                gaussian_line(double{a}, double{c}, double{rho}, double{m}, double{dist});
            const double error =
                std::abs(double{gaussian_line(method, a, c, rho, m, dist)} - exact);
            largest = std::max(largest, error * a / c / 1.7724538509055160);
        }
        std::size_t i = 0;
        for (auto _ : state) {
            const Line& l = all[i];
            benchmark::DoNotOptimize(
                gaussian_line(method, Real(l.a), Real(l.c), Real(l.rho), Real(l.m), Real(l.dist)));
            i = (i + 1) % all.size();
        }
        state.counters["error"] = largest;
    });
}

void add_line_inverse() {
    benchmark::RegisterBenchmark("line_inverse", [](benchmark::State& state) {
        std::vector<Line> all = lines();
        for (Line& l : all) l.dist = gaussian_line(l.a, l.c, l.rho, l.m, l.dist);
        std::size_t i = 0;
        for (auto _ : state) {
            const Line& l = all[i];
            benchmark::DoNotOptimize(gaussian_line_inverse(l.a, l.c, l.rho, l.m, l.dist));
            i = (i + 1) % all.size();
        }
    });
}

template <class Function>
void add_mean_depth(const std::string& name, const Function& function) {
    benchmark::RegisterBenchmark(name.c_str(), [function](benchmark::State& state) {
        double largest = 0;
        for (int i = 0; i < 10000; ++i) {
            const double u = 1e-3 * i;
            largest = std::max(largest, std::abs(function(u) - mean_gaussian_depth(u)));
        }
        double u = 0;
        for (auto _ : state) {
            benchmark::DoNotOptimize(function(u));
            u = u < 10 ? u + 0.01 : 0;
        }
        state.counters["error"] = largest;
    });
}

void add_airlight(GaussianAirlightMethod method, const std::string& set, int blobs) {
    const std::string name = "airlight/" +
                             std::string(method_name(kGaussianAirlightMethods, method)) + "/" +
                             set + std::to_string(blobs);
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        const std::vector<GaussianScene> scenes = gaussian_scenes(set, blobs, 200);
        const ErrorQuantiles errors = gaussian_scene_errors(
            scenes, [&](const auto& scene) { return gaussian_scene_airlight(method, scene); });
        std::vector<GaussianAirlightEvaluator> evaluators;
        for (const GaussianScene& scene : scenes) {
            evaluators.emplace_back(method, scene.medium, scene.ray.viewer, scene.ray.light);
        }
        std::size_t i = 0;
        for (auto _ : state) {
            benchmark::DoNotOptimize(evaluators[i](scenes[i].ray.direction, scenes[i].ray.dist));
            i = (i + 1) % scenes.size();
        }
        state.counters["median"] = errors.median;
        state.counters["p90"] = errors.p90;
        state.counters["max"] = errors.max;
    });
}

// Blobs in a cube of edge 10, in size like their mean distance.
std::vector<GaussianBlob> cloud(int count) {
    Uniform uniform;
    std::vector<GaussianBlob> blobs(static_cast<std::size_t>(count));
    for (GaussianBlob& blob : blobs) {
        blob.center.x = uniform(-5, 5);
        blob.center.y = uniform(-5, 5);
        blob.center.z = uniform(-5, 5);
        blob.scale = uniform(.1, .3) * std::cbrt(count);
        blob.amplitude = uniform(.01, 1);
    }
    return blobs;
}

void add_tree(int count) {
    const std::string size = std::to_string(count);
    benchmark::RegisterBenchmark(("tree/optical_depth/" + size).c_str(), [count](benchmark::State&
                                                                                     state) {
        const GaussianTree tree(cloud(count));
        Uniform uniform;
        GaussianTreeVisits sum;
        for (auto _ : state) {
            GaussianTreeVisits one;
            const glm::dvec3 origin(uniform(-5, 5), uniform(-5, 5), -9);
            benchmark::DoNotOptimize(tree.optical_depth(origin, {0, 0, 1}, HUGE_VAL, 1e-2, &one));
            sum.nodes += one.nodes;
            sum.blobs += one.blobs;
            sum.taken += one.taken;
        }
        const auto mean = [](std::size_t number) {
            return benchmark::Counter(static_cast<double>(number),
                                      benchmark::Counter::kAvgIterations);
        };
        state.counters["nodes"] = mean(sum.nodes);
        state.counters["blobs"] = mean(sum.blobs);
        state.counters["taken"] = mean(sum.taken);
    });
    benchmark::RegisterBenchmark(("tree/build/" + size).c_str(), [count](benchmark::State& state) {
        const std::vector<GaussianBlob> blobs = cloud(count);
        for (auto _ : state) benchmark::DoNotOptimize(GaussianTree(blobs).node_count());
    });
}

void add_all() {
    for (const NamedMethod<GaussianLineMethod>& info : kGaussianLineMethods) {
        add_line<double>("line/" + std::string(info.name), info.method);
        add_line<float>("line/" + std::string(info.name) + "-float", info.method);
    }
    add_line_inverse();
    add_mean_depth("mean_depth/exact", [](double u) { return mean_gaussian_depth(u); });
    add_mean_depth("mean_depth/table64", MeanDepthTable(64));
    add_mean_depth("mean_depth/table256", MeanDepthTable(256));
    for (const NamedMethod<GaussianAirlightMethod>& info : kGaussianAirlightMethods) {
        for (const char* set : {"thin", "medium", "dense"}) {
            for (const int blobs : {1, 2, 5}) add_airlight(info.method, set, blobs);
        }
    }
    for (const int count : {1000, 10000, 100000}) add_tree(count);
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    airlight::add_all();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
