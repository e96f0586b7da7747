// SPDX-License-Identifier: Apache-2.0
#include "viewer/plan_cost.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "viewer/camera.h"

namespace airlight {
namespace {

// Nanoseconds of CPU time on one core with AVX-512 (bench/plan_bench.cpp --shares).
constexpr double kRay = 100;            // traced, the hit interpolated
constexpr double kLampRay = 50;         // whether a lamp is seen
constexpr double kMapRay = 120;         // whether the map is
constexpr double kReflect = 20;         // a diffuse surface
constexpr double kLobe = 40;            // what a lobe takes beside it
constexpr double kClosedForm = 190;     // airlight of a lamp, one channel, isotropic
constexpr double kClosedPhase = 600;    // with any other phase function
constexpr double kLitParts = 150;       // exact borders of shadows, and for the triangles times
constexpr double kLitPerTriangle = 15;  // the root of their number
constexpr double kMapSample = 200;      // a direction drawn from the map
constexpr double kMarks = 2000;         // the places of a ray where Gaussians are dense,
constexpr double kMarkCount = 12;       // of which a depth is taken at each
constexpr double kSlab = 70000;         // refracted light of a lamp
constexpr double kParticles = 16000;    // along a ray, for a lamp

double hit_fraction(const World& world) {
    const Camera& camera = world.scene().camera;
    const glm::dmat3 axes = camera_axes(camera);
    constexpr int kWidth = 18, kHeight = 11;
    int hits = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const glm::dvec3 direction =
                camera_direction(camera, axes, kWidth, kHeight, x + 0.5, y + 0.5);
            hits += world.trace(camera.position, direction, std::numeric_limits<double>::infinity())
                        ? 1
                        : 0;
        }
    }
    return hits / double(kWidth * kHeight);
}

// Of all media: the optical depth of a way and the density of a point.
struct MediaCost {
    double depth = 0, density = 0, closed_form = 0;
    double breaks = 1;  // parts that a quadrature begins with, but for Gaussians'
    bool blobs = false, endless = false;

    explicit MediaCost(const Plan& plan) {
        const bool single = plan.single_precision();
        for (const SceneMedium& medium : plan.media) {
            if (const auto* gaussians = std::get_if<SceneGaussians>(&medium.kind)) {
                // Beyond a few, a tree finds those that a ray passes.
                const double near = std::min(double(gaussians->blobs.size()),
                                             12 * std::log2(2 + double(gaussians->blobs.size())));
                depth +=
                    single ? std::min(6 * double(gaussians->blobs.size()), 50 * near) : 50 * near;
                density += 15 * near;
                blobs = true;
            } else if (std::holds_alternative<SceneAtmosphere>(medium.kind)) {
                depth += single ? 65 : 350;
                density += 30;
                breaks += 6;
            } else if (std::holds_alternative<SceneUniform>(medium.kind)) {
                depth += 6;
                density += 4;
                endless = endless || !medium.bounds;
                const auto& uniform = std::get<SceneUniform>(medium.kind);
                const glm::dvec3 extinction = uniform.scattering + uniform.absorption;
                const bool grey = extinction.x == extinction.y && extinction.x == extinction.z;
                closed_form +=
                    (grey ? 1 : 3) *
                    (medium.phase.type == PhaseType::isotropic ? kClosedForm : kClosedPhase);
            } else if (!std::holds_alternative<SceneSlab>(medium.kind)) {
                depth += 60;
                density += 20;
                breaks += 3;
            }
        }
    }
};

}  // namespace

void estimate_costs(const World& world, Plan& plan) {
    const Scene& scene = world.scene();
    const double lamps = double(scene.lights.size());
    const double hit = scene.objects.empty() ? 0 : hit_fraction(world);
    const MediaCost media(plan);
    const double lit = kLitParts + kLitPerTriangle * std::sqrt(double(world.triangles()));
    const bool closed =
        SceneMedia(plan.media).everywhere() && !plan.everything && !plan.runs(Effect::slab);
    // Panels of 15 points; marks of Gaussians are thinned out, so that their number matters little.
    const double panels =
        (media.breaks + (media.blobs ? 3.5 : 0)) * (plan.quadrature < 1e-3 ? 1.8 : 1);
    const double integral =
        closed ? media.closed_form : 15 * panels * (2 * media.depth + media.density + 60);
    const auto count = [&](bool LampPlan::*flag) {
        return double(std::count_if(plan.lights.begin(), plan.lights.end(),
                                    [&](const LampPlan& lamp) { return lamp.*flag; }));
    };
    const double point = count(&LampPlan::airlight_point);
    const double gaussians = count(&LampPlan::airlight_gaussians);
    const double surface = count(&LampPlan::surface), shafts = count(&LampPlan::shafts);
    const double map = scene.environment ? 1 : 0;
    plan.base_cost = kRay + hit * lamps * (kLampRay + kReflect);

    const auto set = [&](Effect effect, double cost) {
        if (plan.runs(effect)) plan[effect].cost = cost;
    };
    set(Effect::attenuation, media.depth * (1 + hit * (lamps + map)));
    set(Effect::airlight_point, point * integral);
    set(Effect::airlight_gaussians, gaussians * integral);
    set(Effect::surface_point,
        hit * 0.6 * surface *
            (kRay + kReflect + (point > 0 ? integral : 0) + (gaussians > 0 ? integral : 0)));
    const double along_rays = point + gaussians > 0 ? 1 : 0, on_surfaces = surface > 0 ? 0.6 : 0;
    set(Effect::shafts, shafts * lit * (along_rays + on_surfaces * hit));
    // Endless media are looked at along eight directions of the map.
    const double map_point =
        (media.endless ? 8 : 1) * (kMapSample + kMapRay + 2 * media.depth + media.density) +
        (media.blobs ? kMarks + kMarkCount * media.depth : 0);
    set(Effect::airlight_environment, map_point);
    const bool by_media = plan.runs(Effect::airlight_environment);
    set(Effect::surface_environment,
        hit * (2 * kMapSample + 4 * kReflect + (by_media ? kRay + map_point : 0)));
    set(Effect::shadow_prt, hit * 2 * kMapRay);
    set(Effect::brdf_glossy, hit * kLobe * (lamps + 3 * map));
    set(Effect::slab, kSlab * lamps);
    set(Effect::particles, kParticles * lamps);
}

}  // namespace airlight
