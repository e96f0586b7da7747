// SPDX-License-Identifier: Apache-2.0
#include "viewer/picture_compare.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace airlight {
namespace {

// 0 where nothing differs, whatever it is measured by.
double over(double a, double b) {
    return a == 0 ? 0 : b > 0 ? a / b : std::copysign(std::numeric_limits<double>::infinity(), a);
}

double mean_of(const float* pixel) {
    return (double(pixel[0]) + pixel[1] + pixel[2]) / 3;
}

}  // namespace

double brightest_of(const Image& image) {
    double most = 0;
    for (const float value : image.pixels) most = std::max(most, double(value));
    return most;
}

PictureErrors compare_pictures(const Image& other, const Image& truth, double brightest) {
    assert(other.pixels.size() == truth.pixels.size() && truth.channels == 3);
    if (!(brightest > 0)) brightest = brightest_of(truth);
    PictureErrors result;
    const std::size_t pixels = truth.pixels.size() / 3;
    if (pixels == 0) return result;
    std::vector<double> errors(pixels);
    double squares = 0, truth_squares = 0, all_squares = 0, sum = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        const float* const a = other.pixels.data() + 3 * i;
        const float* const b = truth.pixels.data() + 3 * i;
        for (int c = 0; c < 3; ++c) {
            const double difference = double(a[c]) - double(b[c]);
            errors[i] = std::max(errors[i], std::abs(difference));
            all_squares += difference * difference;
            truth_squares += double(b[c]) * double(b[c]);
        }
        squares += errors[i] * errors[i];
        sum += mean_of(a) - mean_of(b);
    }
    const std::size_t rank = (pixels - 1) * 99 / 100;
    std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(rank),
                     errors.end());
    result.p99 = over(errors[rank], brightest);
    result.largest = over(*std::max_element(errors.begin(), errors.end()), brightest);
    result.rms = over(std::sqrt(squares / double(pixels)), brightest);
    result.relative = over(std::sqrt(all_squares), std::sqrt(truth_squares));
    result.bias = over(sum / double(pixels), brightest);
    return result;
}

LayerErrors compare_layers(const LayerImages& other, const LayerImages& truth, double brightest) {
    LayerErrors result;
    double most = 0;
    for (std::size_t i = 0; i < kRadianceLayerCount; ++i) {
        result.layers[i] = compare_pictures(other[i], truth[i], brightest);
        if (!(result.layers[i].rms > most)) continue;
        most = result.layers[i].rms;
        result.owner = kRadianceLayers[i].method;
    }
    return result;
}

Sheet difference_picture(const Image& other, const Image& truth, double brightest) {
    constexpr double kDecades = 4;
    constexpr double kBrighter[3] = {255, 150, 40}, kDarker[3] = {60, 140, 255};
    Sheet sheet;
    sheet.width = truth.width;
    sheet.height = truth.height;
    sheet.pixels.resize(truth.pixels.size());
    for (std::size_t i = 0; i < truth.pixels.size() / 3; ++i) {
        const double difference = over(
            mean_of(other.pixels.data() + 3 * i) - mean_of(truth.pixels.data() + 3 * i), brightest);
        const double share = std::clamp(1 + std::log10(std::abs(difference)) / kDecades, 0.0, 1.0);
        for (std::size_t c = 0; c < 3; ++c) {
            const double full = difference > 0 ? kBrighter[c] : kDarker[c];
            sheet.pixels[3 * i + c] = static_cast<std::uint8_t>(std::lround(share * full));
        }
    }
    return sheet;
}

}  // namespace airlight
