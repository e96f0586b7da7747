// SPDX-License-Identifier: Apache-2.0
#include "viewer/scene_media.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "viewer/phase_file.h"

namespace airlight {
namespace {

// Deep in a planet densities overflow, and no light times an endless density is no number. Pictures
// are in single precision.
constexpr double kDensest = 1e30;

struct PartBuilder {
    std::vector<DensityField>& shapes;
    std::shared_ptr<const GaussianTree>& tree;
    glm::dvec3& colour;
    glm::dvec3& albedo;
    double& densest;

    void add(const Density& density) { shapes.push_back({{density}}); }

    void operator()(const SceneUniform& m) {
        add(UniformDensity{1});
        colour = m.scattering + m.absorption;
        for (int c = 0; c < 3; ++c) albedo[c] = colour[c] > 0 ? m.scattering[c] / colour[c] : 0;
    }
    void operator()(const SceneGaussians& m) {
        albedo = m.albedo;
        if (m.blobs.size() > MediumPart::kFewBlobs) {
            tree = std::make_shared<GaussianTree>(m.blobs);
            for (const GaussianBlob& blob : m.blobs) densest = std::max(densest, blob.amplitude);
            return;
        }
        shapes.push_back({{m.blobs.begin(), m.blobs.end()}});
    }
    void operator()(const SceneExponentialHeight& m) {
        add(ExponentialHeightDensity{1, m.scale_height});
        colour = m.density;
        albedo = m.albedo;
    }
    void operator()(const SceneLinearHeight& m) {
        // Where it ends is another height in each channel.
        for (int c = 0; c < 3; ++c) add(LinearHeightDensity{m.slope[c], m.density[c]});
        albedo = m.albedo;
    }
    void operator()(const SceneAtmosphere& m) {
        add(SphericalExponentialDensity{m.center, m.radius, 1, m.scale_height});
        colour = m.density;
        albedo = m.albedo;
    }
    void operator()(const SceneSlab&) { assert(!"a slab is no part"); }
};

bool contains(const SceneBox& box, const glm::dvec3& x) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!(x[axis] >= box.min[axis] && x[axis] <= box.max[axis])) return false;
    }
    return true;
}

}  // namespace

PhaseFunction phase_of(const ScenePhase& phase) {
    switch (phase.type) {
        case PhaseType::isotropic:
            break;
        case PhaseType::rayleigh:
            return PhaseFunction::rayleigh();
        case PhaseType::henyey_greenstein:
            return PhaseFunction::henyey_greenstein(phase.g);
        case PhaseType::table:
            return read_phase_table(phase.file.path);
    }
    return PhaseFunction::isotropic();
}

std::optional<RaySpan> clip_to_box(const SceneBox& box, const glm::dvec3& origin,
                                   const glm::dvec3& direction, double distance) {
    double near = 0, far = distance;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) {
            if (!(origin[axis] >= box.min[axis] && origin[axis] <= box.max[axis])) return {};
            continue;
        }
        const double a = (box.min[axis] - origin[axis]) / direction[axis];
        const double b = (box.max[axis] - origin[axis]) / direction[axis];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    if (!(near < far)) return {};
    return RaySpan{near, far};
}

MediumPart::MediumPart(const SceneMedium& medium)
    : phase_(phase_of(medium.phase)), bounds_(medium.bounds) {
    std::visit(PartBuilder{shapes_, tree_, colour_, albedo_, densest_}, medium.kind);
    if (const auto* layer = std::get_if<SceneLinearHeight>(&medium.kind)) {
        linear_.emplace();
        for (int c = 0; c < 3; ++c) {
            (*linear_)[static_cast<std::size_t>(c)] = {layer->slope[c], layer->density[c]};
        }
    }
    if (const auto* gaussians = std::get_if<SceneGaussians>(&medium.kind)) {
        gaussian_ = true;
        blobs_ = gaussians->blobs;
    }
    if (!bounds_ && std::holds_alternative<SceneUniform>(medium.kind)) everywhere_ = colour_;
}

template <class OfShape>
glm::dvec3 MediumPart::by_channel(const OfShape& of_shape) const {
    glm::dvec3 result(of_shape(shapes_[0]));
    for (int c = 1; c < 3 && shapes_.size() > 1; ++c) {
        result[c] = of_shape(shapes_[static_cast<std::size_t>(c)]);
    }
    // Nothing times an endless way is nothing.
    for (int c = 0; c < 3; ++c) result[c] = colour_[c] == 0 ? 0 : result[c] * colour_[c];
    return result;
}

glm::dvec3 MediumPart::density(const glm::dvec3& x) const {
    if (everywhere_) return *everywhere_;
    if (bounds_ && !contains(*bounds_, x)) return glm::dvec3(0);
    if (tree_) {
        return glm::dvec3(tree_->density(x, kTreeDensity * densest_));
    }
    return glm::min(by_channel([&](const DensityField& shape) { return density_at(shape, x); }),
                    kDensest);
}

glm::dvec3 MediumPart::depth(const glm::dvec3& origin, const glm::dvec3& direction,
                             double distance) const {
    if (everywhere_ && std::isfinite(distance)) return *everywhere_ * distance;
    glm::dvec3 from = origin;
    if (bounds_) {
        const std::optional<RaySpan> span = clip_to_box(*bounds_, origin, direction, distance);
        if (!span) return glm::dvec3(0);
        from += span->near * direction;
        distance = span->far - span->near;
    }
    if (tree_) {
        return glm::dvec3(tree_->quick_optical_depth(from, direction, distance, kTreeDepth));
    }
    return by_channel(
        [&](const DensityField& shape) { return optical_depth(shape, from, direction, distance); });
}

SceneMedia::SceneMedia(const std::vector<SceneMedium>& media) {
    for (const SceneMedium& medium : media) {
        if (!std::holds_alternative<SceneSlab>(medium.kind)) parts_.emplace_back(medium);
    }
    everywhere_ = glm::dvec3(0);
    for (const MediumPart& part : parts_) {
        if (!part.everywhere()) {
            everywhere_.reset();
            break;
        }
        *everywhere_ += *part.everywhere();
    }
}

bool SceneMedia::any(bool gaussian) const {
    return std::any_of(parts_.begin(), parts_.end(),
                       [&](const MediumPart& part) { return part.is_gaussian() == gaussian; });
}

bool SceneMedia::has(MediumExtent extent) const {
    return std::any_of(parts_.begin(), parts_.end(),
                       [extent](const MediumPart& part) { return part.is_of(extent); });
}

glm::dvec3 SceneMedia::density(const glm::dvec3& x) const {
    glm::dvec3 sum(0);
    for (const MediumPart& part : parts_) sum += part.density(x);
    return sum;
}

glm::dvec3 SceneMedia::depth(const glm::dvec3& origin, const glm::dvec3& direction, double distance,
                             MediumExtent extent) const {
    if (everywhere_ && extent != MediumExtent::limited && std::isfinite(distance)) {
        return *everywhere_ * distance;
    }
    glm::dvec3 sum(0);
    for (const MediumPart& part : parts_) {
        if (part.is_of(extent)) sum += part.depth(origin, direction, distance);
    }
    return sum;
}

glm::dvec3 SceneMedia::transmittance(const glm::dvec3& origin, const glm::dvec3& direction,
                                     double distance) const {
    return transmittance_of(depth(origin, direction, distance));
}

glm::dvec3 transmittance_of(const glm::dvec3& depth) {
    const double first = std::exp(-depth.x);
    if (depth.y == depth.x && depth.z == depth.x) return glm::dvec3(first);
    return {first, std::exp(-depth.y), std::exp(-depth.z)};
}

}  // namespace airlight
