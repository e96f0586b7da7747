// SPDX-License-Identifier: Apache-2.0
// What single scattering leaves out of glows: figure 7 of [Sun05].
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "cli/ladder_effects.h"
#include "core/constants.h"
#include "core/parallel.h"
#include "medium/phase_airlight.h"
#include "medium/point_glow.h"
#include "viewer/path_tracer.h"

namespace airlight {
namespace {

constexpr std::size_t kAngles = 22;
constexpr double kStep = 2 * kPi / 180;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kQuickSamples = 250, kFullSamples = 20000;
constexpr int kBounces = 4096;

using Profile = std::array<double, kAngles>;

/// A medium, and how the light that it scatters any number of times is found.
struct Fog {
    const char* label;  ///< in the legend; empty for none
    double albedo, g;
    bool by_paths;
    const char* colour;
    std::vector<double> thicknesses;
};

const Fog kFogs[] = {
    {"albedo 1", 1, 0, false, kPlotColours[0], {0.25, 0.5, 1, 2, 4, 8, 15, 25}},
    {"albedo 0.9", 0.9, 0, false, kPlotColours[2], {0.25, 0.5, 1, 2, 4, 8, 15, 25}},
    {"albedo 0.5", 0.5, 0, false, kPlotColours[3], {0.25, 0.5, 1, 2, 4, 8, 15, 25}},
    {"", 1, 0, true, kPlotColours[0], {0.25, 0.5, 1, 2}},
    {"", 0.9, 0, true, kPlotColours[2], {0.25, 0.5, 1, 2, 4}},
    {"albedo 1, g = 0.85", 1, 0.85, true, kPlotColours[1], {0.25, 0.5, 1, 2, 4}},
};

struct GlowError {
    std::size_t fog = 0;
    double thickness = 0;
    int samples = 0;  ///< paths of each ray; 0: exact
    double error = 0, error_scaled = 0, scale = 0, noise = 0;
};

double angle_of(std::size_t i) {
    return kStep * static_cast<double>(i + 1);
}

/// Radiance of each ray, and the variance of that.
struct Glow {
    Profile radiance{}, variance{};
};

Glow glow_by_paths(const Fog& fog, double thickness, int samples) {
    Scene scene;
    SceneMedium medium;
    medium.kind = SceneUniform{glm::dvec3(fog.albedo), glm::dvec3(1 - fog.albedo)};
    if (fog.g != 0) medium.phase = {PhaseType::henyey_greenstein, fog.g, {}};
    scene.media = {medium};
    scene.lights = {{glm::dvec3(0), glm::dvec3(1)}};
    const World world(scene);
    PathTracerOptions options;
    options.max_bounces = kBounces;
    const PathTracer tracer(world, options);
    Glow glow;
    parallel_blocks(kAngles, 1, [&](std::size_t i, std::size_t) {
        const double gamma = angle_of(i);
        const glm::dvec3 direction(std::sin(gamma), 0, -std::cos(gamma));
        ReferenceCounts counts;
        double mean = 0, squares = 0;
        for (int k = 0; k < samples; ++k) {
            SampleStream stream(i, static_cast<std::uint64_t>(k));
            const double sample = tracer.radiance({0, 0, thickness}, direction, stream, counts).x;
            const double before = sample - mean;
            mean += before / (k + 1);
            squares += before * (sample - mean);
        }
        glow.radiance[i] = mean;
        glow.variance[i] = squares / (double(samples) * (samples - 1));
    });
    return glow;
}

Glow exact_glow(const Fog& fog, double thickness) {
    const PointGlow exact(fog.albedo);
    Glow glow;
    parallel_blocks(kAngles, 1, [&](std::size_t i, std::size_t) {
        glow.radiance[i] = exact.radiance(angle_of(i), thickness, kInfinite);
    });
    return glow;
}

void measure(GlowError& error) {
    const Fog& fog = kFogs[error.fog];
    const Glow all = fog.by_paths ? glow_by_paths(fog, error.thickness, error.samples)
                                  : exact_glow(fog, error.thickness);
    const PhaseFunction phase = PhaseFunction::henyey_greenstein(fog.g);
    double aa = 0, ab = 0, bb = 0, noise = 0;
    Profile once{};
    for (std::size_t i = 0; i < kAngles; ++i) {
        once[i] = fog.albedo * airlight(angle_of(i), error.thickness, kInfinite, phase);
        aa += once[i] * once[i];
        ab += once[i] * all.radiance[i];
        bb += all.radiance[i] * all.radiance[i];
        noise += all.variance[i];
    }
    error.scale = ab / aa;
    double plain = 0, scaled = 0;
    for (std::size_t i = 0; i < kAngles; ++i) {
        plain += std::pow(once[i] - all.radiance[i], 2);
        scaled += std::pow(error.scale * once[i] - all.radiance[i], 2);
    }
    // Noise adds its variance to the squares.
    error.error = std::sqrt(std::max(0.0, plain - noise) / bb);
    error.error_scaled = std::sqrt(std::max(0.0, scaled - noise) / bb);
    error.noise = std::sqrt(noise / bb);
}

Plot make_plot(const std::vector<GlowError>& errors, bool scaled) {
    Plot plot;
    plot.title = scaled ? "Glows by single scattering, scaled to fit, against all scattering"
                        : "Glows by single scattering against all scattering";
    plot.subtitle =
        "a point light in endless fog, rays at 2 to 44 degrees from it; hollow: by paths";
    plot.x.label = "optical thickness from the viewer to the light";
    plot.y.label = "relative RMS error";
    for (std::size_t f = 0; f < std::size(kFogs); ++f) {
        const Fog& fog = kFogs[f];
        PlotSeries series = {fog.label, fog.colour, !fog.by_paths || fog.g != 0, {}};
        for (const GlowError& error : errors) {
            if (error.fog != f) continue;
            series.points.push_back(
                {error.thickness, scaled ? error.error_scaled : error.error, {}, fog.by_paths});
        }
        plot.series.push_back(std::move(series));
    }
    plot.series.push_back(
        {"printed in 2005: below", kPlotColours[5], true, {{0.25, 0.04}, {2, 0.04}}});
    return plot;
}

LadderEffect make_effect(const std::vector<GlowError>& errors, int samples) {
    LadderEffect effect;
    effect.name = "multiple";
    effect.title = "What single scattering leaves out of glows";
    Table table;
    table.columns = {{"albedo", "albedo"},
                     {"g", "g of Henyey and Greenstein"},
                     {"optical_thickness", "optical thickness to the light"},
                     {"paths_per_ray", "paths per ray (none: exact)"},
                     {"rms_relative_error", "relative RMS error"},
                     {"rms_relative_error_scaled", "the same after the best scale"},
                     {"scale", "best scale"},
                     {"noise", "noise of the truth"}};
    for (const GlowError& e : errors) {
        const Fog& fog = kFogs[e.fog];
        TableCell paths, noise;
        if (fog.by_paths) {
            paths = std::int64_t(e.samples);
            noise = e.noise;
        }
        table.rows.push_back(
            {fog.albedo, fog.g, e.thickness, paths, e.error, e.error_scaled, e.scale, noise});
    }
    for (const bool scaled : {false, true}) {
        LadderFigure figure;
        figure.name = scaled ? "multiple-shape" : "multiple";
        figure.plot = make_plot(errors, scaled);
        effect.figures.push_back(std::move(figure));
    }
    effect.figures[0].table = std::move(table);
    effect.figures[0].text = fmt::format(
        "<p>The figure 7 of Sun et al. (2005) again: the radiance of {} rays at 2 to 44 degrees "
        "from a point light in endless uniform fog, by single scattering and with all "
        "scattering; root of the summed squares of the differences over that of the radiance. "
        "Lines with filled points are exact, by the theory of transport, of fog that scatters "
        "evenly into all directions; hollow points are the path tracer of <code>airlight render "
        "--scattering multiple</code>, {} paths per ray of {} points at most, their noise, given "
        "in the table, taken off. The other plot scales each glow by single scattering so that "
        "it fits best, as a viewer's exposure would.</p>",
        kAngles, samples, kBounces);
    return effect;
}

}  // namespace

LadderWork plan_multiple_ladder(const LadderOptions& options) {
    const int samples = options.full ? kFullSamples : kQuickSamples;
    const auto errors = std::make_shared<std::vector<GlowError>>();
    for (std::size_t f = 0; f < std::size(kFogs); ++f) {
        for (const double thickness : kFogs[f].thicknesses) {
            errors->push_back({f, thickness, kFogs[f].by_paths ? samples : 0});
        }
    }
    LadderWork work;
    work.files = {"multiple.csv", "multiple.svg", "multiple-shape.svg"};
    for (std::size_t i = 0; i < errors->size(); ++i) {
        const int paths = (*errors)[i].samples;
        work.steps.push_back(
            {static_cast<std::uint64_t>(60 + paths / 3), [errors, i] { measure((*errors)[i]); }});
    }
    work.finish = [errors, samples] { return make_effect(*errors, samples); };
    return work;
}

}  // namespace airlight
