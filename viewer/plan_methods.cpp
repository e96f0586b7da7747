// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "viewer/plan_steps.h"

namespace airlight::detail {
namespace {

constexpr double kClosedFormError = 1e-12;  // ten times that of medium/airlight.h
// Of transmittances by viewer/medium_depths.h.
constexpr double kSinglePrecisionError = 2e-5;

void name_integral(const Plan& plan, EffectChoice& c, bool closed, std::size_t lamps) {
    if (closed) {
        c.rung = "closed form";
        c.bound += kClosedFormError;
        return;
    }
    c.rung = fmt::format("adaptive quadrature to {:.1g}", plan.quadrature);
    if (plan.engine == Engine::fast) return;  // which names its own
    c.bound += plan.quadrature * double(lamps);
    c.bound_kind = BoundKind::estimated;
}

void name_method(Plan& plan, Effect effect, bool closed) {
    EffectChoice& c = plan[effect];
    switch (effect) {
        case Effect::airlight_point:
            name_integral(plan, c, closed, lamps_with(plan, &LampPlan::airlight_point));
            break;
        case Effect::airlight_gaussians:
            name_integral(plan, c, closed, lamps_with(plan, &LampPlan::airlight_gaussians));
            break;
        case Effect::surface_point:
            name_integral(plan, c, closed, lamps_with(plan, &LampPlan::surface));
            c.rung += ", sampled";
            break;
        case Effect::airlight_environment:
        case Effect::surface_environment:
            c.rung = "sampled";
            break;
        case Effect::shadow_prt:
            c.rung = "rays";
            break;
        case Effect::shafts:
            c.rung = "exact borders";
            break;
        case Effect::slab:
            c.rung = "Snell and Fresnel";
            break;
        case Effect::particles:
            c.rung = "cell by cell";
            break;
        case Effect::brdf_glossy:
            c.rung = "evaluated";
            break;
        case Effect::attenuation:
            c.rung = "closed form";
            if (plan.single_precision() && !SceneMedia(plan.media).everywhere()) {
                c.rung += ", single precision";
                c.bound += kSinglePrecisionError;
                c.bound_kind = BoundKind::estimated;
            }
            break;
        case Effect::density_height:
        case Effect::density_atmosphere:
            c.rung = "closed form";
            break;
        default:
            break;
    }
}

}  // namespace

void name_reference_methods(Plan& plan) {
    // The integrals of all lamps share the error.
    const double integrals = double(lamps_with(plan, &LampPlan::airlight_point) +
                                    lamps_with(plan, &LampPlan::airlight_gaussians) +
                                    lamps_with(plan, &LampPlan::surface));
    plan.quadrature = plan.everything ? kFinestQuadrature
                                      : std::max(kFinestQuadrature,
                                                 0.4 * plan.tolerance / std::max(1.0, integrals));
    const bool closed =
        !plan.everything && SceneMedia(plan.media).everywhere() && !plan.runs(Effect::slab);
    for (std::size_t i = 0; i < kEffectCount; ++i) {
        const auto effect = static_cast<Effect>(i);
        if (plan.runs(effect)) name_method(plan, effect, closed);
    }
}

}  // namespace airlight::detail
