// SPDX-License-Identifier: Apache-2.0
#include "viewer/view_bounds.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "viewer/camera.h"
#include "viewer/environment_sampler.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Diffuse and specular parts are 1 at most, each.
constexpr double kMostAlbedo = 2;

double distance_to_box(const SceneBox& box, const glm::dvec3& x) {
    return glm::length(glm::max(glm::max(box.min - x, x - box.max), glm::dvec3(0)));
}

double farthest_in_box(const SceneBox& box, const glm::dvec3& x) {
    return glm::length(glm::max(glm::abs(box.min - x), glm::abs(box.max - x)));
}

void include(SceneBox& box, const glm::dvec3& x) {
    box.min = glm::min(box.min, x);
    box.max = glm::max(box.max, x);
}

bool is_black(const glm::dvec3& colour) {
    return !(largest(colour) > 0);
}

// a / b where 0 / 0 is 0.
double over(double a, double b) {
    return a > 0 ? a / b : 0;
}

// The largest density of a medium in a box that may be endless; by channel.
struct MostDensity {
    const SceneBox& box;

    static glm::dvec3 times(const glm::dvec3& density, double factor) {
        glm::dvec3 result(0);
        for (int c = 0; c < 3; ++c) result[c] = density[c] > 0 ? density[c] * factor : 0;
        return result;
    }
    glm::dvec3 operator()(const SceneUniform& m) const { return m.scattering + m.absorption; }
    glm::dvec3 operator()(const SceneExponentialHeight& m) const {
        const double y = m.scale_height > 0 ? box.min.y : box.max.y;
        return times(m.density, std::exp(-y / m.scale_height));
    }
    glm::dvec3 operator()(const SceneLinearHeight& m) const {
        glm::dvec3 most(0);
        for (int c = 0; c < 3; ++c) {
            const double y = m.slope[c] > 0 ? box.max.y : box.min.y;
            most[c] = std::max(0.0, m.density[c] + (m.slope[c] == 0 ? 0 : m.slope[c] * y));
        }
        return most;
    }
    glm::dvec3 operator()(const SceneAtmosphere& m) const {
        return times(m.density,
                     std::exp((m.radius - distance_to_box(box, m.center)) / m.scale_height));
    }
    glm::dvec3 operator()(const SceneGaussians&) const { return glm::dvec3(0); }
    glm::dvec3 operator()(const SceneSlab&) const { return glm::dvec3(0); }
};

glm::dvec3 albedo_of(const SceneMedium& medium) {
    return std::visit(
        [](const auto& m) {
            using M = std::decay_t<decltype(m)>;
            if constexpr (std::is_same_v<M, SceneUniform> || std::is_same_v<M, SceneSlab>) {
                const glm::dvec3 extinction = m.scattering + m.absorption;
                glm::dvec3 albedo(0);
                for (int c = 0; c < 3; ++c) albedo[c] = over(m.scattering[c], extinction[c]);
                return albedo;
            } else {
                return m.albedo;
            }
        },
        medium.kind);
}

}  // namespace

double most_of_phase(const PhaseFunction& phase) {
    if (const PhaseTable* const table = phase.table()) {
        double most = 0;
        for (const double knot : table->knots()) most = std::max(most, table->density(knot));
        return most;
    }
    return std::max(phase.at_cosine(1), phase.at_cosine(-1));
}

ViewCone::ViewCone(const Camera& camera, int width, int height) : origin_(camera.position) {
    const glm::dmat3 axes = camera_axes(camera);
    axis_ = -axes[2];
    const glm::dvec3 corner = camera_direction(camera, axes, width, height, 0, 0);
    half_angle_ = std::atan2(glm::length(glm::cross(axis_, corner)), glm::dot(axis_, corner));
    // Pixels in units of the distance to the picture's plane.
    const double pitch = 2 * std::tan(0.5 * camera.vertical_fov) / height;
    const double cosine = std::cos(half_angle_);
    pixel_radius_ = std::sqrt(pitch * pitch * cosine * cosine * cosine / kPi);
    unevenness_ = std::exp(1.5 * std::sqrt(2.0) * pitch);
}

double ViewCone::angle_to(const glm::dvec3& point) const {
    const glm::dvec3 to = point - origin_;
    const double angle = std::atan2(glm::length(glm::cross(axis_, to)), glm::dot(axis_, to));
    return std::max(0.0, angle - half_angle_);
}

double ViewCone::distance_to(const glm::dvec3& point) const {
    const double distance = glm::length(point - origin_), angle = angle_to(point);
    return angle < 0.5 * kPi ? distance * std::sin(angle) : distance;
}

double ViewCone::glow(const glm::dvec3& point) const {
    const double distance = glm::length(point - origin_), angle = angle_to(point);
    if (angle > pixel_radius_) {
        return angle < kPi ? (kPi - angle) / (distance * std::sin(angle)) : 1 / distance;
    }
    // The mean of 1 / gamma over a disc of radius r is 2 / r, and gamma / sin(gamma) grows.
    return 2 * kPi / (distance * std::sin(std::min(pixel_radius_, 0.5 * kPi))) * unevenness_;
}

double ViewCone::glow_of_direction() const {
    return unevenness_ / (2 * std::sin(std::min(pixel_radius_, 0.5 * kPi)));
}

double ViewCone::distance_to_hull(const glm::dvec3& point,
                                  const std::vector<glm::dvec3>& others) const {
    if (half_angle_ >= 0.5 * kPi) return 0;
    const glm::dvec3 to = point - origin_;
    // A direction that no ray of view goes along: away from the cone's side next to the point, or
    // from its tip.
    glm::dvec3 normal;
    if (angle_to(point) >= 0.5 * kPi) {
        normal = glm::normalize(to);
    } else {
        const glm::dvec3 across = to - glm::dot(to, axis_) * axis_;
        if (!(glm::length(across) > 0)) return 0;
        normal = std::cos(half_angle_) * glm::normalize(across) - std::sin(half_angle_) * axis_;
    }
    double highest = 0;
    for (const glm::dvec3& other : others) {
        highest = std::max(highest, glm::dot(normal, other - origin_));
    }
    return std::max(0.0, glm::dot(normal, to) - highest);
}

double MediumBounds::total(double level, bool alone) const {
    double light = airlight_environment + surface_environment;
    for (const double lamp : airlight) light += lamp;
    for (const double lamp : surface) light += lamp;
    return std::expm1(view_depth + lamp_depth + (alone ? 0 : air_depth)) + over(light, level);
}

MediumBounds& MediumBounds::operator+=(const MediumBounds& other) {
    view_depth += other.view_depth;
    lamp_depth += other.lamp_depth;
    air_depth += other.air_depth;
    airlight_environment += other.airlight_environment;
    surface_environment += other.surface_environment;
    airlight.resize(std::max(airlight.size(), other.airlight.size()));
    surface.resize(std::max(surface.size(), other.surface.size()));
    for (std::size_t i = 0; i < other.airlight.size(); ++i) airlight[i] += other.airlight[i];
    for (std::size_t i = 0; i < other.surface.size(); ++i) surface[i] += other.surface[i];
    return *this;
}

ViewBounds::ViewBounds(const World& world, int width, int height)
    : world_(world), cone_(world.scene().camera, width, height) {
    const Scene& scene = world.scene();
    const glm::dvec3& camera = scene.camera.position;
    seen_ = {camera, camera};
    SceneBox surfaces{glm::dvec3(kInfinite), glm::dvec3(-kInfinite)};
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        include(surfaces, world.box(i).min);
        include(surfaces, world.box(i).max);
        most_reflected_ = std::max(most_reflected_, most_reflected(world.material(i)));
    }
    const bool surfaces_there = !scene.objects.empty();
    if (surfaces_there) {
        include(seen_, surfaces.min);
        include(seen_, surfaces.max);
        longest_view_ = farthest_in_box(surfaces, camera);
    }
    for (const PointLight& light : scene.lights) {
        lamps_.push_back(light.position);
        include(seen_, light.position);
        double least = kInfinite;
        for (std::size_t i = 0; i < scene.objects.size(); ++i) {
            least = std::min(least, distance_to_box(world.box(i), light.position));
        }
        lamp_to_surface_.push_back(least);
        if (surfaces_there) {
            longest_lamp_ = std::max(longest_lamp_, farthest_in_box(surfaces, light.position));
        }
    }
    along_rays_ = {glm::dvec3(-kInfinite), glm::dvec3(kInfinite)};
    if (!scene.environment) return;
    reach_ = scene.environment->distance;
    map_brightest_ = world.sampler()->brightest();
    map_power_ = world.sampler()->power();
    longest_view_ = std::max(longest_view_, reach_);
    longest_lamp_ = std::max(longest_lamp_, reach_);
    seen_.min -= reach_;
    seen_.max += reach_;
    along_rays_ = seen_;
}

// What of a box a medium may fill.
std::optional<SceneBox> ViewBounds::region(const SceneMedium& medium, const SceneBox& box) const {
    if (!medium.bounds) return box;
    const SceneBox common{glm::max(box.min, medium.bounds->min),
                          glm::min(box.max, medium.bounds->max)};
    if (common.min.x > common.max.x || common.min.y > common.max.y || common.min.z > common.max.z) {
        return {};
    }
    return common;
}

// Of a medium that scatters no more than that anywhere.
void ViewBounds::add_lamps(const glm::dvec3& scattering, double phase,
                           const std::optional<SceneBox>& within, MediumBounds& bounds) const {
    const auto& lights = world_.scene().lights;
    bounds.airlight.assign(lights.size(), 0);
    bounds.surface.assign(lights.size(), 0);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const double sent = largest(scattering * lights[i].intensity) * phase;
        if (!(sent > 0)) continue;
        double glow = cone_.glow(lamps_[i]);
        if (within) {
            const double away = distance_to_box(*within, lamps_[i]);
            glow = std::min(glow, glm::length(within->max - within->min) / (away * away));
        }
        bounds.airlight[i] = sent * glow;
        // int over all directions of int dt / d^2 from a point at distance D is pi^3 / D.
        if (most_reflected_ > 0) {
            bounds.surface[i] = sent * most_reflected_ * kPi * kPi * kPi / lamp_to_surface_[i];
        }
    }
}

MediumBounds ViewBounds::of_medium(const SceneMedium& medium) const {
    MediumBounds bounds;
    if (const auto* gaussians = std::get_if<SceneGaussians>(&medium.kind)) {
        for (const GaussianBlob& blob : gaussians->blobs) {
            bounds += of_blob(*gaussians, medium.phase, blob);
        }
        return bounds;
    }
    const double phase = most_of_phase(phase_of(medium.phase));
    const std::optional<SceneBox> lit = region(medium, along_rays_);
    if (lit) {
        const glm::dvec3 density = std::visit(MostDensity{*lit}, medium.kind);
        add_lamps(albedo_of(medium) * density, phase,
                  medium.bounds ? medium.bounds : std::optional<SceneBox>(), bounds);
        const double length = glm::length(lit->max - lit->min);
        if (largest(density) > 0) bounds.air_depth = 2 * largest(density) * length;
    }
    if (const std::optional<SceneBox> dims = region(medium, seen_)) {
        const double density = largest(std::visit(MostDensity{*dims}, medium.kind));
        const double chord = medium.bounds ? glm::length(dims->max - dims->min) : kInfinite;
        if (density > 0) {
            bounds.view_depth = density * std::min(chord, longest_view_);
            bounds.lamp_depth = density * std::min(chord, longest_lamp_);
        }
    }
    if (reach_ > 0 && !is_black(albedo_of(medium))) {
        // The point spread function is under T (pi - gamma) / (4 pi sin gamma) for isotropic media;
        // over all directions that is T pi^2 / 4. Media without it send no more than they take.
        const double whole = map_brightest_ * kPi * kPi / 4;
        const double pixel = std::min(whole, map_power_ * cone_.glow_of_direction());
        const double sent = 4 * kPi * phase;
        bounds.airlight_environment = sent * bounds.view_depth * std::max(pixel, map_brightest_);
        if (most_reflected_ > 0) {
            bounds.surface_environment = sent * bounds.lamp_depth * kMostAlbedo * whole;
        }
    }
    return bounds;
}

MediumBounds ViewBounds::of_blob(const SceneGaussians& medium, const ScenePhase& phase_function,
                                 const GaussianBlob& blob) const {
    MediumBounds bounds;
    const auto& lights = world_.scene().lights;
    bounds.airlight.assign(lights.size(), 0);
    bounds.surface.assign(lights.size(), 0);
    if (!(blob.amplitude > 0)) return bounds;
    const double a = blob.scale, c = blob.amplitude;
    const double through = c * std::sqrt(kPi) / a;
    const auto depth_at = [&](double distance) {
        return through * std::exp(-a * a * distance * distance);
    };
    bounds.view_depth = depth_at(cone_.distance_to(blob.center));
    bounds.lamp_depth =
        reach_ > 0 ? through : depth_at(cone_.distance_to_hull(blob.center, lamps_));
    bounds.air_depth = bounds.view_depth + bounds.lamp_depth;
    const double phase = most_of_phase(phase_of(phase_function));
    const double mass = through * kPi / (a * a);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const double sent = largest(medium.albedo * lights[i].intensity) * phase;
        if (!(sent > 0)) continue;
        // Up to half way from the lamp to the blob the density is small, beyond it 1 / d^2 is.
        const double half = 0.5 * glm::length(blob.center - lamps_[i]);
        const double near = c * std::exp(-a * a * half * half);
        const double glow = cone_.glow(lamps_[i]);
        const double off_ray = cone_.distance_to(lamps_[i]);
        bounds.airlight[i] =
            sent * std::min({c * glow, near * glow + over(bounds.view_depth, half * half),
                             over(bounds.view_depth, off_ray * off_ray)});
        if (!(most_reflected_ > 0)) continue;
        const double whole = kPi * kPi * kPi / lamp_to_surface_[i];
        // Likewise from the surfaces to the blob.
        double half_away = kInfinite;
        for (std::size_t k = 0; k < world_.scene().objects.size(); ++k) {
            half_away = std::min(half_away, 0.5 * distance_to_box(world_.box(k), blob.center));
        }
        const double near_surface = c * std::exp(-a * a * half_away * half_away);
        bounds.surface[i] =
            sent * most_reflected_ *
            std::min(c * whole, (near + near_surface) * whole +
                                    over(mass, half * half * half_away * half_away));
    }
    if (reach_ > 0) {
        bounds.airlight_environment =
            largest(medium.albedo) * 4 * kPi * phase * bounds.view_depth * map_brightest_;
    }
    return bounds;
}

}  // namespace airlight
