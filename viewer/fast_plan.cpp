// SPDX-License-Identifier: Apache-2.0
#include "viewer/fast_plan.h"

#include <algorithm>

#include "viewer/material.h"

namespace airlight {

Plan plan_of_everything(const World& world) {
    const Scene& scene = world.scene();
    Plan plan;
    plan.engine = Engine::fast;
    plan.tolerance = scene.tolerance;
    plan.media = scene.media;
    plan.lights.resize(scene.lights.size());
    const auto any = [&](auto kind) {
        return std::any_of(scene.media.begin(), scene.media.end(), [](const SceneMedium& medium) {
            return std::holds_alternative<decltype(kind)>(medium.kind);
        });
    };
    const bool gaussians = any(SceneGaussians()),
               height = any(SceneExponentialHeight()) || any(SceneLinearHeight());
    const bool atmosphere = any(SceneAtmosphere()), slab = any(SceneSlab());
    const bool media = !scene.media.empty(), lamps = !scene.lights.empty();
    const bool map = scene.environment.has_value(), objects = !scene.objects.empty();
    bool glossy = false, baked = false;
    for (const SceneObject& object : scene.objects) {
        ObjectPlan one;
        one.glossy = !std::holds_alternative<LambertMaterial>(object.material);
        if (map && object.prt.given()) {
            one.product = one.glossy ? SurfaceProduct::triple : SurfaceProduct::dot;
        }
        glossy = glossy || one.glossy;
        baked = baked || object.prt.given();
        plan.objects.push_back(one);
    }
    const auto set = [&](Effect effect, bool runs) { plan[effect].runs = runs; };
    set(Effect::attenuation, media);
    set(Effect::airlight_point, media && lamps);
    set(Effect::airlight_gaussians, gaussians && lamps);
    set(Effect::airlight_environment, media && map);
    set(Effect::surface_point, media && lamps && objects);
    set(Effect::surface_environment, map && objects);
    set(Effect::shadow_prt, map && baked);
    set(Effect::interreflection, map && baked);
    set(Effect::brdf_glossy, glossy);
    set(Effect::product_dot, map && baked);
    set(Effect::product_triple, map && baked && glossy);
    set(Effect::density_height, height);
    set(Effect::density_atmosphere, atmosphere);
    set(Effect::slab, slab);
    set(Effect::shafts, media && (lamps || map) && objects);
    set(Effect::particles, scene.shafts.has_value() && media && lamps);
    set(Effect::noise, false);
    return plan;
}

}  // namespace airlight
