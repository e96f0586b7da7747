// SPDX-License-Identifier: Apache-2.0
// Between which places of a ray the light that media send along it is smooth.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

#include "viewer/scene_media.h"

namespace airlight {
namespace {

using Mark = MediumPart::Mark;

// In units of a Gaussian's 1 / scale; of wide marks the ends alone.
constexpr double kMarkSteps[] = {-3, -1, 1, 3};
constexpr double kDenseRadius = 6;  // beyond, it is under e^-36 of itself
constexpr double kOpaque = 4;       // logarithm of a depth
constexpr double kFarLayer = 8;     // steps from the ray's beginning reach nearer layers

bool is_wide(const MarkSpacing& spacing) {
    return spacing.gaussians > 1;
}

// Of one shape whose density is `colour` times as much, between two places of a ray.
struct Marker {
    const glm::dvec3 &origin, &direction;
    const glm::dvec3* lamp;
    const MarkSpacing& spacing;
    double colour, begin, end;
    std::vector<Mark>& marks;

    void add(double at, double width = 0) const {
        if (at > begin && at < end) marks.push_back({at, width});
    }
    // In steps from less than a scale height to many: the layer may be thin beside the distance to
    // a lamp.
    void around(double at, double height) const {
        add(at);
        for (double step = height / 4; height > 0 && step < 5000 * height;
             step *= is_wide(spacing) ? 16 : 4) {
            add(at - step);
            add(at + step);
        }
    }
    // From where a density begins that hides what lies some free paths behind. A lamp that is not
    // many of them away varies as fast itself.
    void behind(double at, double free_path) const {
        if (lamp && glm::length(*lamp - origin - at * direction) < 30 * free_path) return;
        for (const double paths : {3, 30, 300}) add(at + paths * free_path);
    }

    void operator()(const UniformDensity& m) const {
        if (m.density * colour > 0) behind(begin, 1 / (m.density * colour));
    }
    void operator()(const LinearHeightDensity& m) const {
        const double slope = colour * m.slope * direction.y;
        const double here = colour * (m.slope * (origin.y + begin * direction.y) + m.density);
        if (here > 0) behind(begin, 1 / here);
        if (slope == 0) return;
        // Beyond its border the depth is slope s^2 / 2.
        const double border = begin - here / slope;
        add(border);
        if (slope > 0 && border > begin) behind(border, std::sqrt(2 / slope));
    }
    // Where the ray is deepest, and where what lies before begins to hide what follows.
    void operator()(const ExponentialHeightDensity& m) const {
        const double height = std::abs(m.scale_height);
        around(begin, height);
        const double down = m.scale_height < 0 ? direction.y : -direction.y;
        if (!(down > 0)) return;
        const double y = m.scale_height < 0 ? -origin.y : origin.y;
        const double hides = height * std::log(colour * m.density * height / down);
        const double at = std::min((y - hides) / down, end);
        if (at - begin > kFarLayer * height / down) around(at, height / down);
    }
    void operator()(const SphericalExponentialDensity& m) const {
        const double height = m.scale_height;
        const double middle = glm::dot(m.center - origin, direction);
        around(std::max(begin, middle), height);
        const double r = glm::length(m.center - origin - middle * direction);
        const double hides = m.radius + height * std::log(colour * m.density * height);
        if (!(r < hides && middle > begin)) return;
        const double half = std::sqrt((hides - r) * (hides + r));
        const double width = std::min(height * hides / half, std::sqrt(height * hides));
        const double at = std::min(middle - half, end);
        if (at - begin > kFarLayer * width) around(at, width);
    }
    void operator()(const GaussianBlob& blob) const {
        const GaussianPass pass = gaussian_pass(blob.center, origin, direction);
        const double off = blob.scale * pass.rho_perp;
        if (!(off < kDenseRadius)) return;
        for (const double step : kMarkSteps) {
            if (is_wide(spacing) && std::abs(step) < 3) continue;
            add(pass.m_proj + step / blob.scale, spacing.gaussians / blob.scale);
        }
        // What is so dense is seen down to where its depth is 1, and no farther.
        const double square = std::log(blob.amplitude / blob.scale) - off * off;
        if (!(square > kOpaque)) return;
        const double edge = std::sqrt(square);
        for (const double step : {edge - 0.5, edge + 1}) add(pass.m_proj - step / blob.scale);
        const double here = blob.scale * std::hypot(pass.rho_perp, pass.m_proj - begin);
        if (here < edge) behind(begin, 1 / blob.amplitude);
    }
};

}  // namespace

void MediumPart::mark(const glm::dvec3& origin, const glm::dvec3& direction, double distance,
                      const glm::dvec3* lamp, const MarkSpacing& spacing,
                      std::vector<Mark>& marks) const {
    RaySpan span{0, distance};
    if (bounds_) {
        const auto within = clip_to_box(*bounds_, origin, direction, distance);
        if (!within) return;
        span = *within;
        for (const double at : {span.near, span.far}) {
            if (at > 0 && at < distance) marks.push_back({at, 0});
        }
    }
    const Marker marker{origin,           direction, lamp,     spacing,
                        largest(colour_), span.near, span.far, marks};
    if (tree_) {
        for (const std::uint32_t i : tree_->along(origin, direction, distance, spacing.faintest)) {
            marker(tree_->blobs()[i]);
        }
        return;
    }
    for (const DensityField& shape : shapes_) {
        for (const Density& density : shape.parts) std::visit(marker, density);
    }
}

// In the plane of ray and lamp, x along the ray from its point next to the lamp and y towards the
// lamp, which is at (0, h): what is at (x, y) shades the ray at x h / (h - y).
void MediumPart::mark_shadows(const glm::dvec3& lamp, const glm::dvec3& origin,
                              const glm::dvec3& direction, double distance,
                              const MarkSpacing& spacing, std::vector<Mark>& marks) const {
    if (!gaussian_) return;
    const double foot = glm::dot(lamp - origin, direction);
    const glm::dvec3 across = lamp - origin - foot * direction;
    const double height = glm::length(across);
    if (!(height > 0)) return;
    const glm::dvec3 up = across / height, normal = glm::cross(direction, up);
    const auto mark_blob = [&](const GaussianBlob& blob) {
        const glm::dvec3 to = blob.center - origin;
        if (!(blob.scale * std::abs(glm::dot(normal, to)) < kDenseRadius)) return;
        const double below = height - glm::dot(up, to);
        if (!(below > 0 && below < height + kDenseRadius / blob.scale)) return;
        const double stretch = height / below;
        const double at = foot + (glm::dot(direction, to) - foot) * stretch;
        for (const double step : kMarkSteps) {
            if (is_wide(spacing) && std::abs(step) < 3) continue;
            const double t = at + step * stretch / blob.scale;
            if (t > 0 && t < distance) {
                marks.push_back({t, spacing.gaussians * stretch / blob.scale});
            }
        }
    };
    if (tree_) {
        AirlightRay ray;
        ray.viewer = origin;
        ray.light = lamp;
        ray.direction = direction;
        ray.dist = distance;
        for (const std::uint32_t i : tree_->around(ray, spacing.faintest)) {
            mark_blob(tree_->blobs()[i]);
        }
        return;
    }
    for (const Density& density : shapes_[0].parts) {
        if (const auto* blob = std::get_if<GaussianBlob>(&density)) mark_blob(*blob);
    }
}

std::vector<double> SceneMedia::marks(const glm::dvec3& origin, const glm::dvec3& direction,
                                      double distance, const glm::dvec3* lamp,
                                      const MarkSpacing& spacing) const {
    std::vector<Mark> all;
    for (const MediumPart& part : parts_) {
        part.mark(origin, direction, distance, lamp, spacing, all);
        if (lamp) part.mark_shadows(*lamp, origin, direction, distance, spacing, all);
    }
    std::sort(all.begin(), all.end(), [](const Mark& a, const Mark& b) {
        return a.at != b.at ? a.at < b.at : a.width < b.width;
    });
    // The last of a crowd stays: what follows it may be a long way through nothing.
    std::vector<double> marks = {0};
    for (auto mark = all.begin(); mark != all.end(); ++mark) {
        const auto next = std::next(mark);
        const bool crowded = next != all.end() && next->at - mark->at <= mark->width;
        if (mark->at - marks.back() > (crowded ? mark->width : 0)) marks.push_back(mark->at);
    }
    marks.push_back(distance);
    return marks;
}

}  // namespace airlight
