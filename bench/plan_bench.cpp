// SPDX-License-Identifier: Apache-2.0
// What plans save and whether they know what effects cost, on scene files.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <vector>

#include "bench/rounds.h"
#include "core/threads.h"
#include "viewer/camera.h"
#include "viewer/environment_sampler.h"
#include "viewer/fast_choice.h"
#include "viewer/fast_picture.h"
#include "viewer/plan.h"
#include "viewer/reference_picture.h"
#include "viewer/scene_file.h"

namespace airlight {
namespace {

constexpr int kWidth = 192, kHeight = 108, kSamples = 4;

// CPU seconds of a picture, its plan not counted.
double draw(const Scene& scene, const PlanOptions& planning, Plan* made = nullptr) {
    World world(scene);
    const Plan plan = make_plan(world, planning);
    world.set_media(plan.media);
    if (made) *made = plan;
    if (planning.engine == Engine::fast) {
        FastPictureOptions options;
        options.width = kWidth;
        options.height = kHeight;
        options.samples = kSamples;
        return measure([&] { render_fast(world, plan, fast_methods(plan), options); }).cpu;
    }
    ReferencePictureOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.samples = kSamples;
    options.reference.quadrature = plan.quadrature;
    return measure([&] { render_reference(world, plan, options); }).cpu;
}

void compare_with_everything(const std::vector<std::string>& files, Engine engine, int rounds) {
    std::vector<double> ratios;
    for (const std::string& file : files) {
        const Scene scene = read_scene(file);
        PlanOptions planned, everything;
        planned.engine = everything.engine = engine;
        everything.all = true;
        std::vector<double> of_scene;
        double seconds = 0;
        for (int round = 0; round < rounds; ++round) {
            seconds = draw(scene, planned);
            of_scene.push_back(draw(scene, everything) / seconds);
        }
        ratios.push_back(median(of_scene));
        fmt::print("{:40} {:10} {:8.1f} ms, everything on {:6.2f} times as long\n", file,
                   method_name(kEngines, engine), 1e3 * seconds, ratios.back());
    }
    fmt::print("{:40} {:10} median {:.2f}\n", "", method_name(kEngines, engine), median(ratios));
}

// What each effect takes, as the difference it makes to leave it out, beside the plan's word.
void compare_shares(const std::vector<std::string>& files, int rounds) {
    for (const std::string& file : files) {
        const Scene scene = read_scene(file);
        Plan plan;
        std::vector<double> whole;
        for (int round = 0; round < rounds; ++round) whole.push_back(draw(scene, {}, &plan));
        const double expected = plan.cost();
        const double rays = double(kWidth) * kHeight * kSamples;
        fmt::print("{}: {:.2f} us a ray, expected {:.2f}\n", file, 1e6 * median(whole) / rays,
                   1e-3 * expected);
        for (const auto& [effect, name] : kEffects) {
            if (!plan.runs(effect) || effect == Effect::slab) continue;
            PlanOptions without;
            without.only.remove(effect);
            std::vector<double> rest;
            Plan less;
            for (int round = 0; round < rounds; ++round) {
                rest.push_back(draw(scene, without, &less));
            }
            fmt::print("    {:22} {:5.1f} %, expected {:5.1f} %\n", name,
                       100 * (1 - median(rest) / median(whole)),
                       100 * (1 - less.cost() / expected));
        }
    }
}

// A renderer that knows nothing of plans and media: rays, the map, materials, a picture and its
// noise.
double plain_loop(const World& world) {
    const Camera& camera = world.scene().camera;
    const glm::dmat3 axes = camera_axes(camera);
    const EnvironmentSampler& sampler = *world.sampler();
    constexpr double kFar = std::numeric_limits<double>::infinity();
    glm::dvec3 all(0);
    Image image(kWidth, kHeight, 3);
    double noise = 0;
    for (int i = 0; i < kWidth * kHeight; ++i) {
        glm::dvec3 sum(0), squares(0);
        for (int k = 0; k < kSamples; ++k) {
            glm::dvec3 pixel(0);
            SampleStream stream(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(k));
            const double x = i % kWidth + stream.next(), y = i / kWidth + stream.next();
            const glm::dvec3 direction = camera_direction(camera, axes, kWidth, kHeight, x, y);
            const auto hit = world.trace(camera.position, direction, kFar);
            const auto keep = [&] {
                sum += pixel;
                squares += pixel * pixel;
            };
            if (!hit) {
                pixel = world.environment(direction);
                keep();
                continue;
            }
            const glm::dvec3 from = world.lifted(*hit);
            const SurfaceMaterial& material = world.material(hit->object);
            const double u = stream.next(), v = stream.next();
            const EnvironmentSample light = sampler.sample(u, v);
            const LobeSample lobe = sample_lobe(material, hit->normal, -direction, stream);
            const auto add = [&](const EnvironmentSample& sky, double pdf) {
                const glm::dvec3 f = reflect(material, hit->normal, -direction, sky.direction);
                if (!(largest(f) > 0) || !(glm::dot(sky.direction, hit->face) > 0)) return;
                if (!world.trace(from, sky.direction, kFar)) pixel += f * sky.radiance / pdf;
            };
            if (light.pdf > 0) {
                add(light,
                    light.pdf + lobe_pdf(material, hit->normal, -direction, light.direction));
            }
            if (lobe.pdf > 0) {
                const EnvironmentSample sky = sampler.at(lobe.direction);
                add(sky, lobe.pdf + sky.pdf);
            }
            keep();
        }
        const glm::dvec3 mean = sum / double(kSamples);
        for (int c = 0; c < 3; ++c) {
            image.pixels[static_cast<std::size_t>(3 * i + c)] = static_cast<float>(mean[c]);
        }
        noise += largest(squares / double(kSamples) - mean * mean);
        all += sum;
    }
    return noise >= 0 ? largest(all) / (kWidth * kHeight * kSamples) : double(image.pixels[0]);
}

void compare_with_plain_loop(const std::string& file, int rounds) {
    const World world(read_scene(file));
    std::vector<double> ratios;
    double mean = 0, planned_mean = 0;
    for (int round = 0; round < rounds; ++round) {
        const double plain = measure([&] { mean = plain_loop(world); }).cpu;
        const double planned = measure([&] {
                                   const Plan plan = make_plan(world);
                                   ReferencePictureOptions options;
                                   options.width = kWidth;
                                   options.height = kHeight;
                                   options.samples = kSamples;
                                   const Image image = render_reference(world, plan, options).image;
                                   glm::dvec3 sum(0);
                                   for (std::size_t i = 0; i < image.pixels.size(); ++i) {
                                       sum[static_cast<int>(i % 3)] += double(image.pixels[i]);
                                   }
                                   planned_mean = largest(sum) / (kWidth * kHeight);
                               }).cpu;
        ratios.push_back(planned / plain);
    }
    fmt::print("{}: planned {:.3f} times the plain loop, means {:.5g} and {:.5g}\n", file,
               median(ratios), planned_mean, mean);
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    using namespace airlight;
    CLI::App program("Plans and what they save");
    std::vector<std::string> files;
    int rounds = 3;
    bool shares = false, plain = false;
    std::string engine = "reference";
    program.add_option("scenes", files, "Scene files")->required();
    program.add_option("--rounds", rounds, "Rounds");
    program.add_option("--engine", engine, "reference or fast");
    program.add_flag("--shares", shares, "Each effect's part of the time beside the plan's word");
    program.add_flag("--plain", plain, "Beside a loop without plan, for scenes with a map alone");
    CLI11_PARSE(program, argc, argv);
    const ThreadLimit limit(1);
    if (plain) {
        for (const std::string& file : files) compare_with_plain_loop(file, rounds);
    } else if (shares) {
        compare_shares(files, rounds);
    } else {
        compare_with_everything(files, *method_from_name(kEngines, engine), rounds);
    }
    return 0;
}
