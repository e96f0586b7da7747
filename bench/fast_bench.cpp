// SPDX-License-Identifier: Apache-2.0
// The fast engine beside the reference, on scene files or, without any, on a lamp in grey fog over
// three balls on a floor: rays of view per CPU second of both and their ratio, with the methods
// that a plan for the scene's tolerance names and with the papers' (no shadows in the media), and
// the error of a pixel.
//
// One thread. A round runs all contenders on the same rays; figures are medians of the rounds.
// Errors are over the brightest pixel: root mean square with the noise of the reference's samples,
// which is shown, and of the mean of all pixels.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/balls_on_floor.h"
#include "bench/rounds.h"
#include "core/threads.h"
#include "viewer/fast_choice.h"
#include "viewer/fast_picture.h"
#include "viewer/reference_picture.h"
#include "viewer/scene_file.h"

namespace airlight {
namespace {

constexpr int kWidth = 64, kHeight = 36;

struct Contender {
    const char* name;
    FastMethods methods;
    std::vector<double> seconds;
    double build = 0;
    FastPicture picture;
};

void compare(const std::string& title, const Scene& scene, int rounds, int samples) {
    World world(scene);
    PlanOptions planning;
    planning.engine = Engine::fast;
    planning.width = kWidth;
    planning.height = kHeight;
    const Plan plan = make_plan(world, planning);
    planning.engine = Engine::reference;
    const Plan exact = make_plan(world, planning);
    world.set_media(plan.media);
    Contender contenders[2] = {{"planned", fast_methods(plan), {}, 0, {}},
                               {"papers", fast_methods(plan), {}, 0, {}}};
    contenders[1].methods.shafts = FastShafts::unshadowed;
    contenders[1].methods.gaussians = FastGaussians::fogshop;
    FastPictureOptions fast;
    fast.samples = 16;
    fast.width = kWidth;
    fast.height = kHeight;
    ReferencePictureOptions reference;
    reference.samples = samples;
    reference.width = kWidth;
    reference.height = kHeight;
    reference.reference.quadrature = exact.quadrature;
    std::vector<double> truth_seconds;
    ReferencePicture truth;
    for (int round = 0; round < rounds; ++round) {
        truth_seconds.push_back(
            measure([&] { truth = render_reference(world, exact, reference); }).cpu);
        for (Contender& each : contenders) {
            each.build = measure([&] { FastRenderer(world, plan, each.methods); }).cpu;
            each.seconds.push_back(
                measure([&] { each.picture = render_fast(world, plan, each.methods, fast); }).cpu -
                each.build);
        }
    }
    const double truth_time = median(truth_seconds) / double(truth.samples);
    double brightest = 0, sum = 0;
    for (const float value : truth.image.pixels) {
        brightest = std::max(brightest, double(value));
        sum += double(value);
    }
    for (const Contender& each : contenders) {
        const double time = median(each.seconds) / double(each.picture.samples);
        double squares = 0, difference = 0;
        for (std::size_t i = 0; i < truth.image.pixels.size(); ++i) {
            const double d = double(each.picture.image.pixels[i]) - double(truth.image.pixels[i]);
            squares += d * d;
            difference += d;
        }
        const double count = double(truth.image.pixels.size());
        fmt::print(
            "{:15} {:8} {:7.3f} Mrays/s  reference {:5.3f}  {:6.1f} x  built in {:.2f} s  rms "
            "{:.1e} (noise {:.0e})  mean {:+.1f} %  shafts {}\n",
            title, each.name, 1e-6 / time, 1e-6 / truth_time, truth_time / time, each.build,
            std::sqrt(squares / count) / brightest, truth.noise,
            sum > 0 ? 100 * difference / sum : 0,
            plan.runs(Effect::shafts) ? method_name(kFastShafts, each.methods.shafts) : "-");
    }
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    using namespace airlight;
    CLI::App program("The fast engine beside the reference");
    int rounds = 3, samples = 4;
    std::vector<std::string> scenes;
    program.add_option("--rounds", rounds, "Rounds");
    program.add_option("--samples", samples, "Samples of a pixel of the reference");
    program.add_option("scenes", scenes, "Scene files; none: a lamp in fog over three balls");
    CLI11_PARSE(program, argc, argv);
    const ThreadLimit limit(1);
    for (const std::string& path : scenes) {
        compare(std::filesystem::path(path).stem().string(), read_scene(path), rounds, samples);
    }
    if (!scenes.empty()) return 0;
    const std::filesystem::path directory =
        std::filesystem::temp_directory_path() / "airlight_fast_bench";
    std::filesystem::create_directories(directory);
    Scene scene = balls_on_floor(directory.string(), 8);
    scene.media = {fog(0.05)};
    compare("fog, 3 balls", scene, rounds, samples);
    std::filesystem::remove_all(directory);
}
