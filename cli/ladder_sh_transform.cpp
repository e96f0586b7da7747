// SPDX-License-Identifier: Apache-2.0
// The ladder of full transforms between maps and all bands that they hold.
#include <map>
#include <memory>

#include "cli/ladder_draws.h"
#include "cli/ladder_sh.h"
#include "sh/index.h"
#include "sh/transform.h"

namespace airlight {
namespace {

constexpr int kChannels = 3;

/// White noise of all bands of an RGB map with so many rows, and its map.
struct Noise {
    std::vector<double> bands, map;
};

const Noise& noise_of(int rows) {
    static std::map<int, Noise> kept;
    Noise& noise = kept[rows];
    if (noise.map.empty()) {
        noise.bands = random_numbers<double>(kChannels * sh_count(rows), 37);
        noise.map.resize(static_cast<std::size_t>(rows) * 2 * rows * kChannels);
        SphericalTransform(rows, 2 * rows, rows - 1)
            .synthesize(noise.bands.data(), kChannels, noise.map.data());
    }
    return noise;
}

// `values` come from `run`; all errors are over the largest exact value.
template <class T, class Run>
RungResult measure(const std::vector<double>& exact, std::vector<T>& values, double pixels,
                   const Run& run) {
    run();
    const LadderErrors errors = vector_errors(exact, values, exact.size());
    return {nanoseconds_each(pixels, run), errors.largest(), errors.rms()};
}

template <class T>
RungResult measure_transform(TransformPrecision precision, bool analysis, int rows) {
    const Noise& noise = noise_of(rows);
    const SphericalTransform transform(rows, 2 * rows, rows - 1, precision);
    std::vector<T> bands(noise.bands.begin(), noise.bands.end());
    std::vector<T> map(noise.map.begin(), noise.map.end());
    const double pixels = 2.0 * rows * rows;
    if (analysis) {
        return measure(noise.bands, bands, pixels,
                       [&] { transform.analyze(map.data(), kChannels, bands.data()); });
    }
    return measure(noise.map, map, pixels,
                   [&] { transform.synthesize(bands.data(), kChannels, map.data()); });
}

RungFigure figure(bool analysis) {
    RungFigure result;
    result.file = analysis ? "sh-transform" : "sh-transform-synthesis";
    result.title = analysis ? "Analysis of maps" : "Synthesis of maps";
    result.subtitle = "RGB maps to all bands that their rows hold; labels are rows";
    result.series = {{"double", kPlotColours[0], true, {}}, {"single", kPlotColours[1], true, {}}};
    for (const int rows : {32, 64, 128, 256, 512}) {
        for (std::size_t series = 0; series < result.series.size(); ++series) {
            LadderRung rung;
            rung.method = result.series[series].name;
            rung.set = (analysis ? "analysis " : "synthesis ") + std::to_string(rows);
            rung.label = std::to_string(rows);
            rung.series = series;
            rung.measure = [=] {
                return series == 0
                           ? measure_transform<double>(TransformPrecision::full, analysis, rows)
                           : measure_transform<float>(TransformPrecision::single, analysis, rows);
            };
            if (!analysis && series == 0) rung.bound = 3e-14;
            result.rungs.push_back(std::move(rung));
        }
    }
    return result;
}

}  // namespace

RungLadder sh_transform_ladder() {
    RungLadder ladder;
    ladder.effect = "sh-transform";
    ladder.title = "Full transforms of maps";
    ladder.text =
        "<p>RGB maps of twice as many columns as rows, to degree rows − 1 and back: "
        "<code>double</code> maps in double, <code>single</code> float maps in float. The bands "
        "are white noise; the map is what <code>double</code> makes of them, so that its synthesis "
        "is drawn with the bound of the tests on both ways, and its analysis has the error of "
        "both. The error is divided by the "
        "largest value; times are per pixel of three channels.</p>";
    ladder.result = "pixel";
    ladder.error = "error over the largest value";
    ladder.figures = {figure(true), figure(false)};
    return ladder;
}

}  // namespace airlight
