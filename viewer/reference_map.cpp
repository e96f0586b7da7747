// SPDX-License-Identifier: Apache-2.0
// The light of the environment map that media scatter.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "viewer/environment_sampler.h"
#include "viewer/reference.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Collision {
    double t, pdf;
};

// Where on a ray: with the density of the first collision, were the depth between marks spread
// evenly; what that misses is weighed. depths[i] is that to marks[i].
Collision first_collision(const std::vector<double>& marks, const std::vector<double>& depths,
                          double xi) {
    const double all = -std::expm1(-depths.back());
    if (!(all > 0)) return {xi * marks.back(), 1 / marks.back()};
    double gone = 0;
    for (std::size_t i = 1;; ++i) {
        const double before = depths[i - 1], depth = depths[i];
        const double share = std::exp(-before) * -std::expm1(before - depth);
        if (i + 1 < marks.size() && !(xi * all < gone + share)) {
            gone += share;
            continue;
        }
        const double width = marks[i] - marks[i - 1];
        if (!(share > 0)) return {marks[i], kInfinite};
        const double left = std::clamp((xi * all - gone) / share, 0.0, 1.0);
        const double rate = (depth - before) / width;
        const double far = std::log1p(left * std::expm1(before - depth));
        const double t = marks[i - 1] + std::min(width, -far / rate);
        return {t, std::exp(-before + far) * rate / all};
    }
}

// Of the angle between two unit directions; that of a ray through its light is no less in
// airlight_of_direction.
constexpr double kLeastSine = 1e-9;

double sine_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::max(glm::length(glm::cross(a, b)), kLeastSine);
}

// A direction around another, gamma and the azimuth drawn evenly: its density is
// 1 / (2 pi^2 sin(gamma)), which falls off as glows do.
glm::dvec3 around(const glm::dvec3& axis, double x, double y) {
    glm::dvec3 right, up;
    make_axes(axis, right, up);
    const double gamma = kPi * x, azimuth = 2 * kPi * y;
    return glm::normalize(std::sin(gamma) * (std::cos(azimuth) * right + std::sin(azimuth) * up) +
                          std::cos(gamma) * axis);
}

struct Angle {
    double u, pdf;
};

// Where between two of the angles at which a light sees a ray: dt / d^2 = du / height. Fog leaves
// e^{-depth tan(pi/4 + u/2)} of the light, with its depth over `height`; the tangent is convex, so
// an exponential that falls as fast at the beginning is above it everywhere.
Angle place_by_angle(double begin, double end, double depth, double xi) {
    const double cosine = std::cos(kPi / 4 + begin / 2);
    const double rate = depth / (2 * cosine * cosine), width = end - begin;
    const double all = -std::expm1(-rate * width);
    if (!(all > 1e-9)) return {begin + xi * width, 1 / width};
    const double step = std::min(width, -std::log1p(-xi * all) / rate);
    return {begin + step, rate * std::exp(-rate * step) / all};
}

// Shifts that spread a sample's numbers evenly, any two or three of them.
constexpr double kSpread[4][3] = {
    {0, 0, 0}, {0.25, 0.75, 0.5}, {0.5, 0.5, 0.25}, {0.75, 0.25, 0.75}};

double turned(double x, double by) {
    return x + by < 1 ? x + by : x + by - 1;
}

}  // namespace

// Of the channel that has most, of what scatters light of the map from place to place.
std::vector<double> ReferenceRenderer::depths_to(const RayPiece& piece,
                                                 const std::vector<double>& places) const {
    const std::size_t count = places.size();
    const std::vector<glm::dvec3> origins(count, piece.origin), directions(count, piece.direction);
    std::vector<glm::dvec3> found(count);
    depths(count, origins.data(), directions.data(), places.data(), found.data(),
           piece.slab ? MediumExtent::any : MediumExtent::limited);
    std::vector<double> most(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (piece.slab) found[i] += piece.slab->extinction * places[i];
        most[i] = i == 0 ? 0 : std::max(most[i - 1], largest(found[i]));
    }
    return most;
}

glm::dvec3 ReferenceRenderer::airlight_of_map(const RayPiece& piece, const EnvironmentSample& light,
                                              double choice, ReferenceCounts& counts) const {
    const SceneMedia& media = world_.media();
    if (!plan_.everything && !piece.slab && !media.has_limited()) return glm::dvec3(0);
    const std::vector<double> marks = media.marks(piece.origin, piece.direction, piece.distance,
                                                  nullptr, SceneMedia::kDrawnMarks);
    const std::vector<double> to_marks = depths_to(piece, marks);
    const auto [t, pdf] = first_collision(marks, to_marks, choice);
    if (!(light.pdf > 0 && pdf > 0)) return glm::dvec3(0);
    const glm::dvec3 x = piece.origin + t * piece.direction;
    ++counts.line_points;
    glm::dvec3 depth;
    depths(1, &piece.origin, &piece.direction, &t, &depth);
    if (piece.slab) depth += piece.slab->extinction * t;
    const glm::dvec3 sent = transmittance_of(depth) * light.radiance / (light.pdf * pdf);
    if (piece.slab) {
        glm::dvec3 sum(0);
        for (const SlabArrival& way : arrivals_of_direction(*piece.slab, x, light.direction)) {
            sum += sent_in_slab(*piece.slab, x, -way.to_light, -piece.direction) *
                   map_in_slab(*piece.slab, x, way, light.direction, options_.shadows_in_media,
                               counts);
        }
        return sent * sum;
    }
    const glm::dvec3 sent_on =
        scattered(x, -light.direction, -piece.direction, MediumExtent::limited);
    if (!(largest(sent_on) > 0)) return glm::dvec3(0);
    if (options_.shadows_in_media && !sees_map(x, light.direction, counts)) return glm::dvec3(0);
    return sent * sent_on *
           straight_transmittance(x, light.direction, world_.scene().environment->distance, counts);
}

// A direction of the map is a point light at the map's distance D from where the path begins, of
// the radiant intensity D^2 L d omega.
glm::dvec3 ReferenceRenderer::airlight_of_direction(const RayPath& path, const glm::dvec3& to_map,
                                                    double choice, ReferenceCounts& counts) const {
    const SceneMedia& media = world_.media();
    const double reach = world_.scene().environment->distance;
    const bool shaded = options_.shadows_in_media && world_.triangles() > 0;
    const glm::dvec3 extinction =
        media.depth(path.pieces.front().origin, to_map, 1, MediumExtent::endless);
    const double thinnest = std::min({extinction.x, extinction.y, extinction.z});
    PointLight light;
    light.position = path.pieces.front().origin + reach * to_map;
    light.intensity = glm::dvec3(reach * reach);
    const bool ends_at_map = !path.hit && largest(path.throughput) > 0;
    glm::dvec3 sum(0);
    for (const RayPiece& piece : path.pieces) {
        if (piece.slab || !(largest(piece.throughput) > 0)) continue;
        const bool goes_on = ends_at_map && &piece == &path.pieces.back();
        const double distance = goes_on ? kInfinite : piece.distance;
        const glm::dvec3 offset = light.position - piece.origin;
        const double foot = glm::dot(offset, piece.direction);
        const double height = std::max(glm::length(glm::cross(offset, piece.direction)),
                                       kLeastSine * glm::length(offset));
        if (!shaded && media.everywhere() && world_.slabs().empty()) {
            ++counts.line_points;
            sum += piece.throughput * airlight_of_uniform(light, foot, height, {{0, distance}});
            continue;
        }
        const auto [u, pdf] =
            place_by_angle(std::atan(-foot / height), std::atan((distance - foot) / height),
                           height * thinnest, choice);
        const double t = foot + height * std::tan(u);
        if (!(t > 0 && t < distance)) continue;
        ++counts.line_points;
        const glm::dvec3 x = piece.origin + t * piece.direction;
        const glm::dvec3 to_light = light.position - x;
        const double r = glm::length(to_light);
        const glm::dvec3 sent_on =
            scattered(x, -to_light / r, -piece.direction, MediumExtent::endless);
        if (shaded && !sees(x, light.position, counts)) continue;
        glm::dvec3 sent = piece.throughput * light.intensity * sent_on / (height * pdf);
        if (attenuates()) {
            sent *= transmittance_of(media.depth(piece.origin, piece.direction, t) +
                                     straight_depth(x, to_light / r, r, counts));
        }
        sum += sent;
    }
    return sum;
}

// Two ways to draw directions of the map, each weighed by the sum of both densities: by what the
// map is and around the ray of view, where endless media glow.
glm::dvec3 ReferenceRenderer::map_along(const RayPath& path, SampleStream& stream,
                                        ReferenceCounts& counts) const {
    const EnvironmentSampler* const sampler = world_.sampler();
    if (!sampler || !in_media_) return glm::dvec3(0);
    const double x = stream.next(), y = stream.next(), choice = stream.next();
    const EnvironmentSample light = sampler->sample(x, y);
    ++counts.airlights;
    glm::dvec3 sum(0);
    for (const RayPiece& piece : path.pieces) {
        sum += piece.throughput * airlight_of_map(piece, light, choice, counts);
    }
    if (!plan_.everything && !world_.media().has_endless()) return sum;
    const double ring_x = stream.next(), ring_y = stream.next();
    if (!(light.pdf > 0)) return sum;
    const glm::dvec3& axis = path.pieces.front().direction;
    const auto ring_pdf = [&](const glm::dvec3& to_map) {
        return 1 / (2 * kPi * kPi * sine_between(axis, to_map));
    };
    glm::dvec3 glow(0);
    for (const auto& [dx, dy, dz] : kSpread) {
        const EnvironmentSample bright = sampler->sample(turned(x, dx), turned(y, dy));
        const double place = turned(choice, dz);
        glow += bright.radiance / (bright.pdf + ring_pdf(bright.direction)) *
                airlight_of_direction(path, bright.direction, place, counts);
        const glm::dvec3 beside = around(axis, turned(ring_x, dx), turned(ring_y, dy));
        const glm::dvec3 radiance = world_.environment(beside);
        if (!(largest(radiance) > 0)) continue;
        glow += radiance / (sampler->pdf(beside) + ring_pdf(beside)) *
                airlight_of_direction(path, beside, place, counts);
    }
    return sum + glow / double(std::size(kSpread));
}

// Pairs of a direction of the map and one in which the surface looks, in endless media: one of them
// drawn by what the map or the surface is, the other around it. What is 1 / sin(gamma) of the light
// that is scattered from the one to the other is in the density of both ways to draw them.
glm::dvec3 ReferenceRenderer::surface_of_scattered_map(const WorldHit& hit,
                                                       const glm::dvec3& to_viewer,
                                                       const glm::dvec3& from, SampleStream stream,
                                                       ReferenceCounts& counts) const {
    const EnvironmentSampler* const sampler = world_.sampler();
    if (!sampler || !in_media_) return glm::dvec3(0);
    const SurfaceMaterial& material = materials_[hit.object];
    const LobeSample lobe = sample_lobe(material, hit.normal, to_viewer, stream);
    const double x = stream.next(), y = stream.next(), choice = stream.next();
    const EnvironmentSample light = sampler->sample(x, y);
    const auto reflected = [&](const glm::dvec3& direction) {
        if (!(glm::dot(direction, hit.face) > 0)) return glm::dvec3(0);
        return reflect(material, hit.normal, to_viewer, direction);
    };
    const auto path_to = [&](const glm::dvec3& direction) {
        RayPath path = follow_ray(world_, from, direction, attenuates());
        counts.rays += path.rays;
        path.pieces.front().origin = hit.position;
        return path;
    };
    const bool endless = plan_.everything || world_.media().has_endless();
    glm::dvec3 sum(0);
    const double beside_x = endless ? stream.next() : 0, beside_y = endless ? stream.next() : 0;
    const glm::dvec3 f = lobe.pdf > 0 ? reflected(lobe.direction) : glm::dvec3(0);
    if (largest(f) > 0) {
        ++counts.surface_lights;
        const RayPath path = path_to(lobe.direction);
        for (const RayPiece& piece : path.pieces) {
            sum += f / lobe.pdf * piece.throughput * airlight_of_map(piece, light, choice, counts);
        }
        if (endless) {
            const glm::dvec3 to_map = around(lobe.direction, beside_x, beside_y);
            const glm::dvec3 radiance = world_.environment(to_map);
            const double weight = 2 * kPi * kPi * sine_between(lobe.direction, to_map) /
                                  (lobe.pdf + sampler->pdf(to_map));
            if (largest(radiance) > 0) {
                sum += f * radiance * weight * airlight_of_direction(path, to_map, choice, counts);
            }
        }
    }
    if (!endless) return sum;
    const double ring_x = stream.next(), ring_y = stream.next();
    if (!(light.pdf > 0)) return sum;
    const glm::dvec3 direction = around(light.direction, ring_x, ring_y);
    const glm::dvec3 beside = reflected(direction);
    if (!(largest(beside) > 0)) return sum;
    ++counts.surface_lights;
    const double weight = 2 * kPi * kPi * sine_between(direction, light.direction) /
                          (light.pdf + lobe_pdf(material, hit.normal, to_viewer, direction));
    return sum + beside * light.radiance * weight *
                     airlight_of_direction(path_to(direction), light.direction, choice, counts);
}

}  // namespace airlight
