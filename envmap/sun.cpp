// SPDX-License-Identifier: Apache-2.0
#include "envmap/sun.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <string>
#include <utility>

#include "core/constants.h"
#include "core/error.h"

namespace airlight {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double angle_between(const Vector& a, const Vector& b) {
    const Vector c = cross(a, b);
    return std::atan2(std::hypot(c[0], c[1], c[2]), dot(a, b));
}

double luminance(const float* pixel, int channels) {
    if (channels == 3) return 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
    double sum = 0;
    for (int c = 0; c < channels; ++c) sum += pixel[c];
    return sum / channels;
}

/// The integral of the direction over a pixel.
Vector pixel_moment(int row, int column, int width, int height) {
    const double centre = row_colatitude(row, height), half = kPi / (2.0 * height);
    // int sin^2 = half - cos(2 centre) sin(2 half) / 2 over the row, int sin cos = sin(2 centre)
    // sin(2 half) / 2.
    const double across = half - std::cos(2 * centre) * std::sin(2 * half) / 2;
    const double up = std::sin(2 * centre) * std::sin(2 * half) / 2;
    const double phi = 2 * kPi * (0.5 - (column + 0.5) / width);
    const double chord = 2 * std::sin(kPi / width);
    return {across * std::sin(phi) * chord, up * 2 * kPi / width, across * std::cos(phi) * chord};
}

void refuse_what_is_not_finite(const Image& map) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        if (!std::isfinite(map.pixels[i]) && count++ == 0) first = i;
    }
    if (count == 0) return;
    const std::size_t pixel = first / map.channels;
    throw Error(ErrorCode::data, std::to_string(count) +
                                     " values are not finite, the first at row " +
                                     std::to_string(pixel / map.width) + ", column " +
                                     std::to_string(pixel % map.width) + ", channel " +
                                     std::to_string(first % map.channels));
}

/// Pixels from the peak outwards, always the brightest that touches them.
class Flood {
  public:
    Flood(const Image& map, std::size_t peak, double largest_angle)
        : map_(map), seen_(std::size_t(map.width) * map.height) {
        const Vector top = direction(peak);
        double level = luminance_of(peak);
        visit(peak);
        while (!queue_.empty()) {
            const auto [value, behind] = queue_.top();
            queue_.pop();
            const std::size_t pixel = std::numeric_limits<std::size_t>::max() - behind;
            level = std::min(level, value);
            if (angle_between(direction(pixel), top) > largest_angle) {
                escape_ = level;
                break;
            }
            pixels_.push_back(pixel);
            levels_.push_back(level);
            visit_neighbours(pixel);
        }
    }

    /// The luminance at which the region reaches beyond the largest angle; -inf if it has all.
    double escape() const { return escape_; }

    /// The connected pixels with luminance above `level` >= escape().
    std::vector<std::size_t> above(double level) const {
        const auto end = std::partition_point(levels_.begin(), levels_.end(),
                                              [&](double own) { return own > level; });
        return {pixels_.begin(), pixels_.begin() + (end - levels_.begin())};
    }

    Vector direction(std::size_t pixel) const {
        return pixel_direction(static_cast<int>(pixel / map_.width),
                               static_cast<int>(pixel % map_.width), map_.width, map_.height);
    }

    double luminance_of(std::size_t pixel) const {
        return luminance(map_.pixels.data() + pixel * map_.channels, map_.channels);
    }

  private:
    void visit(std::size_t pixel) {
        if (seen_[pixel]) return;
        seen_[pixel] = true;
        // Of equals the first in the file.
        queue_.emplace(luminance_of(pixel), std::numeric_limits<std::size_t>::max() - pixel);
    }

    void visit_row(int row) {
        for (int i = 0; i < map_.width; ++i) visit(std::size_t(row) * map_.width + i);
    }

    // Lossy compression leaves single dark pixels beside a sun, so one pixel parts nothing.
    void visit_neighbours(std::size_t pixel) {
        const int row = static_cast<int>(pixel / map_.width);
        const int column = static_cast<int>(pixel % map_.width);
        for (int j = std::max(row - 2, 0); j <= std::min(row + 2, map_.height - 1); ++j) {
            for (int di = -2; di <= 2; ++di) {
                visit(std::size_t(j) * map_.width + (column + di + map_.width) % map_.width);
            }
        }
        if (row == 0 && !std::exchange(top_, true)) visit_row(row);
        if (row == map_.height - 1 && !std::exchange(bottom_, true)) visit_row(row);
    }

    const Image& map_;
    std::vector<bool> seen_;
    bool top_ = false, bottom_ = false;
    std::priority_queue<std::pair<double, std::size_t>> queue_;
    std::vector<std::size_t> pixels_;
    std::vector<double> levels_;
    double escape_ = -std::numeric_limits<double>::infinity();
};

/// What lies around a region.
struct Ring {
    Vector axis = {};
    std::vector<std::size_t> pixels;
    std::vector<double> weights;
    double median = 0;  ///< luminance
};

Ring ring_around(const Image& map, const Flood& flood, const std::vector<std::size_t>& region) {
    Ring ring;
    for (const std::size_t pixel : region) {
        const Vector d = flood.direction(pixel);
        const double w =
            pixel_solid_angle(static_cast<int>(pixel / map.width), map.width, map.height);
        for (int k = 0; k < 3; ++k) ring.axis[k] += w * d[k];
    }
    const double length = std::hypot(ring.axis[0], ring.axis[1], ring.axis[2]);
    // A region that balances itself surrounds whatever else there is.
    if (!(length > 0)) return ring;
    for (double& x : ring.axis) x /= length;
    double inner = 0, darkest = std::numeric_limits<double>::infinity();
    for (const std::size_t pixel : region) {
        inner = std::max(inner, angle_between(flood.direction(pixel), ring.axis));
        darkest = std::min(darkest, flood.luminance_of(pixel));
    }
    std::vector<bool> inside(std::size_t(map.width) * map.height);
    for (const std::size_t pixel : region) inside[pixel] = true;
    const double row_angle = kPi / map.height, polar = point_of(ring.axis).v * kPi;
    std::vector<std::pair<double, double>> values;
    for (double outer = 2 * inner + 3 * row_angle;; outer *= 2) {
        ring.pixels.clear();
        ring.weights.clear();
        values.clear();
        const int first = std::max(0, static_cast<int>((polar - outer) / row_angle) - 1);
        const int last =
            std::min(map.height - 1, static_cast<int>((polar + outer) / row_angle) + 1);
        for (int j = first; j <= last; ++j) {
            for (int i = 0; i < map.width; ++i) {
                const std::size_t pixel = std::size_t(j) * map.width + i;
                if (inside[pixel] || angle_between(flood.direction(pixel), ring.axis) > outer) {
                    continue;
                }
                const double y = flood.luminance_of(pixel);
                // Other lights are no surroundings.
                if (y >= darkest) continue;
                ring.pixels.push_back(pixel);
                ring.weights.push_back(pixel_solid_angle(j, map.width, map.height));
                values.emplace_back(y, ring.weights.back());
            }
        }
        if (ring.pixels.size() >= 8 || outer > kPi) break;
    }
    if (values.empty()) return ring;
    std::sort(values.begin(), values.end());
    double half = 0, sum = 0;
    for (const auto& value : values) half += value.second / 2;
    for (const auto& value : values) {
        sum += value.second;
        ring.median = value.first;
        if (sum >= half) break;
    }
    return ring;
}

/// The plane a + b u + c v over the tangent coordinates u, v of the ring's axis that fits one
/// channel of its pixels, kept within their extremes.
class Plane {
  public:
    Plane(const Image& map, const Flood& flood, const Ring& ring, int channel) : axis_(ring.axis) {
        const Vector away = std::abs(axis_[1]) < 0.7 ? Vector{0, 1, 0} : Vector{1, 0, 0};
        u_ = cross(away, axis_);
        const double length = std::hypot(u_[0], u_[1], u_[2]);
        for (double& x : u_) x /= length;
        v_ = cross(axis_, u_);
        double weight = 0, mean_u = 0, mean_v = 0;
        for (std::size_t k = 0; k < ring.pixels.size(); ++k) {
            const double w = ring.weights[k], f = value(map, ring.pixels[k], channel);
            const Vector d = flood.direction(ring.pixels[k]);
            least_ = std::min(least_, f);
            most_ = std::max(most_, f);
            weight += w;
            mean_ += w * f;
            mean_u += w * dot(d, u_);
            mean_v += w * dot(d, v_);
        }
        mean_ /= weight;
        mid_u_ = mean_u / weight;
        mid_v_ = mean_v / weight;
        double uu = 0, uv = 0, vv = 0, fu = 0, fv = 0;
        for (std::size_t k = 0; k < ring.pixels.size(); ++k) {
            const double w = ring.weights[k];
            const double f = value(map, ring.pixels[k], channel) - mean_;
            const Vector d = flood.direction(ring.pixels[k]);
            const double u = dot(d, u_) - mid_u_, v = dot(d, v_) - mid_v_;
            uu += w * u * u;
            uv += w * u * v;
            vv += w * v * v;
            fu += w * f * u;
            fv += w * f * v;
        }
        const double determinant = uu * vv - uv * uv;
        if (determinant > 1e-6 * uu * vv) {
            slope_u_ = (fu * vv - fv * uv) / determinant;
            slope_v_ = (fv * uu - fu * uv) / determinant;
        }
    }

    float at(const Vector& d) const {
        const double f =
            mean_ + slope_u_ * (dot(d, u_) - mid_u_) + slope_v_ * (dot(d, v_) - mid_v_);
        return static_cast<float>(std::clamp(f, least_, most_));
    }

  private:
    static double value(const Image& map, std::size_t pixel, int channel) {
        return map.pixels[pixel * map.channels + channel];
    }

    Vector axis_, u_, v_;
    double mean_ = 0, mid_u_ = 0, mid_v_ = 0, slope_u_ = 0, slope_v_ = 0;
    double least_ = std::numeric_limits<double>::infinity(), most_ = -least_;
};

void take_out(Image& map, const Flood& flood, const std::vector<std::size_t>& region,
              const Ring& ring, Sun& sun) {
    std::vector<Plane> planes;
    for (int c = 0; c < map.channels; ++c) planes.emplace_back(map, flood, ring, c);
    sun.irradiance.assign(map.channels, 0.0);
    Vector moment = {};
    double power = 0;
    for (const std::size_t pixel : region) {
        const int row = static_cast<int>(pixel / map.width);
        const int column = static_cast<int>(pixel % map.width);
        const double solid_angle = pixel_solid_angle(row, map.width, map.height);
        const Vector d = flood.direction(pixel);
        float* values = map.pixels.data() + pixel * map.channels;
        double lost = 0;
        for (int c = 0; c < map.channels; ++c) {
            const float left = std::min(values[c], planes[c].at(d));
            const double difference = static_cast<double>(values[c]) - left;
            sun.irradiance[c] += difference * solid_angle;
            const double weights[] = {0.2126, 0.7152, 0.0722};
            lost += difference * (map.channels == 3 ? weights[c] : 1.0 / map.channels);
            values[c] = left;
        }
        const Vector own = pixel_moment(row, column, map.width, map.height);
        for (int k = 0; k < 3; ++k) moment[k] += lost * own[k];
        power += lost * solid_angle;
        sun.solid_angle += solid_angle;
        sun.pixels.push_back({row, column});
    }
    const double length = std::hypot(moment[0], moment[1], moment[2]);
    for (int k = 0; k < 3; ++k) sun.direction[k] = moment[k] / length;
    sun.angular_radius = 2 * std::asin(std::sqrt(std::clamp(1 - length / power, 0.0, 1.0)));
    for (const std::size_t pixel : region) {
        sun.reach = std::max(sun.reach, angle_between(flood.direction(pixel), sun.direction));
    }
}

}  // namespace

const char* to_text(SunVerdict verdict) {
    switch (verdict) {
        case SunVerdict::found:
            return "the sun was found";
        case SunVerdict::dark:
            return "no pixel is brighter than 0";
        case SunVerdict::flat:
            return "nothing stands out from its surroundings";
        case SunVerdict::wide:
            return "the brightest region is too wide for a sun";
    }
    return "";
}

Sun extract_sun(Image& map, const SunOptions& options) {
    if (!(options.largest_radius > 0 && options.largest_radius <= kPi / 2)) {
        throw Error(ErrorCode::usage, fmt::format("largest radius {} of a sun is not in (0, pi/2]",
                                                  options.largest_radius));
    }
    if (!(options.least_contrast > 1)) {
        throw Error(ErrorCode::usage, fmt::format("least contrast {} of a sun is not above 1",
                                                  options.least_contrast));
    }
    if (map.pixels.empty()) throw Error(ErrorCode::data, "the map has no pixels");
    refuse_what_is_not_finite(map);
    std::size_t peak = 0;
    double brightest = -std::numeric_limits<double>::infinity(), darkest = -brightest;
    for (std::size_t i = 0; i < map.pixels.size() / map.channels; ++i) {
        const double y = luminance(map.pixels.data() + i * map.channels, map.channels);
        darkest = std::min(darkest, y);
        if (y > brightest) {
            brightest = y;
            peak = i;
        }
    }
    Sun sun;
    if (!(brightest > 0)) return sun;
    const Flood flood(map, peak, std::max(options.largest_radius, 1.5 * kPi / map.height));
    if (flood.escape() >= brightest / 2) {
        sun.verdict =
            darkest * options.least_contrast > brightest ? SunVerdict::flat : SunVerdict::wide;
        return sun;
    }
    // The ring depends on the region and the region on the ring; from the peak they settle.
    double level = std::max(flood.escape(), brightest / 2);
    std::vector<std::size_t> region;
    Ring ring;
    for (int round = 0; round < 8; ++round) {
        region = flood.above(level);
        ring = ring_around(map, flood, region);
        if (ring.pixels.empty() || ring.median * options.least_contrast > brightest) {
            sun.verdict = SunVerdict::flat;
            return sun;
        }
        const double surroundings = std::max(ring.median, 0.0);
        const double next =
            std::max(flood.escape(),
                     surroundings + std::max(surroundings / 2, (brightest - surroundings) / 256));
        if (next == level) break;
        level = next;
    }
    sun.verdict = SunVerdict::found;
    take_out(map, flood, region, ring, sun);
    return sun;
}

}  // namespace airlight
