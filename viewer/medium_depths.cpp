// SPDX-License-Identifier: Apache-2.0
#include "viewer/medium_depths.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "medium/gaussian_line_batch.h"
#include "medium/height_density_batch.h"
#include "medium/spherical_density_batch.h"

namespace airlight {
namespace {

constexpr std::size_t kRays = 32;   // at a time
constexpr double kTop = 60;         // in scale heights
constexpr double kFarFromBlob = 8;  // in units of its 1 / scale

// Of thinner atmospheres single precision does not tell how deep a ray grazes.
bool is_thick(const SphericalExponentialDensity* air) {
    return air && air->scale_height > 1e-4 * air->radius;
}

// Nothing times an endless depth is nothing.
void add(const glm::dvec3& colour, float depth, glm::dvec3& sum) {
    for (int c = 0; c < 3; ++c) {
        if (colour[c] > 0) sum[c] += colour[c] * double(depth);
    }
}

}  // namespace

MediumDepths::MediumDepths(const SceneMedia& media, MediumExtent extent) {
    for (const MediumPart& part : media.parts()) {
        if (!part.is_of(extent)) continue;
        if (part.everywhere()) {
            uniform_ += *part.everywhere();
            continue;
        }
        const Density* const shape = part.bounds() ? nullptr : part.single_shape();
        if (part.is_gaussian() && !part.bounds() &&
            blobs_.size() + part.blobs().size() <= kMostBlobs) {
            blobs_.insert(blobs_.end(), part.blobs().begin(), part.blobs().end());
        } else if (shape && std::holds_alternative<ExponentialHeightDensity>(*shape)) {
            layers_.push_back({std::get<ExponentialHeightDensity>(*shape), part.colour()});
        } else if (shape && is_thick(std::get_if<SphericalExponentialDensity>(shape))) {
            atmospheres_.push_back({std::get<SphericalExponentialDensity>(*shape), part.colour()});
        } else {
            parts_.push_back(&part);
        }
    }
}

void MediumDepths::operator()(std::size_t count, const glm::dvec3* origins,
                              const glm::dvec3* directions, const double* distances,
                              glm::dvec3* out) const {
    for (std::size_t i = 0; i < count; ++i) {
        out[i] = glm::dvec3(0);
        for (int c = 0; c < 3; ++c) {
            if (uniform_[c] > 0) out[i][c] = uniform_[c] * distances[i];
        }
        for (const MediumPart* const part : parts_) {
            out[i] += part->depth(origins[i], directions[i], distances[i]);
        }
    }
    if (!blobs_.empty()) add_blobs(count, origins, directions, distances, out);
    for (std::size_t begin = 0; begin < count; begin += kRays) {
        const std::size_t some = std::min(kRays, count - begin);
        for (const Layer& layer : layers_) {
            add_layer(layer, some, origins + begin, directions + begin, distances + begin,
                      out + begin);
        }
        for (const Atmosphere& atmosphere : atmospheres_) {
            add_atmosphere(atmosphere, some, origins + begin, directions + begin, distances + begin,
                           out + begin);
        }
    }
}

// Rays from far above begin where they come below kTop scale heights: from where they do come,
// single precision does not tell how deep they go.
void MediumDepths::add_layer(const Layer& layer, std::size_t count, const glm::dvec3* origins,
                             const glm::dvec3* directions, const double* distances,
                             glm::dvec3* out) {
    float y[kRays] = {}, up[kRays] = {}, end[kRays] = {}, inverse[kRays] = {}, result[kRays];
    const double height = layer.shape.scale_height, sign = height < 0 ? -1 : 1;
    for (std::size_t i = 0; i < count; ++i) {
        const double above = sign * origins[i].y - kTop * std::abs(height);
        const double down = -sign * directions[i].y;
        const double skipped = above > 0 && down > 0 ? std::min(above / down, distances[i]) : 0;
        y[i] = static_cast<float>(origins[i].y + skipped * directions[i].y);
        up[i] = static_cast<float>(directions[i].y);
        end[i] = static_cast<float>(skipped < distances[i] ? distances[i] - skipped : 0);
        inverse[i] = static_cast<float>(1 / height);
    }
    exponential_height_depth_batch(count, y, up, end, inverse, result);
    for (std::size_t i = 0; i < count; ++i) add(layer.colour, result[i], out[i]);
}

void MediumDepths::add_atmosphere(const Atmosphere& atmosphere, std::size_t count,
                                  const glm::dvec3* origins, const glm::dvec3* directions,
                                  const double* distances, glm::dvec3* out) {
    const SphericalExponentialDensity& shape = atmosphere.shape;
    const double top = shape.radius + kTop * shape.scale_height;
    float altitude[kRays] = {}, cosine[kRays] = {}, end[kRays] = {}, result[kRays];
    for (std::size_t i = 0; i < count; ++i) {
        glm::dvec3 from = origins[i] - shape.center;
        double r = glm::length(from), distance = distances[i];
        if (r > top) {
            const double middle = -glm::dot(from, directions[i]);
            const glm::dvec3 off = from + middle * directions[i];
            const double square = (top - glm::length(off)) * (top + glm::length(off));
            // Those that pass by above get an end before their beginning.
            const double entry = square > 0 ? middle - std::sqrt(square) : distance;
            distance = entry > 0 ? std::max(0.0, distance - entry) : 0;
            if (distance > 0) from += entry * directions[i];
            r = glm::length(from);
        }
        altitude[i] = static_cast<float>(r - shape.radius);
        // At the center every direction leads up.
        const double rise = r > 0 ? glm::dot(from, directions[i]) / r : 1;
        cosine[i] = static_cast<float>(std::clamp(rise, -1.0, 1.0));
        end[i] = static_cast<float>(distance);
    }
    spherical_depth_at_altitude_batch(static_cast<float>(shape.radius),
                                      static_cast<float>(shape.scale_height), count, altitude,
                                      cosine, end, result);
    for (std::size_t i = 0; i < count; ++i) add(atmosphere.colour, result[i], out[i]);
}

// Rays begin no farther before a Gaussian than where it is e^{-64} of itself, for the same reason.
void MediumDepths::add_blobs(std::size_t count, const glm::dvec3* origins,
                             const glm::dvec3* directions, const double* distances,
                             glm::dvec3* out) const {
    float scale[kMostBlobs], amplitude[kMostBlobs], rho[kMostBlobs], place[kMostBlobs],
        end[kMostBlobs];
    const std::size_t rays = kMostBlobs / blobs_.size();
    for (std::size_t begin = 0; begin < count; begin += rays) {
        const std::size_t last = std::min(begin + rays, count);
        std::size_t k = 0;
        for (std::size_t i = begin; i < last; ++i) {
            for (const GaussianBlob& blob : blobs_) {
                const glm::dvec3 to = blob.center - origins[i];
                const double along = glm::dot(to, directions[i]);
                const double skipped = std::max(0.0, along - kFarFromBlob / blob.scale);
                scale[k] = static_cast<float>(blob.scale);
                amplitude[k] = static_cast<float>(blob.amplitude);
                rho[k] = static_cast<float>(glm::length(to - along * directions[i]));
                place[k] = static_cast<float>(along - skipped);
                end[k++] = static_cast<float>(std::max(0.0, distances[i] - skipped));
            }
        }
        gaussian_line_batch(k, scale, amplitude, rho, place, end, end);
        k = 0;
        for (std::size_t i = begin; i < last; ++i) {
            double sum = 0;
            for (std::size_t n = 0; n < blobs_.size(); ++n) sum += double(end[k++]);
            out[i] += sum;
        }
    }
}

}  // namespace airlight
