// SPDX-License-Identifier: Apache-2.0
// Camera rays of the reference renderer: how many per CPU second, and at which error.
//
// One thread. A round runs every contender on the same rays; figures are medians of the rounds.
// `error` is the root mean square of the difference, over the brightest channel of all rays, from
// the same samples with line integrals to 1e-8.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/balls_on_floor.h"
#include "bench/rounds.h"
#include "core/threads.h"
#include "viewer/camera.h"
#include "viewer/path_tracer.h"
#include "viewer/reference.h"

namespace airlight {
namespace {

struct Contender {
    const char* name;
    ReferenceOptions options;
};

struct Rays {
    std::vector<glm::dvec3> directions;

    explicit Rays(const Camera& camera) {
        const glm::dmat3 axes = camera_axes(camera);
        constexpr int kWidth = 96, kHeight = 72;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                directions.push_back(
                    camera_direction(camera, axes, kWidth, kHeight, x + 0.5, y + 0.5));
            }
        }
    }
};

std::vector<glm::dvec3> trace(const World& world, const Rays& rays, const ReferenceOptions& options,
                              ReferenceCounts& counts) {
    const ReferenceRenderer renderer(world, options);
    std::vector<glm::dvec3> values;
    values.reserve(rays.directions.size());
    for (std::size_t i = 0; i < rays.directions.size(); ++i) {
        SampleStream stream(i, 0);
        values.push_back(
            renderer.radiance(world.scene().camera.position, rays.directions[i], stream, counts));
    }
    return values;
}

void compare(const std::string& title, const Scene& scene, int rounds) {
    const World world(scene);
    const Rays rays(scene.camera);
    std::vector<Contender> contenders;
    for (const double quadrature : {1e-3, 1e-5}) {
        for (const auto& [airlight, name] : kRayAirlights) {
            if (airlight == RayAirlight::points && quadrature < 1e-3) continue;
            ReferenceOptions options;
            options.quadrature = quadrature;
            options.airlight = airlight;
            contenders.push_back({name.data(), options});
        }
    }
    ReferenceOptions exact;
    exact.quadrature = 1e-8;
    ReferenceCounts counts;
    const std::vector<glm::dvec3> truth = trace(world, rays, exact, counts);
    double most = 0;
    for (const glm::dvec3& v : truth) most = std::max({most, v.x, v.y, v.z});
    std::vector<std::vector<double>> seconds(contenders.size());
    std::vector<double> errors(contenders.size()), points(contenders.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < contenders.size(); ++i) {
            std::vector<glm::dvec3> values;
            counts = {};
            seconds[i].push_back(
                measure([&] { values = trace(world, rays, contenders[i].options, counts); }).cpu);
            double squares = 0;
            for (std::size_t k = 0; k < values.size(); ++k) {
                const glm::dvec3 d = values[k] - truth[k];
                squares += std::pow(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}), 2);
            }
            const double all = static_cast<double>(values.size());
            errors[i] = std::sqrt(squares / all) / most;
            points[i] = static_cast<double>(counts.line_points) / all;
        }
    }
    const double slowest = median(seconds[1]);
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        const double time = median(seconds[i]);
        fmt::print("{:24} {:7} {:6.0e}  {:8.3f} Mrays/s  {:7.1f} x  {:6.1f} points  error {:.1e}\n",
                   title, contenders[i].name, contenders[i].options.quadrature,
                   1e-6 * double(rays.directions.size()) / time, slowest / time, points[i],
                   errors[i]);
    }
}

// Samples by paths, on the same rays.
void trace_paths(const std::string& title, const Scene& scene, int rounds) {
    const World world(scene);
    const Rays rays(scene.camera);
    const PathTracer tracer(world, {});
    std::vector<double> seconds;
    ReferenceCounts counts;
    for (int round = 0; round < rounds; ++round) {
        counts = {};
        glm::dvec3 sum(0);
        seconds.push_back(measure([&] {
                              for (std::size_t i = 0; i < rays.directions.size(); ++i) {
                                  SampleStream stream(i, 0);
                                  sum += tracer.radiance(scene.camera.position, rays.directions[i],
                                                         stream, counts);
                              }
                          }).cpu);
    }
    const auto paths = static_cast<double>(rays.directions.size());
    fmt::print("{:24} paths            {:8.3f} Mpaths/s  {:6.1f} points  {:6.1f} rays\n", title,
               1e-6 * paths / median(seconds), double(counts.line_points) / paths,
               double(counts.rays) / paths);
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    using namespace airlight;
    CLI::App program("Camera rays of the reference renderer");
    int rounds = 3;
    program.add_option("--rounds", rounds, "Rounds");
    CLI11_PARSE(program, argc, argv);
    const std::string directory =
        (std::filesystem::temp_directory_path() / "airlight_reference_bench").string();
    std::filesystem::create_directories(directory);
    const ThreadLimit limit(1);

    Scene scene;
    scene.lights = {{{1.5, 2.5, 0.5}, glm::dvec3(10)}};
    scene.camera.position = {0, 2, 8};
    scene.media = {fog(0.05)};
    compare("fog alone", scene, rounds);
    trace_paths("fog alone", scene, rounds);
    scene = balls_on_floor(directory, 8);
    compare("3 balls, no fog", scene, rounds);
    scene.media = {fog(0.05)};
    compare("fog, 3 balls of 224", scene, rounds);
    trace_paths("fog, 3 balls of 224", scene, rounds);
    scene.media[0].kind = SceneUniform{{0.05, 0.06, 0.08}, {0.01, 0, 0}};
    compare("coloured fog", scene, rounds);
    trace_paths("coloured fog", scene, rounds);
    scene.media[0] = fog(0.05);
    scene.media[0].phase.type = PhaseType::henyey_greenstein;
    scene.media[0].phase.g = 0.6;
    compare("fog, hg", scene, rounds);
    trace_paths("fog, hg", scene, rounds);
    scene.media = {fog(0.02)};
    SceneMedium steam;
    steam.kind = SceneGaussians{{{{0, 1, 0}, 1, 0.3}}, {}, glm::dvec3(1)};
    scene.media.push_back(steam);
    compare("fog and a Gaussian", scene, rounds);
    trace_paths("fog and a Gaussian", scene, rounds);
    scene = balls_on_floor(directory, 128);
    scene.media = {fog(0.05)};
    compare("fog, 3 balls of 65024", scene, rounds);
    std::filesystem::remove_all(directory);
}
