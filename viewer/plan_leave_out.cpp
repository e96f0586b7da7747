// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "viewer/plan_level.h"
#include "viewer/plan_steps.h"
#include "viewer/view_bounds.h"

namespace airlight::detail {
namespace {

// Effects that are left out may err by this part of the tolerance together, methods by the rest.
constexpr double kShareLeftOut = 0.5;
// Beyond, blobs are not looked at one by one.
constexpr std::size_t kMostBlobBounds = 4'000'000;

constexpr EffectSet kInMedia = {
    Effect::attenuation,          Effect::airlight_point, Effect::airlight_gaussians,
    Effect::airlight_environment, Effect::surface_point,  Effect::density_height,
    Effect::density_atmosphere,   Effect::shafts,         Effect::particles,
};

bool is_gaussian(const SceneMedium& medium) {
    return std::holds_alternative<SceneGaussians>(medium.kind);
}
bool is_slab(const SceneMedium& medium) {
    return std::holds_alternative<SceneSlab>(medium.kind);
}

class LeaveOut {
  public:
    LeaveOut(const World& world, const ViewBounds& bounds, Plan& plan)
        : world_(world), scene_(world.scene()), bounds_(bounds), plan_(plan) {}

    void run() {
        leave_out_media();
        leave_out_lamps();
        update_reasons();
    }

  private:
    // Takes out what is least, as long as the bounds of all that is out fit their share.
    struct Item {
        double bound;
        std::function<void()> take_out;
    };
    void take_out(std::vector<Item>& items) {
        std::stable_sort(items.begin(), items.end(),
                         [](const Item& a, const Item& b) { return a.bound < b.bound; });
        for (Item& item : items) {
            if (!(left_out_ + item.bound <= kShareLeftOut * plan_.tolerance)) break;
            left_out_ += item.bound;
            item.take_out();
        }
    }

    void leave_out_media() {
        if (scene_.shafts) return;  // their particles have no bound
        std::vector<Item> items;
        std::vector<bool> gone(plan_.media.size(), false);
        const bool alone = plan_.media.size() == 1;
        std::vector<std::vector<bool>> gone_blobs(plan_.media.size());
        for (std::size_t m = 0; m < plan_.media.size(); ++m) {
            const SceneMedium& medium = plan_.media[m];
            if (is_slab(medium)) continue;
            const auto* gaussians = std::get_if<SceneGaussians>(&medium.kind);
            if (!gaussians) {
                items.push_back({bounds_.of_medium(medium).total(plan_.level, alone),
                                 [&gone, m] { gone[m] = true; }});
                continue;
            }
            gone_blobs[m].assign(gaussians->blobs.size(), false);
            if (gaussians->blobs.size() * (1 + scene_.lights.size()) > kMostBlobBounds) continue;
            for (std::size_t k = 0; k < gaussians->blobs.size(); ++k) {
                items.push_back({bounds_.of_blob(*gaussians, medium.phase, gaussians->blobs[k])
                                     .total(plan_.level, false),
                                 [&gone_blobs, m, k] { gone_blobs[m][k] = true; }});
            }
        }
        take_out(items);
        std::vector<SceneMedium> left;
        for (std::size_t m = 0; m < plan_.media.size(); ++m) {
            SceneMedium medium = std::move(plan_.media[m]);
            if (auto* const gaussians = std::get_if<SceneGaussians>(&medium.kind)) {
                std::vector<GaussianBlob> blobs;
                for (std::size_t k = 0; k < gaussians->blobs.size(); ++k) {
                    if (!gone_blobs[m][k]) blobs.push_back(gaussians->blobs[k]);
                }
                plan_.blobs_left_out += gaussians->blobs.size() - blobs.size();
                gone[m] = blobs.empty() && !gaussians->blobs.empty();
                gaussians->blobs = std::move(blobs);
            }
            if (gone[m]) {
                ++plan_.media_left_out;
            } else {
                left.push_back(std::move(medium));
            }
        }
        plan_.media = std::move(left);
        const SceneHoldings has(world_, plan_.media);
        if (has.media + has.slabs == 0) {
            for (std::size_t i = 0; i < kEffectCount; ++i) {
                const auto effect = static_cast<Effect>(i);
                if (kInMedia.has(effect) && plan_.runs(effect)) {
                    decide(plan_, effect, false, "all that is in the air is under the tolerance");
                }
            }
        }
        if (has.blobs == 0 && plan_.runs(Effect::airlight_gaussians)) {
            decide(plan_, Effect::airlight_gaussians, false, "no Gaussian is noticed");
        }
        if (has.height == 0 && plan_.runs(Effect::density_height)) {
            decide(plan_, Effect::density_height, false, "no layer is noticed");
        }
        if (has.atmospheres == 0 && plan_.runs(Effect::density_atmosphere)) {
            decide(plan_, Effect::density_atmosphere, false, "no atmosphere is noticed");
        }
        media_bound_ = left_out_;
    }

    void leave_out_lamps() {
        MediumBounds gaussians, others;
        for (const SceneMedium& medium : plan_.media) {
            if (is_slab(medium)) return;  // their light has no bound
            (is_gaussian(medium) ? gaussians : others) += bounds_.of_medium(medium);
        }
        const auto over_level = [&](const std::vector<double>& values, std::size_t i) {
            return i < values.size() && values[i] > 0 ? values[i] / plan_.level : 0;
        };
        std::vector<Item> items;
        const auto may_go = [&](bool& flag, Effect effect, double bound) {
            if (!flag) return;
            items.push_back({bound, [this, &flag, effect, bound] {
                                 flag = false;
                                 plan_[effect].bound += bound;
                             }});
        };
        for (std::size_t i = 0; i < plan_.lights.size(); ++i) {
            LampPlan& lamp = plan_.lights[i];
            const double point = over_level(others.airlight, i);
            const double blobs = over_level(gaussians.airlight, i);
            may_go(lamp.airlight_point, Effect::airlight_point, point);
            may_go(lamp.airlight_gaussians, Effect::airlight_gaussians, blobs);
            may_go(lamp.surface, Effect::surface_point,
                   over_level(gaussians.surface, i) + over_level(others.surface, i));
            // Shadows take no more than there is.
            may_go(
                lamp.shafts, Effect::shafts,
                point + blobs + over_level(gaussians.surface, i) + over_level(others.surface, i));
        }
        attenuation_ = true;
        may_go(attenuation_, Effect::attenuation,
               std::expm1(std::max(gaussians.view_depth + gaussians.lamp_depth + others.view_depth +
                                       others.lamp_depth,
                                   gaussians.air_depth + others.air_depth)));
        environment_ = plan_.runs(Effect::airlight_environment);
        may_go(environment_, Effect::airlight_environment,
               gaussians.airlight_environment + others.airlight_environment > 0
                   ? (gaussians.airlight_environment + others.airlight_environment) / plan_.level
                   : 0);
        take_out(items);
        if (!attenuation_) gone(Effect::attenuation);
        if (!environment_) gone(Effect::airlight_environment);
    }

    void gone(Effect effect) {
        if (!plan_.runs(effect)) return;
        decide(plan_, effect, false,
               fmt::format("it adds {:.1g} of the brightest pixel at most", plan_[effect].bound));
    }

    // Effects of which no lamp is left.
    void update_reasons() {
        const auto none = [&](bool LampPlan::*flag) { return lamps_with(plan_, flag) == 0; };
        if (none(&LampPlan::airlight_point)) gone(Effect::airlight_point);
        if (none(&LampPlan::airlight_gaussians)) gone(Effect::airlight_gaussians);
        if (none(&LampPlan::surface)) gone(Effect::surface_point);
        if (none(&LampPlan::shafts) && !scene_.environment) gone(Effect::shafts);
        for (const auto& [flag, effect] :
             {std::pair{&LampPlan::airlight_point, Effect::airlight_point},
              std::pair{&LampPlan::airlight_gaussians, Effect::airlight_gaussians},
              std::pair{&LampPlan::surface, Effect::surface_point}}) {
            const std::size_t left = lamps_with(plan_, flag);
            if (plan_.runs(effect) && left < plan_.lights.size()) {
                plan_[effect].reason += fmt::format("; {} of {} matter", left,
                                                    count_of(plan_.lights.size(), "lamp", "lamps"));
            }
        }
        if (plan_.runs(Effect::airlight_gaussians) && plan_.blobs_left_out > 0) {
            plan_[Effect::airlight_gaussians].reason +=
                fmt::format("; {} Gaussians are not noticed", plan_.blobs_left_out);
        }
        plan_[Effect::attenuation].bound += media_bound_;
    }

    const World& world_;
    const Scene& scene_;
    const ViewBounds& bounds_;
    Plan& plan_;
    double left_out_ = 0, media_bound_ = 0;
    bool attenuation_ = true, environment_ = true;
};

}  // namespace

void leave_out_unnoticed(const World& world, int width, int height, Plan& plan) {
    plan.level = picture_level(world, width, height);
    const Camera& camera = world.scene().camera;
    const ViewBounds bounds(world, width > 0 ? width : camera.width,
                            height > 0 ? height : camera.height);
    LeaveOut(world, bounds, plan).run();
}

}  // namespace airlight::detail
