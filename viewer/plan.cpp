// SPDX-License-Identifier: Apache-2.0
#include "viewer/plan.h"

#include <algorithm>

#include "viewer/fast_choice.h"
#include "viewer/plan_cost.h"
#include "viewer/plan_steps.h"

namespace airlight {
namespace {

// Whether effects are there that a bound may rule out.
bool anything_in_question(const Plan& plan) {
    for (const Effect effect :
         {Effect::attenuation, Effect::airlight_point, Effect::airlight_gaussians,
          Effect::airlight_environment, Effect::surface_point}) {
        if (plan.runs(effect)) return true;
    }
    return false;
}

void run_everything(Plan& plan) {
    for (EffectChoice& choice : plan.effects) {
        if (!choice.runs) choice.reason = "asked for, though " + choice.reason;
        choice.runs = true;
    }
    for (ObjectPlan& object : plan.objects) {
        object.glossy = true;
        object.reason = "everything is evaluated";
    }
}

void obey(const EffectSet& only, Plan& plan) {
    for (std::size_t i = 0; i < kEffectCount; ++i) {
        const auto effect = static_cast<Effect>(i);
        if (only.has(effect) || !plan.runs(effect)) continue;
        detail::decide(plan, effect, false, "left out as asked");
        plan[effect].bound = 1;
    }
    for (LampPlan& lamp : plan.lights) {
        lamp.airlight_point &= plan.runs(Effect::airlight_point);
        lamp.airlight_gaussians &= plan.runs(Effect::airlight_gaussians);
        lamp.surface &= plan.runs(Effect::surface_point);
        lamp.shafts &= plan.runs(Effect::shafts);
    }
    for (ObjectPlan& object : plan.objects) object.glossy &= plan.runs(Effect::brdf_glossy);
}

}  // namespace

namespace detail {

void decide(Plan& plan, Effect effect, bool runs, std::string reason) {
    plan[effect].runs = runs;
    plan[effect].reason = std::move(reason);
}

std::size_t lamps_with(const Plan& plan, bool LampPlan::*flag) {
    return static_cast<std::size_t>(std::count_if(
        plan.lights.begin(), plan.lights.end(), [&](const LampPlan& lamp) { return lamp.*flag; }));
}

}  // namespace detail

double Plan::bound() const {
    double sum = 0;
    for (const EffectChoice& choice : effects) sum += choice.bound;
    return sum;
}

double Plan::cost() const {
    double sum = base_cost;
    for (const EffectChoice& choice : effects) sum += choice.cost;
    return sum;
}

Plan make_plan(const World& world, const PlanOptions& options) {
    const Scene& scene = world.scene();
    Plan plan;
    plan.engine = options.engine;
    plan.tolerance = options.tolerance > 0 ? options.tolerance : scene.tolerance;
    plan.everything = options.all;
    plan.media = scene.media;
    plan.lights.resize(scene.lights.size());
    plan.objects.resize(scene.objects.size());
    detail::plan_holdings(world, plan);
    if (options.all) {
        run_everything(plan);
    } else if (options.bounds && anything_in_question(plan)) {
        detail::leave_out_unnoticed(world, options.width, options.height, plan);
    }
    obey(options.only, plan);
    detail::name_reference_methods(plan);
    if (options.bounds) estimate_costs(world, plan);
    if (options.engine == Engine::fast && options.bounds) choose_fast_methods(world, plan);
    return plan;
}

}  // namespace airlight
