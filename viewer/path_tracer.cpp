// SPDX-License-Identifier: Apache-2.0
#include "viewer/path_tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "core/error.h"
#include "viewer/environment_sampler.h"
#include "viewer/material.h"
#include "viewer/media_sampling.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kSurePoints = 8;
constexpr std::size_t kAllLamps = 8;
constexpr int kChosenLamps = 4;

struct ChosenLamp {
    const PointLight* light;
    double weight;  ///< one over how many times it is chosen on average
};

}  // namespace

/// What is known of a path at its last point, from which a ray goes on.
struct PathTracer::Path {
    glm::dvec3 origin, direction;
    glm::dvec3 throughput{1}, sum{0};
    double pdf = kInfinite;  ///< of the direction [1/sr]; the eye's is not drawn
    double alive = 1;        ///< probability that the path came here, of all roulettes
    int points = 0, surfaces = 0;
    bool last = false;  ///< its ray has no more points: it sees the map or nothing
    MediaPoint collision{}, probe{};
    std::vector<ChosenLamp> lamps{};
    std::vector<double> chances{};

    // All that the eye's own ray and its end see. Later some of many, half of them evenly, half by
    // what they would send to x were nothing in between.
    void choose_lamps(const std::vector<PointLight>& lights, const glm::dvec3& x,
                      SampleStream& stream) {
        lamps.clear();
        if (points == 0 || lights.size() <= kAllLamps) {
            for (const PointLight& light : lights) lamps.push_back({&light, 1});
            return;
        }
        chances.clear();
        double total = 0;
        for (const PointLight& light : lights) {
            const glm::dvec3 way = light.position - x;
            chances.push_back(largest(light.intensity) / (glm::dot(way, way) + 1e-6));
            total += chances.back();
        }
        const double even = 1 / static_cast<double>(lights.size()), shift = stream.next();
        double below = 0;
        int chosen = 0;
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const double chance = total > 0 ? 0.5 * (even + chances[i] / total) : even;
            below += chance;
            for (; chosen < kChosenLamps && (chosen + shift) / kChosenLamps < below; ++chosen) {
                lamps.push_back({&lights[i], 1 / (kChosenLamps * chance)});
            }
        }
    }

    void turn(const glm::dvec3& x, const glm::dvec3& to, double density, const glm::dvec3& weight) {
        origin = x;
        direction = to;
        pdf = density;
        throughput *= weight;
        ++points;
    }

    /// Whether it goes on; the numbers of all paths that do stand for those that do not.
    bool survives(SampleStream& stream) {
        const double carried = largest(throughput) * alive;
        const double wanted = std::min(1.0, carried) * std::min(1.0, kSurePoints / points);
        if (!(wanted > 0)) return false;
        if (!(wanted < alive)) return true;
        const double chance = wanted / alive;
        if (!(stream.next() < chance)) return false;
        throughput /= chance;
        alive = wanted;
        return true;
    }
};

PathTracer::PathTracer(const World& world, const PathTracerOptions& options)
    : world_(world), options_(options) {
    if (options.max_bounces < 1 || options.max_bounces > kLargestPathBounces) {
        throw Error(ErrorCode::usage, fmt::format("the bounces of a path must be 1 to {}, got {}",
                                                  kLargestPathBounces, options.max_bounces));
    }
    if (!world.slabs().empty()) {
        throw Error(ErrorCode::usage,
                    "--scattering multiple does not follow light through slabs; leave them out or "
                    "use single",
                    world.scene().path);
    }
}

// The map lies behind as many metres of media as the scene says, from wherever a ray begins.
double PathTracer::end_of_ray(const std::optional<WorldHit>& hit) const {
    if (hit) return hit->distance;
    const auto& environment = world_.scene().environment;
    return environment ? environment->distance : kInfinite;
}

glm::dvec3 PathTracer::map_from(const glm::dvec3& x, const glm::dvec3& direction,
                                ReferenceCounts& counts) const {
    ++counts.rays;
    if (world_.trace(x, direction, kInfinite)) return glm::dvec3(0);
    return world_.media().transmittance(x, direction, end_of_ray({}));
}

// Irradiance across the beam.
glm::dvec3 PathTracer::lamp_at(const PointLight& light, const glm::dvec3& x,
                               const glm::dvec3& to_lamp, double distance,
                               ReferenceCounts& counts) const {
    ++counts.rays;
    if (world_.is_blocked(x, light.position)) return glm::dvec3(0);
    return light.intensity * world_.media().transmittance(x, to_lamp, distance) /
           (distance * distance);
}

// What the lamps send into the ray by its media, from the point where the path collides, if it
// does, and from one for each lamp.
void PathTracer::lamps_in_media(Path& path, double end, double collision, SampleStream& stream,
                                ReferenceCounts& counts) const {
    const SceneMedia& media = world_.media();
    const ColourPaths colours(path.throughput);
    path.choose_lamps(world_.scene().lights, path.origin, stream);
    const auto add = [&](const ChosenLamp& lamp, const EquiangularPaths& even, double t,
                         const MediaPoint& point, const glm::dvec3& transmittance) {
        const PointLight& light = *lamp.light;
        const glm::dvec3 x = path.origin + t * path.direction, way = light.position - x;
        const double length = glm::length(way), distance = std::max(length, even.height());
        const double pdf = even.pdf(t) + colours.pdf(point.extinction(), transmittance);
        if (!(length > 0 && pdf > 0)) return;
        const glm::dvec3 to_lamp = way / length;
        const double cosine = std::clamp(glm::dot(to_lamp, path.direction), -1.0, 1.0);
        const glm::dvec3 sent = point.sent_at_cosine(cosine) * transmittance * (lamp.weight / pdf);
        ++counts.line_points;
        if (!(largest(sent) > 0)) return;
        path.sum += path.throughput * sent * lamp_at(light, x, to_lamp, distance, counts);
    };
    const bool collides = collision < end;
    glm::dvec3 left(0);
    if (collides) left = media.transmittance(path.origin, path.direction, collision);
    for (const ChosenLamp& lamp : path.lamps) {
        const EquiangularPaths even(lamp.light->position, path.origin, path.direction, end);
        const double t = even.distance(stream.next());
        if (t < end) {
            path.probe.move_to(media, path.origin + t * path.direction);
            add(lamp, even, t, path.probe, media.transmittance(path.origin, path.direction, t));
        }
        if (collides) add(lamp, even, collision, path.collision, left);
    }
}

bool PathTracer::scatter(Path& path, double distance, SampleStream& stream,
                         ReferenceCounts& counts) const {
    const SceneMedia& media = world_.media();
    MediaPoint& point = path.collision;
    const glm::dvec3 x = path.origin + distance * path.direction;
    const glm::dvec3 left = media.transmittance(path.origin, path.direction, distance);
    const double pdf = ColourPaths(path.throughput).pdf(point.extinction(), left);
    if (!(pdf > 0)) return false;
    path.throughput *= left / pdf;
    point.weigh(path.throughput);
    if (!point.scatters()) return false;
    if (const EnvironmentSampler* const sampler = world_.sampler()) {
        const double choice_x = stream.next(), choice_y = stream.next();
        const EnvironmentSample light = sampler->sample(choice_x, choice_y);
        if (light.pdf > 0) {
            const double cosine = std::clamp(glm::dot(light.direction, path.direction), -1.0, 1.0);
            const double both = light.pdf + point.pdf_at_cosine(cosine);
            path.sum += path.throughput * point.sent_at_cosine(cosine) * light.radiance / both *
                        map_from(x, light.direction, counts);
        }
    }
    const double xi = stream.next(), azimuth = 2 * kPi * stream.next(), choice = stream.next();
    const double angle = point.sample_angle(choice, xi);
    const double density = point.pdf_at_angle(angle);
    if (!(density > 0)) return false;
    path.turn(x, turned(path.direction, angle, azimuth), density,
              point.sent_at_angle(angle) / density);
    path.last = options_.single;
    return true;
}

bool PathTracer::reflect_at(Path& path, const WorldHit& hit, SampleStream& stream,
                            ReferenceCounts& counts) const {
    const SurfaceMaterial& material = world_.material(hit.object);
    const glm::dvec3 to_viewer = -path.direction, from = world_.lifted(hit);
    const auto sent = [&](const glm::dvec3& direction) {
        return glm::dot(direction, hit.face) > 0
                   ? reflect(material, hit.normal, to_viewer, direction)
                   : glm::dvec3(0);
    };
    path.choose_lamps(world_.scene().lights, from, stream);
    for (const auto& [lamp, weight] : path.lamps) {
        const PointLight& light = *lamp;
        const glm::dvec3 way = light.position - from;
        const double distance = glm::length(way);
        const glm::dvec3 f = sent(way / distance);
        if (!(largest(f) > 0)) continue;
        path.sum +=
            path.throughput * f * weight * lamp_at(light, from, way / distance, distance, counts);
    }
    if (const EnvironmentSampler* const sampler = world_.sampler()) {
        const double choice_x = stream.next(), choice_y = stream.next();
        const EnvironmentSample light = sampler->sample(choice_x, choice_y);
        const glm::dvec3 f = light.pdf > 0 ? sent(light.direction) : glm::dvec3(0);
        if (largest(f) > 0) {
            const double both =
                light.pdf + lobe_pdf(material, hit.normal, to_viewer, light.direction);
            path.sum += path.throughput * f * light.radiance / both *
                        map_from(from, light.direction, counts);
        }
    }
    const LobeSample lobe = sample_lobe(material, hit.normal, to_viewer, stream);
    const glm::dvec3 f = sent(lobe.direction);
    if (!(lobe.pdf > 0 && largest(f) > 0)) return false;
    path.turn(from, lobe.direction, lobe.pdf, f / lobe.pdf);
    ++path.surfaces;
    return true;
}

glm::dvec3 PathTracer::radiance(const glm::dvec3& origin, const glm::dvec3& direction,
                                SampleStream& stream, ReferenceCounts& counts) const {
    const SceneMedia& media = world_.media();
    const EnvironmentSampler* const sampler = world_.sampler();
    Path path{origin, direction};
    while (!(path.last && !sampler)) {
        ++counts.rays;
        const std::optional<WorldHit> hit = world_.trace(path.origin, path.direction, kInfinite);
        const double end = end_of_ray(hit);
        if (path.last) {
            path.throughput *= media.transmittance(path.origin, path.direction, end);
        } else if (!media.empty()) {
            const double depth = -std::log1p(-stream.next());
            const ColourPaths colours(path.throughput);
            const double collision = distance_at_depth(media, path.origin, path.direction, end,
                                                       colours.channel(stream.next()), depth);
            if (collision < end) {
                path.collision.move_to(media, path.origin + collision * path.direction);
            }
            lamps_in_media(path, end, collision, stream, counts);
            if (collision < end) {
                if (!scatter(path, collision, stream, counts) || !path.survives(stream)) break;
                path.last = path.last || path.points >= options_.max_bounces;
                continue;
            }
            const glm::dvec3 left = media.transmittance(path.origin, path.direction, end);
            const double leaving = colours.leaving(left);
            // Where the path ends at a layer thinner than distances are told apart.
            if (!(leaving > 0)) break;
            path.throughput *= left / leaving;
        }
        if (!hit) {
            if (!sampler) break;
            // The other way to find this direction is the map's own.
            const double other = path.points > 0 ? sampler->pdf(path.direction) / path.pdf : 0;
            path.sum += path.throughput * sampler->radiance(path.direction) / (1 + other);
            break;
        }
        if (path.last || (options_.single && path.surfaces > 0)) break;
        if (!reflect_at(path, *hit, stream, counts) || !path.survives(stream)) break;
        path.last = path.points >= options_.max_bounces;
    }
    return path.sum;
}

}  // namespace airlight
