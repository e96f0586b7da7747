// SPDX-License-Identifier: Apache-2.0
#include "viewer/environment_sampler.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "envmap/latlong.h"

namespace airlight {
namespace {

// The interval of ascending sums that holds x of their last, and how far into it x lies.
struct Place {
    std::size_t index;
    double fraction;
};

Place find_place(const double* sums, std::size_t intervals, double x) {
    const double wanted = x * sums[intervals];
    const double* const above = std::upper_bound(sums + 1, sums + intervals, wanted);
    const auto index = static_cast<std::size_t>(above - sums) - 1;
    const double size = sums[index + 1] - sums[index];
    return {index, size > 0 ? std::clamp((wanted - sums[index]) / size, 0.0, 1.0) : 0.5};
}

double mean(const glm::dvec3& colour) {
    return (colour.x + colour.y + colour.z) / 3;
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(Image map, double rotation, double scale)
    : map_(std::move(map)), cosine_(std::cos(rotation)), sine_(std::sin(rotation)), scale_(scale) {
    const auto height = static_cast<std::size_t>(map_.height);
    const auto width = static_cast<std::size_t>(map_.width);
    rows_.assign(height + 1, 0);
    columns_.assign(height * (width + 1), 0);
    for (std::size_t r = 0; r < height; ++r) {
        double* const sums = columns_.data() + r * (width + 1);
        for (std::size_t c = 0; c < width; ++c) {
            sums[c + 1] = sums[c] + pixel_power(static_cast<int>(r), static_cast<int>(c));
        }
        rows_[r + 1] = rows_[r] + sums[width];
    }
}

glm::dvec3 EnvironmentSampler::pixel(int row, int column) const {
    return {map_.at(row, column, 0), map_.at(row, column, 1), map_.at(row, column, 2)};
}

double EnvironmentSampler::pixel_power(int row, int column) const {
    return mean(pixel(row, column)) * pixel_solid_angle(row, map_.width, map_.height);
}

glm::dvec3 EnvironmentSampler::to_map(const glm::dvec3& d) const {
    return {cosine_ * d.x - sine_ * d.z, d.y, sine_ * d.x + cosine_ * d.z};
}

glm::dvec3 EnvironmentSampler::to_world(const glm::dvec3& d) const {
    return {cosine_ * d.x + sine_ * d.z, d.y, cosine_ * d.z - sine_ * d.x};
}

EnvironmentSample EnvironmentSampler::at(const glm::dvec3& direction) const {
    const glm::dvec3 d = to_map(direction);
    const LatLongPixel p = pixel_of({d.x, d.y, d.z}, map_.width, map_.height);
    EnvironmentSample sample;
    sample.direction = direction;
    const glm::dvec3 value = pixel(p.row, p.column);
    sample.radiance = scale_ * value;
    if (rows_.back() > 0) sample.pdf = mean(value) / rows_.back();
    return sample;
}

glm::dvec3 EnvironmentSampler::radiance(const glm::dvec3& direction) const {
    return at(direction).radiance;
}

double EnvironmentSampler::pdf(const glm::dvec3& direction) const {
    return at(direction).pdf;
}

double EnvironmentSampler::brightest() const {
    const auto most = std::max_element(map_.pixels.begin(), map_.pixels.end());
    return most == map_.pixels.end() ? 0 : scale_ * double(*most);
}

EnvironmentSample EnvironmentSampler::sample(double x, double y) const {
    EnvironmentSample sample;
    if (!(rows_.back() > 0)) return sample;
    const auto height = static_cast<std::size_t>(map_.height);
    const auto width = static_cast<std::size_t>(map_.width);
    const Place row = find_place(rows_.data(), height, y);
    const Place column = find_place(columns_.data() + row.index * (width + 1), width, x);
    // Uniform in solid angle within the pixel: in the cosine of the colatitude.
    const double top = std::cos(kPi * double(row.index) / double(height));
    const double bottom = std::cos(kPi * double(row.index + 1) / double(height));
    const double y_axis = top + row.fraction * (bottom - top);
    const double across = std::sqrt(std::max(0.0, (1 - y_axis) * (1 + y_axis)));
    const double phi = 2 * kPi * (0.5 - (double(column.index) + column.fraction) / double(width));
    sample.direction = to_world({across * std::sin(phi), y_axis, across * std::cos(phi)});
    const glm::dvec3 value = pixel(static_cast<int>(row.index), static_cast<int>(column.index));
    sample.radiance = scale_ * value;
    sample.pdf = mean(value) / rows_.back();
    return sample;
}

}  // namespace airlight
