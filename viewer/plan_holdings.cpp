// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "viewer/material.h"
#include "viewer/plan_steps.h"

namespace airlight::detail {
namespace {

bool is_height(const SceneMedium& medium) {
    return std::holds_alternative<SceneExponentialHeight>(medium.kind) ||
           std::holds_alternative<SceneLinearHeight>(medium.kind);
}

// What is missing for light of `source` in `medium`; empty where nothing is.
std::string missing(bool medium, bool source, const char* no_medium, const char* no_source) {
    return !medium ? no_medium : !source ? no_source : "";
}
void decide_by(Plan& plan, Effect effect, const std::string& missing, std::string reason) {
    decide(plan, effect, missing.empty(), missing.empty() ? std::move(reason) : missing);
}

// The fast engine has shadows of the map from .prt files alone. Where there are both shadows
// and gloss it takes products of three, else of two.
void plan_baked_files(const World& world, Plan& plan) {
    const Scene& scene = world.scene();
    std::size_t dot = 0, triple = 0;
    for (std::size_t i = 0; i < plan.objects.size(); ++i) {
        ObjectPlan& object = plan.objects[i];
        const bool baked = scene.objects[i].prt.given();
        object.reason += baked ? "; its shadows are baked" : "; no .prt file, no shadows";
        if (!baked) continue;
        object.product = object.glossy ? SurfaceProduct::triple : SurfaceProduct::dot;
        ++(object.glossy ? triple : dot);
    }
    const std::size_t baked = dot + triple;
    const char* const none = "no object has a .prt file";
    decide(plan, Effect::shadow_prt, baked > 0,
           baked > 0 ? count_of(baked, "object has", "objects have") + " a .prt file" : none);
    decide(plan, Effect::interreflection, baked > 0,
           baked > 0 ? "as much as the .prt files hold" : none);
    decide(plan, Effect::product_dot, baked > 0,
           baked > 0 ? "transfer times light, of the diffuse parts" : none);
    decide(plan, Effect::product_triple, triple > 0,
           triple > 0 ? count_of(triple, "object has", "objects have") + " shadows and gloss"
           : dot > 0  ? "no object has both shadows and gloss"
                      : none);
}

}  // namespace

std::string count_of(std::size_t count, const char* one, const char* more) {
    return count == 1 ? fmt::format("1 {}", one) : fmt::format("{} {}", count, more);
}

SceneHoldings::SceneHoldings(const World& world, const std::vector<SceneMedium>& media_left) {
    const Scene& scene = world.scene();
    lamps = scene.lights.size();
    objects = scene.objects.size();
    map = scene.environment.has_value();
    shafts = scene.shafts.has_value();
    for (std::size_t i = 0; i < objects; ++i) glossy += is_glossy(world.material(i)) ? 1 : 0;
    for (const SceneMedium& medium : media_left) {
        if (std::holds_alternative<SceneSlab>(medium.kind)) {
            ++slabs;
            continue;
        }
        ++media;
        height += is_height(medium) ? 1 : 0;
        atmospheres += std::holds_alternative<SceneAtmosphere>(medium.kind) ? 1 : 0;
        const auto* const gaussians = std::get_if<SceneGaussians>(&medium.kind);
        if (!gaussians) continue;
        ++gaussian_media;
        blobs += gaussians->blobs.size();
    }
}

void plan_holdings(const World& world, Plan& plan) {
    const SceneHoldings has(world, plan.media);
    const bool air = has.media + has.slabs > 0;
    const std::string lamps = count_of(has.lamps, "lamp", "lamps");
    const std::string things = count_of(has.objects, "object", "objects");
    decide(plan, Effect::attenuation, air,
           air ? count_of(has.media + has.slabs, "medium dims", "media dim") + " light"
               : "the air is clear");
    decide_by(plan, Effect::airlight_point,
              missing(has.media - has.gaussian_media + has.slabs > 0, has.lamps > 0,
                      "no medium but Gaussians is there", "there are no lamps"),
              lamps + " in fog");
    decide_by(plan, Effect::airlight_gaussians,
              missing(has.blobs > 0, has.lamps > 0, "there are no Gaussians", "there are no lamps"),
              fmt::format("{} by {}", count_of(has.blobs, "Gaussian lit", "Gaussians lit"), lamps));
    decide_by(plan, Effect::airlight_environment,
              missing(air, has.map, "the air is clear", "there is no map"),
              "the map lights the media");
    decide_by(
        plan, Effect::surface_point,
        air ? missing(has.objects > 0, has.lamps > 0, "there are no objects", "there are no lamps")
            : "the air is clear",
        fmt::format("{} in the glow of {}", things, lamps));
    decide_by(plan, Effect::surface_environment,
              missing(has.objects > 0, has.map, "there are no objects", "there is no map"),
              fmt::format("{} under the map", things));
    decide_by(plan, Effect::shadow_prt,
              missing(has.objects > 0, has.map, "there are no objects", "there is no map"),
              "objects shade each other from the map");
    decide(plan, Effect::interreflection, false, "the reference passes no light between surfaces");
    decide(plan, Effect::brdf_glossy, has.glossy > 0,
           has.glossy > 0 ? fmt::format("{} of {}", has.glossy, things) : "no material mirrors");
    const char* const integrated = "the reference integrates over directions";
    decide(plan, Effect::product_dot, false, integrated);
    decide(plan, Effect::product_triple, false, integrated);
    decide(plan, Effect::density_height, has.height > 0,
           has.height > 0 ? count_of(has.height, "layer", "layers") : "there is no layer");
    decide(plan, Effect::density_atmosphere, has.atmospheres > 0,
           has.atmospheres > 0 ? count_of(has.atmospheres, "atmosphere", "atmospheres")
                               : "there is no atmosphere");
    decide(plan, Effect::slab, has.slabs > 0,
           has.slabs > 0 ? count_of(has.slabs, "slab", "slabs") : "there is no slab");
    decide_by(plan, Effect::shafts,
              air ? missing(has.objects > 0, has.lamps > 0 || has.map, "there are no objects",
                            "there is no light")
                  : "the air is clear",
              things + " may shade the air");
    decide_by(plan, Effect::particles,
              has.shafts ? missing(air, has.lamps > 0, "the air is clear", "there are no lamps")
                         : "the scene asks for none",
              "the scene asks for them");
    decide(plan, Effect::noise, false, "scenes hold no noise");
    for (std::size_t i = 0; i < plan.objects.size(); ++i) {
        ObjectPlan& object = plan.objects[i];
        object.glossy = is_glossy(world.material(i));
        object.reason = object.glossy ? "its material mirrors" : "its material is diffuse";
    }
    if (plan.engine == Engine::fast && has.map) plan_baked_files(world, plan);
    for (LampPlan& lamp : plan.lights) {
        lamp.airlight_point = plan.runs(Effect::airlight_point);
        lamp.airlight_gaussians = plan.runs(Effect::airlight_gaussians);
        lamp.surface = plan.runs(Effect::surface_point);
        lamp.shafts = plan.runs(Effect::shafts);
    }
}

}  // namespace airlight::detail
