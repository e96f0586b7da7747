// SPDX-License-Identifier: Apache-2.0
// Ladders of the projection of maps and of the bands of point spread functions.
#include <fmt/format.h>

#include <glm/mat3x3.hpp>
#include <memory>

#include "cli/ladder_draws.h"
#include "cli/ladder_map.h"
#include "cli/ladder_sh.h"
#include "sh/basis.h"
#include "sh/basis_batch.h"
#include "sh/index.h"
#include "sh/npsf.h"
#include "sh/project.h"
#include "sh/psf_bands.h"
#include "sh/rotation.h"
#include "sh/transform.h"

namespace airlight {
namespace {

constexpr int kRows = 256, kColumns = 512, kChannels = 3, kLargestOrder = 12;

// From the components of the map frame, world (Z, X, Y), to those of the world.
ShRotation to_world(int order) {
    return ShRotation(order, glm::dmat3(0, 0, 1, 1, 0, 0, 0, 1, 0));
}

/// A map and its coefficients to kLargestOrder.
struct Projected {
    std::vector<float> map;
    std::vector<double> exact;
};

// The sky of the ladder of fog, constant within its pixels.
const Projected& sky_map() {
    static const Projected kSky = [] {
        Projected sky;
        sky.map = sun_and_sky(kColumns, kRows).pixels;
        const std::vector<double> wide(sky.map.begin(), sky.map.end());
        sky.exact = project_latlong(wide.data(), kRows, kColumns, kChannels, kLargestOrder);
        return sky;
    }();
    return kSky;
}

// A function of 100 bands, sampled at the centres of pixels: noise whose norm is 1 in every band.
const Projected& smooth_map() {
    static const Projected kSmooth = [] {
        constexpr int kBands = 100;
        constexpr std::size_t kSize = sh_count(kBands), kKept = sh_count(kLargestOrder);
        auto noise = random_numbers<double>(kChannels * kSize, 31);
        for (std::size_t i = 0; i < noise.size(); ++i) {
            noise[i] /= std::sqrt(2 * sh_degree(i % kSize).l + 1.0);
        }
        std::vector<double> values(static_cast<std::size_t>(kRows) * kColumns * kChannels);
        SphericalTransform(kRows, kColumns, kBands - 1)
            .synthesize(noise.data(), kChannels, values.data());
        Projected smooth;
        smooth.map.assign(values.begin(), values.end());
        for (std::size_t c = 0; c < kChannels; ++c) {
            const auto begin = noise.begin() + static_cast<std::ptrdiff_t>(c * kSize);
            smooth.exact.insert(smooth.exact.end(), begin,
                                begin + static_cast<std::ptrdiff_t>(kKept));
        }
        to_world(kLargestOrder).rotate(kChannels, smooth.exact.data(), smooth.exact.data());
        return smooth;
    }();
    return kSmooth;
}

using Projection = std::vector<double> (*)(const float* map, int order);

std::vector<double> by_pixel_means(const float* map, int order) {
    return project_latlong(map, kRows, kColumns, kChannels, order);
}

std::vector<double> by_centre_samples(const float* map, int order) {
    return project_latlong(map, kRows, kColumns, kChannels, order, MapRule::centre_samples);
}

std::vector<double> by_transform(const float* map, int order) {
    std::vector<float> coefficients(kChannels * sh_count(order));
    SphericalTransform(kRows, kColumns, order - 1).analyze(map, kChannels, coefficients.data());
    std::vector<double> out(coefficients.begin(), coefficients.end());
    to_world(order).rotate(kChannels, out.data(), out.data());
    return out;
}

double pixel_solid_angle(int row) {
    return 2 * kPi / kColumns * 2 * std::sin(kPi * (row + 0.5) / kRows) * std::sin(kPi / 2 / kRows);
}

std::vector<double> by_pixels(const float* map, int order) {
    const std::size_t size = sh_count(order);
    std::vector<double> out(kChannels * size), basis(size);
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            const auto [x, y, z] = pixel_direction(row, column, kColumns, kRows);
            evaluate_basis(order, x, y, z, basis.data());
            for (std::size_t c = 0; c < kChannels; ++c) {
                const double weighted = pixel_solid_angle(row) * static_cast<double>(*map++);
                for (std::size_t k = 0; k < size; ++k) out[c * size + k] += weighted * basis[k];
            }
        }
    }
    return out;
}

std::vector<double> by_batches(const float* map, int order) {
    std::vector<double> out(kChannels * sh_count(order));
    std::vector<float> cosine, sine, x(kColumns), y(kColumns), z(kColumns);
    for (int column = 0; column < kColumns; ++column) {
        const double phi = 2 * kPi * (0.5 - (column + 0.5) / kColumns);
        cosine.push_back(static_cast<float>(std::cos(phi)));
        sine.push_back(static_cast<float>(std::sin(phi)));
    }
    std::vector<float> values(static_cast<std::size_t>(kChannels) * kColumns);
    for (int row = 0; row < kRows; ++row) {
        const double theta = kPi * (row + 0.5) / kRows;
        const auto radius = static_cast<float>(std::sin(theta));
        const auto weight = static_cast<float>(pixel_solid_angle(row));
        for (std::size_t i = 0; i < kColumns; ++i) {
            x[i] = radius * sine[i];
            y[i] = static_cast<float>(std::cos(theta));
            z[i] = radius * cosine[i];
            for (std::size_t c = 0; c < kChannels; ++c) values[c * kColumns + i] = weight * *map++;
        }
        project_basis_batch(order, kColumns, x.data(), y.data(), z.data(), kChannels, values.data(),
                            out.data());
    }
    return out;
}

RungResult measure_projection(Projection project, const Projected& (*projected)(), int order) {
    const Projected& truth = projected();
    const std::size_t size = sh_count(order), kept = sh_count(kLargestOrder);
    std::vector<double> exact, out = project(truth.map.data(), order);
    for (std::size_t c = 0; c < kChannels; ++c) {
        for (std::size_t k = 0; k < size; ++k) exact.push_back(truth.exact[c * kept + k]);
    }
    const LadderErrors errors = vector_errors(exact, out, size);
    const double nanoseconds =
        nanoseconds_each(kRows * kColumns, [&] { out = project(truth.map.data(), order); });
    return {nanoseconds, errors.largest(), errors.rms()};
}

struct ProjectionMethod {
    const char* name;
    const char* label;
    const char* colour;
    Projection project;
};

const ProjectionMethod kProjections[] = {
    {"pixel-means", "pixel means", kPlotColours[0], by_pixel_means},
    {"centre-samples", "centre samples", kPlotColours[2], by_centre_samples},
    {"transform", "transform", kPlotColours[3], by_transform},
    {"batches", "batches", kPlotColours[5], by_batches},
    {"pixels", "pixel by pixel", kPlotColours[1], by_pixels}};

RungFigure projection_figure(const std::string& file, const std::string& set,
                             const std::string& subtitle, const Projected& (*projected)()) {
    RungFigure figure;
    figure.file = file;
    figure.title = "Projection of maps";
    figure.subtitle = subtitle;
    for (std::size_t i = 0; i < std::size(kProjections); ++i) {
        const ProjectionMethod& method = kProjections[i];
        figure.series.push_back({method.label, method.colour, true, {}});
        // On such a map it computes what the others are measured against.
        const bool exact = projected == sky_map && method.project == by_pixel_means;
        for (const int order : {3, 6, kLargestOrder}) {
            LadderRung rung;
            rung.method = method.name;
            rung.set = set + " " + order_name(order);
            rung.label = std::to_string(order);
            rung.series = i;
            rung.measure = [=, project = method.project] {
                return measure_projection(project, projected, order);
            };
            if (exact) rung.bound = 5e-14;
            figure.rungs.push_back(std::move(rung));
        }
    }
    return figure;
}

/// Eigenvalues of many thicknesses, which take some time to make.
struct ExactBands {
    int order;
    std::vector<double> thicknesses;
    std::vector<std::vector<double>> exact;

    void fill() {
        constexpr int kThicknesses = 300;
        for (int i = 0; exact.size() < kThicknesses; ++i) {
            thicknesses.push_back(20 * std::pow((i + 0.37) / kThicknesses, 4));
            exact.push_back(psf_eigenvalues_scaled(thicknesses.back(), order));
        }
    }
};

RungResult measure_bands(PsfBandsMethod method, ExactBands& truth) {
    truth.fill();
    const PsfBands bands(truth.order, method);
    std::vector<float> out(static_cast<std::size_t>(truth.order));
    LadderErrors errors;
    for (std::size_t i = 0; i < truth.exact.size(); ++i) {
        bands.eigenvalues_scaled(truth.thicknesses[i], out.data());
        for (std::size_t l = 0; l < out.size(); ++l) {
            errors.add(std::abs(static_cast<double>(out[l]) / truth.exact[i][l] - 1));
        }
    }
    // A call of `exact` takes a millisecond.
    const std::size_t step = method == PsfBandsMethod::exact ? 30 : 1;
    const double calls =
        std::ceil(static_cast<double>(truth.exact.size()) / static_cast<double>(step));
    const double nanoseconds = nanoseconds_each(calls, [&] {
        for (std::size_t i = 0; i < truth.thicknesses.size(); i += step) {
            bands.eigenvalues_scaled(truth.thicknesses[i], out.data());
        }
    });
    return {nanoseconds, errors.largest(), errors.rms()};
}

}  // namespace

RungLadder sh_projection_ladder() {
    RungLadder ladder;
    ladder.effect = "sh-projection";
    ladder.title = "Projection of maps";
    ladder.text = fmt::format(
        "<p>{0} × {1} RGB float maps to the order that labels the dot, planning included. First "
        "the sky with a one-pixel sun that the ladder of fog has, which is constant within its "
        "pixels: exact are the integrals over them, which <code>pixel-means</code> computes; the "
        "bound that tests hold it to is drawn. Then a function of 100 bands, sampled at "
        "the centres of the pixels: exact are its coefficients. What is exact for one is not for "
        "the other. The error of a coefficient is divided by the largest one of its channel; times "
        "are per pixel of three channels. Pixels and batches sum over the centres of pixels times "
        "their solid angles.</p>",
        kColumns, kRows);
    ladder.result = "pixel";
    ladder.error = "error over the largest coefficient";
    ladder.figures = {
        projection_figure("sh-projection", "pixels",
                          "512 × 256 RGB constant within pixels; labels are orders", sky_map),
        projection_figure("sh-projection-samples", "samples",
                          "512 × 256 RGB samples of 100 bands; labels are orders", smooth_map)};
    return ladder;
}

RungLadder sh_psf_ladder() {
    RungLadder ladder;
    ladder.effect = "sh-psf";
    ladder.title = "Bands of the point spread function";
    ladder.text =
        "<p>The eigenvalues of PSF<sub>T</sub> in float at 300 optical thicknesses T in 0 … 20, "
        "even in T<sup>1/4</sup>. Errors are relative, over all T and bands, against the "
        "transform in double, which <code>exact</code> rounds to float. Tables are built before "
        "the clock starts.</p>";
    ladder.error = "relative error";
    ladder.error_key = "relative_error";
    RungFigure figure;
    figure.file = "sh-psf";
    figure.title = ladder.title;
    figure.subtitle = "all bands of an order at one T in 0 … 20";
    for (const int order : {6, 64}) {
        figure.series.push_back({order_name(order), kPlotColours[figure.series.size()], false, {}});
        const auto truth = std::make_shared<ExactBands>();
        truth->order = order;
        for (const auto& info : kPsfBandsMethods) {
            figure.rungs.push_back(
                {std::string(info.name), order_name(order), std::string(info.name),
                 figure.series.size() - 1,
                 [=, method = info.method] { return measure_bands(method, *truth); }, 0, 150});
        }
    }
    ladder.figures = {std::move(figure)};
    return ladder;
}

}  // namespace airlight
