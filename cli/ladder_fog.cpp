// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>

#include "cli/ladder_effects.h"
#include "cli/ladder_map.h"
#include "core/threads.h"
#include "envmap/fog.h"

namespace airlight {
namespace {

constexpr double kTolerances[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5};
constexpr int kOrders[] = {3, 6, 16, 64};
constexpr double kDegrees = 57.29577951308232;

enum class Kind { sh, factored, split, rings };

struct Rung {
    Kind kind;
    std::string name;
    std::string label;  ///< in the plot, whose legend says the kind
    FogOptions options;
    FogPlan plan;
    double seconds = 0;
    /// Relative errors of all values, against the rings.
    double max_error = 0, median_error = 0, rms_error = 0;
    std::int64_t negative_pixels = 0;
};

struct Cost {
    int width = 0, height = 0;
    double tolerance = 0;
    double seconds = 0;
    FogPlan plan;
};

struct FogMeasurements {
    LadderOptions options;
    Image map;
    Image exact;
    std::vector<Rung> rungs;
    std::vector<Cost> costs;
};

TimeKind time_kind() {
    return thread_count() == 1 ? TimeKind::cpu : TimeKind::wall;
}

std::string time_name() {
    const int threads = thread_count();
    return threads == 1 ? "CPU time" : fmt::format("wall time, {} threads", threads);
}

std::string tolerance_name(double tolerance) {
    return fmt::format("1e{}", std::lround(std::log10(tolerance)));
}

std::vector<Rung> make_rungs(const LadderOptions& ladder) {
    std::vector<Rung> rungs;
    const auto add = [&](Kind kind, const std::string& name, const std::string& label,
                         FogMethod method) -> FogOptions& {
        FogOptions options;
        options.optical_thickness = {ladder.optical_thickness};
        options.method = method;
        rungs.push_back({kind, name, label, options, {}});
        return rungs.back().options;
    };
    // First, for the others are compared with it.
    add(Kind::rings, "rings", "rings", FogMethod::rings);
    for (const int order : kOrders) {
        if (order < ladder.height) {
            const std::string text = std::to_string(order);
            add(Kind::sh, "sh order " + text, text, FogMethod::sh).sh_order = order;
        }
    }
    add(Kind::sh, "sh all bands", "all bands", FogMethod::sh);
    FogOptions& factored = add(Kind::factored, "factored psf", "factored psf", FogMethod::split);
    factored.psf = PsfForm::factored;
    factored.tolerance = 1e-4;
    for (const double tolerance : kTolerances) {
        const std::string text = tolerance_name(tolerance);
        add(Kind::split, "split " + text, text, FogMethod::split).tolerance = tolerance;
    }
    return rungs;
}

void find_errors(const Image& image, const Image& exact, Rung& rung) {
    std::vector<double> errors(image.pixels.size());
    double squares = 0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        errors[i] = std::abs(double{image.pixels[i]} / exact.pixels[i] - 1);
        squares += errors[i] * errors[i];
    }
    rung.rms_error = std::sqrt(squares / static_cast<double>(errors.size()));
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    rung.median_error = *middle;
    rung.max_error = *std::max_element(middle, errors.end());
    for (std::size_t i = 0; i < image.pixels.size(); i += image.channels) {
        const auto pixel = image.pixels.begin() + static_cast<std::ptrdiff_t>(i);
        rung.negative_pixels +=
            std::any_of(pixel, pixel + image.channels, [](float value) { return value < 0; });
    }
}

void measure_rung(FogMeasurements& fog, std::size_t index) {
    Rung& rung = fog.rungs[index];
    if (fog.map.width == 0) fog.map = sun_and_sky(fog.options.width, fog.options.height);
    Image image;
    rung.seconds = fastest_seconds(rung.kind == Kind::rings ? 1 : 3, time_kind(), [&] {
        rung.plan = plan_fog(fog.map.height, fog.map.width, fog.map.channels, rung.options);
        image = scattered_light(fog.map, rung.plan);
    });
    if (rung.kind == Kind::rings) {
        fog.exact = std::move(image);
    } else {
        find_errors(image, fog.exact, rung);
    }
}

void measure_cost(FogMeasurements& fog, std::size_t index) {
    Cost& cost = fog.costs[index];
    if (fog.map.width != cost.width) fog.map = sun_and_sky(cost.width, cost.height);
    FogOptions options;
    options.optical_thickness = {fog.options.optical_thickness};
    options.method = FogMethod::split;
    options.tolerance = cost.tolerance;
    cost.seconds = fastest_seconds(2, time_kind(), [&] {
        cost.plan = plan_fog(fog.map.height, fog.map.width, fog.map.channels, options);
        scattered_light(fog.map, cost.plan);
    });
}

// The rings have neither, and small maps take them for a split that would cost more.
TableCell highest_band(const FogPlan& plan) {
    return plan.lmax < 0 ? TableCell() : TableCell(std::int64_t{plan.lmax});
}

TableCell near_radius(const FogPlan& plan) {
    return plan.method == FogMethod::split ? TableCell(kDegrees * plan.radius) : TableCell();
}

LadderFigure error_figure(const FogMeasurements& fog) {
    LadderFigure figure;
    figure.name = "fog";
    figure.text = fmt::format(
        "<p>Scattered light of a {0} × {1} RGB map at optical thickness {2}: a smooth sky with a "
        "sun of 10⁵ in one pixel. The error of a pixel is relative to its own value by the method "
        "<code>rings</code>, which sums exact integrals over every pixel of the map; its own bound "
        "is 1e-6. Dots are the largest error over all pixels and channels, bars lead down to the "
        "root mean square. Times are those of the fastest of several runs ({3}), planning "
        "included. "
        "<code>split</code> is named with the tolerance asked. <code>factored psf</code> is the "
        "split at 1e-4 with T·e<sup>−T</sup>·NPSF in place of the exact point spread "
        "function.</p>",
        fog.options.width, fog.options.height, fog.options.optical_thickness, time_name());
    figure.plot.title = "Fog of an environment map: error against time";
    figure.plot.subtitle = fmt::format(
        "{} × {} RGB, T = {}, soft sky and a one-pixel sun of 10⁵; down and left is better",
        fog.options.width, fog.options.height, fog.options.optical_thickness);
    figure.plot.x.label = time_name() + " [ms per map]";
    figure.plot.y.label = "relative error of a pixel: largest (dot), RMS (bar end)";
    figure.plot.series = {{"sh, by order", kPlotColours[1], true, {}},
                          {"factored psf", kPlotColours[3], false, {}},
                          {"split, by tolerance", kPlotColours[0], true, {}},
                          {"rings (their stated bound)", kPlotColours[2], false, {}}};
    figure.table.columns = {{"rung", "rung"},
                            {"tolerance", "tolerance asked"},
                            {"time_ms", "time per map [ms]"},
                            {"max_relative_error", "largest relative error"},
                            {"rms_relative_error", "RMS relative error"},
                            {"median_relative_error", "median relative error"},
                            {"negative_pixels", "negative pixels"},
                            {"stated_bound", "bound stated by the plan"},
                            {"highest_band", "highest band"},
                            {"near_radius_degrees", "near radius [degrees]"}};
    for (const Rung& rung : fog.rungs) {
        const double milliseconds = 1e3 * rung.seconds;
        const bool truth = rung.kind == Kind::rings;
        figure.plot.series[static_cast<std::size_t>(rung.kind)].points.push_back(
            {milliseconds, truth ? rung.plan.estimated_error : rung.max_error, rung.label, truth,
             truth ? 0 : rung.rms_error});
        std::vector<TableCell> row(figure.table.columns.size());
        row[0] = rung.name;
        if (rung.kind == Kind::split) row[1] = rung.options.tolerance;
        row[2] = milliseconds;
        if (!truth) {
            row[3] = rung.max_error;
            row[4] = rung.rms_error;
            row[5] = rung.median_error;
        }
        row[6] = rung.negative_pixels;
        // The factored form's is a bound against the factored kernel, not against the truth.
        if (rung.plan.estimated_error >= 0 && rung.kind != Kind::factored) {
            row[7] = rung.plan.estimated_error;
        }
        row[8] = highest_band(rung.plan);
        row[9] = near_radius(rung.plan);
        figure.table.rows.push_back(std::move(row));
    }
    return figure;
}

LadderFigure cost_figure(const FogMeasurements& fog) {
    LadderFigure figure;
    figure.name = "fog-size";
    figure.text =
        "<p>The cost of <code>split</code> per pixel of a map of the same kind, three channels "
        "together, planning included.</p>";
    figure.plot.title = "Fog of an environment map: cost against size";
    figure.plot.subtitle =
        fmt::format("split, RGB, T = {}, one line per tolerance", fog.options.optical_thickness);
    figure.plot.x.label = "size of the map [pixels]";
    figure.plot.y.label = time_name() + " [ns per pixel]";
    figure.table.columns = {{"width", "width"},
                            {"height", "height"},
                            {"tolerance", "tolerance asked"},
                            {"time_ms", "time per map [ms]"},
                            {"ns_per_pixel", "time per pixel [ns]"},
                            {"highest_band", "highest band"},
                            {"near_radius_degrees", "near radius [degrees]"}};
    for (std::size_t i = 0; i < std::size(kTolerances); ++i) {
        figure.plot.series.push_back(
            {"tolerance " + tolerance_name(kTolerances[i]), kPlotColours[i], true, {}});
    }
    for (const Cost& cost : fog.costs) {
        const double pixels = static_cast<double>(cost.width) * cost.height;
        const double nanoseconds = 1e9 * cost.seconds / pixels;
        const std::size_t index = static_cast<std::size_t>(
            std::find(std::begin(kTolerances), std::end(kTolerances), cost.tolerance) -
            std::begin(kTolerances));
        figure.plot.series[index].points.push_back({pixels, nanoseconds});
        if (index == 0) {
            figure.plot.x.ticks.push_back({pixels, fmt::format("{}×{}", cost.width, cost.height)});
        }
        figure.table.rows.push_back({std::int64_t{cost.width}, std::int64_t{cost.height},
                                     cost.tolerance, 1e3 * cost.seconds, nanoseconds,
                                     highest_band(cost.plan), near_radius(cost.plan)});
    }
    return figure;
}

}  // namespace

LadderWork plan_fog_ladder(const LadderOptions& options) {
    const auto fog = std::make_shared<FogMeasurements>();
    fog->options = options;
    fog->rungs = make_rungs(options);
    LadderWork work;
    work.files = {"fog.csv", "fog.svg", "fog-size.csv", "fog-size.svg"};
    const double pixels = static_cast<double>(options.width) * options.height;
    for (std::size_t i = 0; i < fog->rungs.size(); ++i) {
        // Nanoseconds per pixel, about, and per pair of pixel and row for the rings.
        const double expected =
            fog->rungs[i].kind == Kind::rings ? 10 * pixels * options.height : 3 * 150 * pixels;
        work.steps.push_back({static_cast<std::uint64_t>(std::max(125.0, 1e-6 * expected)),
                              [fog, i] { measure_rung(*fog, i); }});
    }
    for (int factor = 1; factor <= (options.full ? 16 : 8); factor *= 2) {
        for (const double tolerance : kTolerances) {
            Cost cost;
            cost.width = factor * options.width;
            cost.height = factor * options.height;
            cost.tolerance = tolerance;
            fog->costs.push_back(cost);
            const double expected = 2 * 150 * pixels * factor * factor;
            const std::size_t i = fog->costs.size() - 1;
            work.steps.push_back({static_cast<std::uint64_t>(std::max(125.0, 1e-6 * expected)),
                                  [fog, i] { measure_cost(*fog, i); }});
        }
    }
    work.finish = [fog] {
        LadderEffect effect;
        effect.name = "fog";
        effect.title = "Fog of environment maps";
        // Cheapest to exact, as a ladder goes.
        std::rotate(fog->rungs.begin(), fog->rungs.begin() + 1, fog->rungs.end());
        effect.figures = {error_figure(*fog), cost_figure(*fog)};
        return effect;
    };
    return work;
}

}  // namespace airlight
