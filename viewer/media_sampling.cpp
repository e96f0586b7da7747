// SPDX-License-Identifier: Apache-2.0
#include "viewer/media_sampling.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/constants.h"
#include "viewer/axes.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double sum_of(const glm::dvec3& colour) {
    return colour.x + colour.y + colour.z;
}

}  // namespace

double distance_at_depth(const SceneMedia& media, const glm::dvec3& origin,
                         const glm::dvec3& direction, double end, int channel, double depth) {
    if (media.everywhere()) {
        const double sigma = (*media.everywhere())[channel];
        return sigma > 0 && depth < sigma * end ? depth / sigma : kInfinite;
    }
    const auto depth_to = [&](double t) { return media.depth(origin, direction, t)[channel]; };
    double above = depth_to(end);
    if (!(above > depth)) return kInfinite;
    double low = 0, below = 0, high = end;
    if (!std::isfinite(above) || !std::isfinite(end)) {
        // Metres are the scale of scenes.
        for (double t = 1; t < end; t *= 4) {
            const double here = depth_to(t);
            if (here > depth) {
                high = t;
                above = here;
                break;
            }
            low = t;
            below = here;
        }
    }
    double t =
        low + (high - low) * (std::isfinite(above) ? (depth - below) / (above - below) : 0.5);
    constexpr int kMostSteps = 200;
    double width = high - low;
    for (int i = 1; i <= kMostSteps; ++i) {
        const double here = depth_to(t), off = here - depth;
        if (std::abs(off) <= 1e-9 * depth) break;
        (off < 0 ? low : high) = t;
        if (!(high - low > 1e-14 * high)) break;
        const double density = media.density(origin + t * direction)[channel];
        t -= off / density;
        // Newton's steps crawl where the density jumps or dies away.
        const bool slow = i % 4 == 0 && high - low > 0.25 * width;
        if (i % 4 == 0) width = high - low;
        if (slow || !(t > low && t < high)) t = 0.5 * (low + high);
    }
    return t;
}

void MediaPoint::move_to(const SceneMedia& media, const glm::dvec3& x) {
    media_ = &media;
    scattering_.resize(media.parts().size());
    extinction_ = glm::dvec3(0);
    for (std::size_t i = 0; i < scattering_.size(); ++i) {
        const MediumPart& part = media.parts()[i];
        const glm::dvec3 density = part.density(x);
        extinction_ += density;
        scattering_[i] = part.albedo() * density;
    }
}

glm::dvec3 MediaPoint::sent_at_cosine(double cosine) const {
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < scattering_.size(); ++i) {
        sum += scattering_[i] * media_->parts()[i].phase().at_cosine(cosine);
    }
    return sum;
}

glm::dvec3 MediaPoint::sent_at_angle(double angle) const {
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < scattering_.size(); ++i) {
        sum += scattering_[i] * media_->parts()[i].phase().at_angle(angle);
    }
    return sum;
}

void MediaPoint::weigh(const glm::dvec3& weight) {
    chances_.resize(scattering_.size());
    total_ = 0;
    for (std::size_t i = 0; i < scattering_.size(); ++i) {
        chances_[i] = sum_of(weight * scattering_[i]);
        total_ += chances_[i];
    }
}

double MediaPoint::sample_angle(double choice, double xi) const {
    std::size_t i = 0;
    for (double left = choice * total_; i + 1 < chances_.size() && !(left < chances_[i]); ++i) {
        left -= chances_[i];
    }
    return media_->parts()[i].phase().sample_angle(xi);
}

double MediaPoint::pdf_at_angle(double angle) const {
    double sum = 0;
    for (std::size_t i = 0; i < chances_.size(); ++i) {
        sum += chances_[i] * media_->parts()[i].phase().at_angle(angle);
    }
    return sum / total_;
}

double MediaPoint::pdf_at_cosine(double cosine) const {
    double sum = 0;
    for (std::size_t i = 0; i < chances_.size(); ++i) {
        sum += chances_[i] * media_->parts()[i].phase().at_cosine(cosine);
    }
    return sum / total_;
}

glm::dvec3 turned(const glm::dvec3& direction, double angle, double azimuth) {
    glm::dvec3 x, y;
    make_axes(direction, x, y);
    return glm::normalize(std::sin(angle) * (std::cos(azimuth) * x + std::sin(azimuth) * y) +
                          std::cos(angle) * direction);
}

EquiangularPaths::EquiangularPaths(const glm::dvec3& lamp, const glm::dvec3& origin,
                                   const glm::dvec3& direction, double end)
    : foot_(glm::dot(lamp - origin, direction)), end_(end) {
    // A ray through the lamp diverges there; the rounding of coordinates keeps it off.
    height_ =
        std::max(glm::length(lamp - origin - foot_ * direction), 1e-9 * (1 + std::abs(foot_)));
    begin_angle_ = std::atan(-foot_ / height_);
    end_angle_ = std::atan((end_ - foot_) / height_);
}

double EquiangularPaths::distance(double xi) const {
    const double angle = begin_angle_ + xi * (end_angle_ - begin_angle_);
    return std::clamp(foot_ + height_ * std::tan(angle), 0.0, end_);
}

double EquiangularPaths::pdf(double t) const {
    const double along = t - foot_;
    return height_ / ((end_angle_ - begin_angle_) * (along * along + height_ * height_));
}

}  // namespace airlight
