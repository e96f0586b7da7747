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
        if (part.is_gaussian() && !part.bounds() && part.blobs().size() <= kMostBlobs) {
            blobs_.insert(blobs_.end(), part.blobs().begin(), part.blobs().end());
        } else if (shape && std::holds_alternative<ExponentialHeightDensity>(*shape)) {
            layers_.push_back({std::get<ExponentialHeightDensity>(*shape), part.colour()});
        } else if (shape && std::holds_alternative<SphericalExponentialDensity>(*shape)) {
            atmospheres_.push_back({std::get<SphericalExponentialDensity>(*shape), part.colour()});
        } else {
            parts_.push_back(&part);
        }
    }
}

void MediumDepths::operator()(std::size_t count, const glm::dvec3* origins,
                              const glm::dvec3* directions, const double* distances,
                              glm::dvec3* out) {
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
    if (layers_.empty() && atmospheres_.empty()) return;
    auto& [a, b, c, d, result] = columns_;
    for (std::vector<float>& column : columns_) column.resize(std::max(column.size(), count));
    for (const Layer& layer : layers_) {
        for (std::size_t i = 0; i < count; ++i) {
            a[i] = static_cast<float>(origins[i].y);
            b[i] = static_cast<float>(directions[i].y);
            c[i] = static_cast<float>(distances[i]);
            d[i] = static_cast<float>(1 / layer.shape.scale_height);
        }
        exponential_height_depth_batch(count, a.data(), b.data(), c.data(), d.data(),
                                       result.data());
        for (std::size_t i = 0; i < count; ++i) add(layer.colour, result[i], out[i]);
    }
    for (const Atmosphere& atmosphere : atmospheres_) {
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 from = origins[i] - atmosphere.shape.center;
            const double r = glm::length(from);
            a[i] = static_cast<float>(r - atmosphere.shape.radius);
            // At the center every direction leads up.
            const double rise = r > 0 ? glm::dot(from, directions[i]) / r : 1;
            b[i] = static_cast<float>(std::clamp(rise, -1.0, 1.0));
            c[i] = static_cast<float>(distances[i]);
        }
        spherical_depth_at_altitude_batch(static_cast<float>(atmosphere.shape.radius),
                                          static_cast<float>(atmosphere.shape.scale_height), count,
                                          a.data(), b.data(), c.data(), result.data());
        for (std::size_t i = 0; i < count; ++i) add(atmosphere.colour, result[i], out[i]);
    }
}

void MediumDepths::add_blobs(std::size_t count, const glm::dvec3* origins,
                             const glm::dvec3* directions, const double* distances,
                             glm::dvec3* out) {
    const std::size_t all = blobs_.size() * count;
    auto& [scale, amplitude, rho, place, end] = columns_;
    for (std::vector<float>& column : columns_) column.resize(std::max(column.size(), all));
    for (std::size_t i = 0, k = 0; i < count; ++i) {
        const glm::vec3 direction(directions[i]);
        const float distance = static_cast<float>(distances[i]);
        for (const GaussianBlob& blob : blobs_) {
            const glm::vec3 to(blob.center - origins[i]);
            const float along = glm::dot(to, direction);
            const glm::vec3 off = to - along * direction;
            scale[k] = static_cast<float>(blob.scale);
            amplitude[k] = static_cast<float>(blob.amplitude);
            rho[k] = std::sqrt(glm::dot(off, off));
            place[k] = along;
            end[k++] = distance;
        }
    }
    gaussian_line_batch(all, scale.data(), amplitude.data(), rho.data(), place.data(), end.data(),
                        end.data());
    for (std::size_t i = 0, k = 0; i < count; ++i) {
        double sum = 0;
        for (std::size_t n = 0; n < blobs_.size(); ++n) sum += double(end[k++]);
        out[i] += sum;
    }
}

}  // namespace airlight
