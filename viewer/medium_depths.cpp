// SPDX-License-Identifier: Apache-2.0
#include "viewer/medium_depths.h"

#include <glm/geometric.hpp>

#include "medium/gaussian_line_batch.h"

namespace airlight {

MediumDepths::MediumDepths(const SceneMedia& media, MediumExtent extent) {
    for (const MediumPart& part : media.parts()) {
        if (!part.is_of(extent)) continue;
        if (part.is_gaussian() && !part.bounds() && part.blobs().size() <= kMostBlobs) {
            blobs_.insert(blobs_.end(), part.blobs().begin(), part.blobs().end());
        } else {
            parts_.push_back(&part);
        }
    }
    for (std::vector<float>* column : {&scale_, &amplitude_, &rho_, &place_, &end_}) {
        column->resize(blobs_.size());
    }
    for (std::size_t i = 0; i < blobs_.size(); ++i) {
        scale_[i] = static_cast<float>(blobs_[i].scale);
        amplitude_[i] = static_cast<float>(blobs_[i].amplitude);
    }
}

glm::dvec3 MediumDepths::operator()(const glm::dvec3& origin, const glm::dvec3& direction,
                                    double distance) {
    glm::dvec3 sum(0);
    for (const MediumPart* const part : parts_) sum += part->depth(origin, direction, distance);
    if (blobs_.empty()) return sum;
    for (std::size_t i = 0; i < blobs_.size(); ++i) {
        const glm::dvec3 to = blobs_[i].center - origin;
        const double along = glm::dot(to, direction);
        rho_[i] = static_cast<float>(glm::length(to - along * direction));
        place_[i] = static_cast<float>(along);
        end_[i] = static_cast<float>(distance);
    }
    gaussian_line_batch(blobs_.size(), scale_.data(), amplitude_.data(), rho_.data(), place_.data(),
                        end_.data(), end_.data());
    double depth = 0;
    for (const float one : end_) depth += double(one);
    return sum + depth;
}

}  // namespace airlight
