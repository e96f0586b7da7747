// SPDX-License-Identifier: Apache-2.0
// The light of point lights that media scatter along a ray.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "medium/phase_airlight.h"
#include "viewer/line_quadrature.h"
#include "viewer/ray_nodes.h"
#include "viewer/reference.h"

namespace airlight {
// sum_m sigma_s,m p_m at a point, for light that travels along `incoming`.
glm::dvec3 ReferenceRenderer::scattered(const glm::dvec3& x, const glm::dvec3& incoming,
                                        const glm::dvec3& outgoing, MediumExtent extent) const {
    const double cosine = std::clamp(glm::dot(incoming, outgoing), -1.0, 1.0);
    glm::dvec3 sum(0);
    for (const MediumPart& part : world_.media().parts()) {
        if (!part.is_of(extent)) continue;
        sum += part.albedo() * part.density(x) * part.phase().at_cosine(cosine);
    }
    return sum;
}

// Each part as seen from its own beginning, where nothing cancels.
glm::dvec3 ReferenceRenderer::airlight_of_uniform(const PointLight& light, double foot,
                                                  double height,
                                                  const std::vector<RayInterval>& lit) const {
    const glm::dvec3 extinction = *world_.media().everywhere();
    const bool grey = extinction.x == extinction.y && extinction.x == extinction.z;
    glm::dvec3 sum(0);
    for (const MediumPart& part : world_.media().parts()) {
        glm::dvec3 integral(0);
        for (int c = 0; c < (grey ? 1 : 3); ++c) {
            const double sigma = extinction[c];
            if (!(sigma > 0)) continue;
            for (const RayInterval& piece : lit) {
                const double gamma = std::atan2(height, foot - piece.begin);
                const double distance = std::hypot(height, foot - piece.begin);
                integral[c] += sigma * std::exp(-sigma * piece.begin) *
                               airlight(gamma, sigma * distance, sigma * (piece.end - piece.begin),
                                        part.phase());
            }
        }
        if (grey) integral = glm::dvec3(integral.x);
        sum += part.albedo() * *part.everywhere() * integral;
    }
    return light.intensity * sum;
}

// With s = t - foot the distance along the ray from its point next to the light, at the height h
// above it, and s = h tan u: dt / (s^2 + h^2) = du / h.
glm::dvec3 ReferenceRenderer::airlight_of(std::size_t lamp, Scatterers which,
                                          const glm::dvec3& origin, const glm::dvec3& direction,
                                          double distance, double absolute,
                                          ReferenceCounts& counts) const {
    const PointLight& light = world_.scene().lights[lamp];
    const SceneMedia& media = world_.media();
    const double intensity = largest(light.intensity);
    if (!(intensity > 0 && distance > 0)) return glm::dvec3(0);
    ++counts.airlights;
    const bool by_parts = options_.airlight == RayAirlight::parts;
    const double foot = glm::dot(light.position - origin, direction);
    const glm::dvec3 across = light.position - origin - foot * direction;
    const double height = std::max(glm::length(across), kLeastHeight * (1 + std::abs(foot)));
    std::vector<RayInterval> lit = {{0, distance}};
    const bool shaded = options_.shadows_in_media && plan_.lights[lamp].shafts;
    if (by_parts && shaded && world_.shadows()) {
        world_.shadows()->lit(light.position, origin, direction, distance, lit);
    }
    const SceneSlabs& slabs = world_.slabs();
    if (by_parts && !plan_.everything && media.everywhere() && slabs.empty())
        return airlight_of_uniform(light, foot, height, lit);

    LineQuadratureOptions quadrature;
    quadrature.relative = options_.quadrature;
    quadrature.absolute = absolute * height / intensity;
    std::vector<double> breaks =
        media.marks(origin, direction, distance, &light.position,
                    options_.quadrature < 1e-3 ? SceneMedia::kFineMarks : SceneMedia::kWideMarks);
    // Beside a lamp that the ray passes closely most of the ray is a sliver of the angle.
    std::vector<double> places = {foot};
    const double last_mark = breaks.size() > 2 ? breaks[breaks.size() - 2] : 0;
    for (double step = 8 * height; step < std::abs(last_mark - foot); step *= 8) {
        places.push_back(foot - step);
        places.push_back(foot + step);
    }
    for (const double t : places) {
        if (t > 0 && t < distance)
            breaks.insert(std::upper_bound(breaks.begin(), breaks.end(), t), t);
    }
    const auto angle_at = [&](double t) { return std::atan((t - foot) / height); };
    std::vector<LinePanel> panels;
    for (const RayInterval& part : lit) {
        double begin = angle_at(part.begin);
        for (const double t : breaks) {
            if (!(t > part.begin && t < part.end)) continue;
            const double end = angle_at(t);
            panels.push_back({begin, end});
            begin = end;
        }
        panels.push_back({begin, angle_at(part.end)});
    }
    const auto integrand = [&](std::size_t count, const double* angles, glm::dvec3* values) {
        // Those of the points that send light, and the ways to them and on to the lamp.
        std::size_t points = 0, index[kPanelPoints];
        glm::dvec3 from[2 * kPanelPoints], towards[2 * kPanelPoints], depth[2 * kPanelPoints];
        double length[2 * kPanelPoints];
        for (std::size_t i = 0; i < count; ++i) {
            values[i] = glm::dvec3(0);
            const double t = foot + height * std::tan(angles[i]);
            if (!(t > 0 && t < distance)) continue;
            ++counts.line_points;
            const glm::dvec3 x = origin + t * direction;
            const glm::dvec3 to_light = light.position - x;
            const double r = glm::length(to_light);
            if (!(r > 0)) continue;
            const double cosine = std::clamp(glm::dot(to_light / r, direction), -1.0, 1.0);
            for (const MediumPart& part : media.parts()) {
                if (part.is_gaussian() != (which == Scatterers::gaussians)) continue;
                values[i] += part.albedo() * part.density(x) * part.phase().at_cosine(cosine);
            }
            if (!(largest(values[i]) > 0)) continue;
            if (!by_parts && shaded && !sees(x, light.position, counts)) {
                values[i] = glm::dvec3(0);
                continue;
            }
            index[points] = i;
            from[points] = origin;
            towards[points] = direction;
            length[points] = t;
            from[kPanelPoints + points] = x;
            towards[kPanelPoints + points] = to_light / r;
            length[kPanelPoints + points] = r;
            ++points;
        }
        if (!attenuates()) return;
        counts.attenuations += points;
        depths(points, from, towards, length, depth);
        depths(points, from + kPanelPoints, towards + kPanelPoints, length + kPanelPoints,
               depth + kPanelPoints);
        for (std::size_t k = 0; k < points; ++k) {
            const std::size_t on = kPanelPoints + k;
            const glm::dvec3 left = transmittance_of(
                depth[k] + depth[on] + slabs.depth(from[on], towards[on], length[on]));
            // Deep under an exponential layer the density is infinite.
            glm::dvec3& value = values[index[k]];
            value = largest(left) > 0 ? value * left : glm::dvec3(0);
        }
    };
    return light.intensity / height * integrate_panels(integrand, panels, quadrature).value;
}

glm::dvec3 ReferenceRenderer::airlight_of_lights(const glm::dvec3& origin,
                                                 const glm::dvec3& direction, double distance,
                                                 ReferenceCounts& counts, double absolute) const {
    glm::dvec3 sum(0);
    if (world_.media().empty()) return sum;
    RayPath path;
    path.pieces.push_back({origin, direction, distance, nullptr, glm::dvec3(1)});
    for (std::size_t lamp = 0; lamp < world_.scene().lights.size(); ++lamp) {
        const LampAirlight light = airlight_along(
            lamp, {}, path, std::max(absolute, options_.quadrature * largest(sum)), counts);
        sum += light.gaussians + light.others;
    }
    return sum;
}

}  // namespace airlight
