// SPDX-License-Identifier: Apache-2.0
#include "viewer/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "viewer/fast_choice.h"
#include "viewer/plan_cost.h"
#include "viewer/plan_level.h"
#include "viewer/view_bounds.h"

namespace airlight {
namespace {

// Effects that are left out may err by this part of the tolerance together, methods by the rest.
constexpr double kShareLeftOut = 0.5;

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
bool is_height(const SceneMedium& medium) {
    return std::holds_alternative<SceneExponentialHeight>(medium.kind) ||
           std::holds_alternative<SceneLinearHeight>(medium.kind);
}

std::string count_of(std::size_t count, const char* one, const char* more) {
    return count == 1 ? fmt::format("1 {}", one) : fmt::format("{} {}", count, more);
}

// What a scene holds that effects follow from.
struct Holdings {
    std::size_t lamps = 0, objects = 0, glossy = 0;
    std::size_t media = 0, gaussian_media = 0, blobs = 0, slabs = 0, height = 0, atmospheres = 0;
    bool map = false, shafts = false;

    Holdings(const World& world, const std::vector<SceneMedium>& left) {
        const Scene& scene = world.scene();
        lamps = scene.lights.size();
        objects = scene.objects.size();
        map = scene.environment.has_value();
        shafts = scene.shafts.has_value();
        for (std::size_t i = 0; i < objects; ++i) glossy += is_glossy(world.material(i)) ? 1 : 0;
        for (const SceneMedium& medium : left) {
            if (is_slab(medium)) {
                ++slabs;
                continue;
            }
            ++media;
            height += is_height(medium) ? 1 : 0;
            atmospheres += std::holds_alternative<SceneAtmosphere>(medium.kind) ? 1 : 0;
            if (!is_gaussian(medium)) continue;
            ++gaussian_media;
            blobs += std::get<SceneGaussians>(medium.kind).blobs.size();
        }
    }
};

class Planner {
  public:
    Planner(const World& world, const PlanOptions& options)
        : world_(world), options_(options), scene_(world.scene()) {
        plan_.engine = options.engine;
        plan_.tolerance = options.tolerance > 0 ? options.tolerance : scene_.tolerance;
        plan_.everything = options.all;
        plan_.media = scene_.media;
        plan_.lights.resize(scene_.lights.size());
        plan_.objects.resize(scene_.objects.size());
    }

    Plan make() {
        by_existence();
        if (options_.all) {
            for (EffectChoice& choice : plan_.effects) {
                if (!choice.runs) choice.reason = "asked for, though " + choice.reason;
                choice.runs = true;
            }
            for (ObjectPlan& object : plan_.objects) {
                object.glossy = true;
                object.reason = "everything is evaluated";
            }
        } else if (options_.bounds && anything_in_question()) {
            leave_out();
        }
        obey_the_user();
        name_methods();
        if (options_.bounds) estimate_costs(world_, plan_);
        return std::move(plan_);
    }

  private:
    EffectChoice& choice(Effect effect) { return plan_[effect]; }

    void decide(Effect effect, bool runs, std::string reason) {
        choice(effect).runs = runs;
        choice(effect).reason = std::move(reason);
    }

    // What is missing for light of `source` in `medium`; empty where nothing is.
    static std::string missing(bool medium, bool source, const char* no_medium,
                               const char* no_source) {
        return !medium ? no_medium : !source ? no_source : "";
    }
    void decide(Effect effect, const std::string& missing, std::string reason) {
        decide(effect, missing.empty(), missing.empty() ? std::move(reason) : missing);
    }

    void by_existence() {
        const Holdings has(world_, plan_.media);
        const bool air = has.media + has.slabs > 0;
        const std::string lamps = count_of(has.lamps, "lamp", "lamps");
        const std::string things = count_of(has.objects, "object", "objects");
        decide(Effect::attenuation, air,
               air ? count_of(has.media + has.slabs, "medium dims", "media dim") + " light"
                   : "the air is clear");
        decide(Effect::airlight_point,
               missing(has.media - has.gaussian_media + has.slabs > 0, has.lamps > 0,
                       "no medium but Gaussians is there", "there are no lamps"),
               lamps + " in fog");
        decide(
            Effect::airlight_gaussians,
            missing(has.blobs > 0, has.lamps > 0, "there are no Gaussians", "there are no lamps"),
            fmt::format("{} by {}", count_of(has.blobs, "Gaussian lit", "Gaussians lit"), lamps));
        decide(Effect::airlight_environment,
               missing(air, has.map, "the air is clear", "there is no map"),
               "the map lights the media");
        decide(Effect::surface_point,
               air ? missing(has.objects > 0, has.lamps > 0, "there are no objects",
                             "there are no lamps")
                   : "the air is clear",
               fmt::format("{} in the glow of {}", things, lamps));
        decide(Effect::surface_environment,
               missing(has.objects > 0, has.map, "there are no objects", "there is no map"),
               fmt::format("{} under the map", things));
        decide(Effect::shadow_prt,
               missing(has.objects > 0, has.map, "there are no objects", "there is no map"),
               "objects shade each other from the map");
        decide(Effect::interreflection, false, "the reference passes no light between surfaces");
        decide(
            Effect::brdf_glossy, has.glossy > 0,
            has.glossy > 0 ? fmt::format("{} of {}", has.glossy, things) : "no material mirrors");
        const char* const integrated = "the reference integrates over directions";
        decide(Effect::product_dot, false, integrated);
        decide(Effect::product_triple, false, integrated);
        decide(Effect::density_height, has.height > 0,
               has.height > 0 ? count_of(has.height, "layer", "layers") : "there is no layer");
        decide(Effect::density_atmosphere, has.atmospheres > 0,
               has.atmospheres > 0 ? count_of(has.atmospheres, "atmosphere", "atmospheres")
                                   : "there is no atmosphere");
        decide(Effect::slab, has.slabs > 0,
               has.slabs > 0 ? count_of(has.slabs, "slab", "slabs") : "there is no slab");
        decide(Effect::shafts,
               air ? missing(has.objects > 0, has.lamps > 0 || has.map, "there are no objects",
                             "there is no light")
                   : "the air is clear",
               things + " may shade the air");
        decide(Effect::particles,
               has.shafts ? missing(air, has.lamps > 0, "the air is clear", "there are no lamps")
                          : "the scene asks for none",
               "the scene asks for them");
        decide(Effect::noise, false, "scenes hold no noise");
        for (std::size_t i = 0; i < plan_.objects.size(); ++i) {
            ObjectPlan& object = plan_.objects[i];
            object.glossy = is_glossy(world_.material(i));
            object.reason = object.glossy ? "its material mirrors" : "its material is diffuse";
        }
        if (plan_.engine == Engine::fast && has.map) by_baked_files();
        for (LampPlan& lamp : plan_.lights) {
            lamp.airlight_point = plan_.runs(Effect::airlight_point);
            lamp.airlight_gaussians = plan_.runs(Effect::airlight_gaussians);
            lamp.surface = plan_.runs(Effect::surface_point);
            lamp.shafts = plan_.runs(Effect::shafts);
        }
    }

    // The fast engine has shadows of the map from .prt files alone. Where there are both shadows
    // and gloss it takes products of three, else of two.
    void by_baked_files() {
        std::size_t dot = 0, triple = 0;
        for (std::size_t i = 0; i < plan_.objects.size(); ++i) {
            ObjectPlan& object = plan_.objects[i];
            const bool baked = scene_.objects[i].prt.given();
            object.reason += baked ? "; its shadows are baked" : "; no .prt file, no shadows";
            if (!baked) continue;
            object.product = object.glossy ? SurfaceProduct::triple : SurfaceProduct::dot;
            ++(object.glossy ? triple : dot);
        }
        const std::size_t baked = dot + triple;
        const char* const none = "no object has a .prt file";
        decide(Effect::shadow_prt, baked > 0,
               baked > 0 ? count_of(baked, "object has", "objects have") + " a .prt file" : none);
        decide(Effect::interreflection, baked > 0,
               baked > 0 ? "as much as the .prt files hold" : none);
        decide(Effect::product_dot, baked > 0,
               baked > 0 ? "transfer times light, of the diffuse parts" : none);
        decide(Effect::product_triple, triple > 0,
               triple > 0 ? count_of(triple, "object has", "objects have") + " shadows and gloss"
               : dot > 0  ? "no object has both shadows and gloss"
                          : none);
    }

    bool anything_in_question() const {
        for (const Effect effect :
             {Effect::attenuation, Effect::airlight_point, Effect::airlight_gaussians,
              Effect::airlight_environment, Effect::surface_point}) {
            if (plan_.runs(effect)) return true;
        }
        return false;
    }

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

    void leave_out() {
        plan_.level = picture_level(world_, options_.width, options_.height);
        const ViewBounds bounds(world_, options_.width > 0 ? options_.width : scene_.camera.width,
                                options_.height > 0 ? options_.height : scene_.camera.height);
        leave_out_media(bounds);
        leave_out_lamps(bounds);
        update_sums();
    }

    void leave_out_media(const ViewBounds& bounds) {
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
                items.push_back({bounds.of_medium(medium).total(plan_.level, alone),
                                 [&gone, m] { gone[m] = true; }});
                continue;
            }
            gone_blobs[m].assign(gaussians->blobs.size(), false);
            if (gaussians->blobs.size() * (1 + scene_.lights.size()) > kMostBlobBounds) continue;
            for (std::size_t k = 0; k < gaussians->blobs.size(); ++k) {
                items.push_back({bounds.of_blob(*gaussians, medium.phase, gaussians->blobs[k])
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
        const Holdings has(world_, plan_.media);
        if (has.media + has.slabs == 0) {
            for (std::size_t i = 0; i < kEffectCount; ++i) {
                const auto effect = static_cast<Effect>(i);
                if (kInMedia.has(effect) && plan_.runs(effect)) {
                    decide(effect, false, "all that is in the air is under the tolerance");
                }
            }
        }
        if (has.blobs == 0 && plan_.runs(Effect::airlight_gaussians)) {
            decide(Effect::airlight_gaussians, false, "no Gaussian is noticed");
        }
        if (has.height == 0 && plan_.runs(Effect::density_height)) {
            decide(Effect::density_height, false, "no layer is noticed");
        }
        if (has.atmospheres == 0 && plan_.runs(Effect::density_atmosphere)) {
            decide(Effect::density_atmosphere, false, "no atmosphere is noticed");
        }
        media_bound_ = left_out_;
    }

    void leave_out_lamps(const ViewBounds& bounds) {
        MediumBounds gaussians, others;
        for (const SceneMedium& medium : plan_.media) {
            if (is_slab(medium)) return;  // their light has no bound
            (is_gaussian(medium) ? gaussians : others) += bounds.of_medium(medium);
        }
        const auto over_level = [&](const std::vector<double>& values, std::size_t i) {
            return i < values.size() && values[i] > 0 ? values[i] / plan_.level : 0;
        };
        std::vector<Item> items;
        const auto may_go = [&](bool& flag, Effect effect, double bound) {
            if (!flag) return;
            items.push_back({bound, [this, &flag, effect, bound] {
                                 flag = false;
                                 choice(effect).bound += bound;
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
        decide(effect, false,
               fmt::format("it adds {:.1g} of the brightest pixel at most", choice(effect).bound));
    }

    // Effects of which no lamp is left.
    void update_sums() {
        const auto none = [&](bool LampPlan::*flag) { return lamps_with(flag) == 0; };
        if (none(&LampPlan::airlight_point)) gone(Effect::airlight_point);
        if (none(&LampPlan::airlight_gaussians)) gone(Effect::airlight_gaussians);
        if (none(&LampPlan::surface)) gone(Effect::surface_point);
        if (none(&LampPlan::shafts) && !scene_.environment) gone(Effect::shafts);
        for (const auto& [flag, effect] :
             {std::pair{&LampPlan::airlight_point, Effect::airlight_point},
              std::pair{&LampPlan::airlight_gaussians, Effect::airlight_gaussians},
              std::pair{&LampPlan::surface, Effect::surface_point}}) {
            const std::size_t left = lamps_with(flag);
            if (plan_.runs(effect) && left < plan_.lights.size()) {
                choice(effect).reason += fmt::format(
                    "; {} of {} matter", left, count_of(plan_.lights.size(), "lamp", "lamps"));
            }
        }
        if (plan_.runs(Effect::airlight_gaussians) && plan_.blobs_left_out > 0) {
            choice(Effect::airlight_gaussians).reason +=
                fmt::format("; {} Gaussians are not noticed", plan_.blobs_left_out);
        }
        choice(Effect::attenuation).bound += media_bound_;
    }

    void obey_the_user() {
        for (std::size_t i = 0; i < kEffectCount; ++i) {
            const auto effect = static_cast<Effect>(i);
            if (options_.only.has(effect) || !plan_.runs(effect)) continue;
            decide(effect, false, "left out as asked");
            choice(effect).bound = 1;
        }
        for (LampPlan& lamp : plan_.lights) {
            lamp.airlight_point &= plan_.runs(Effect::airlight_point);
            lamp.airlight_gaussians &= plan_.runs(Effect::airlight_gaussians);
            lamp.surface &= plan_.runs(Effect::surface_point);
            lamp.shafts &= plan_.runs(Effect::shafts);
        }
        for (ObjectPlan& object : plan_.objects) object.glossy &= plan_.runs(Effect::brdf_glossy);
    }

    std::size_t lamps_with(bool LampPlan::*flag) const {
        return static_cast<std::size_t>(
            std::count_if(plan_.lights.begin(), plan_.lights.end(),
                          [&](const LampPlan& lamp) { return lamp.*flag; }));
    }

    void name_methods() {
        // The integrals of all lamps share the error.
        const double integrals =
            double(lamps_with(&LampPlan::airlight_point) +
                   lamps_with(&LampPlan::airlight_gaussians) + lamps_with(&LampPlan::surface));
        plan_.quadrature =
            options_.all ? kFinest
                         : std::max(kFinest, 0.4 * plan_.tolerance / std::max(1.0, integrals));
        const bool closed =
            !options_.all && SceneMedia(plan_.media).everywhere() && !plan_.runs(Effect::slab);
        for (std::size_t i = 0; i < kEffectCount; ++i) {
            const auto effect = static_cast<Effect>(i);
            if (plan_.runs(effect)) name_method(effect, closed);
        }
    }

    void name_integral(EffectChoice& c, bool closed, std::size_t lamps) const {
        if (closed) {
            c.rung = "closed form";
            c.bound += kClosedFormError;
            return;
        }
        c.rung = fmt::format("adaptive quadrature to {:.1g}", plan_.quadrature);
        c.bound += plan_.quadrature * double(lamps);
        c.bound_kind = BoundKind::estimated;
    }

    void name_method(Effect effect, bool closed) {
        EffectChoice& c = choice(effect);
        switch (effect) {
            case Effect::airlight_point:
                name_integral(c, closed, lamps_with(&LampPlan::airlight_point));
                break;
            case Effect::airlight_gaussians:
                name_integral(c, closed, lamps_with(&LampPlan::airlight_gaussians));
                break;
            case Effect::surface_point:
                name_integral(c, closed, lamps_with(&LampPlan::surface));
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
            case Effect::density_height:
            case Effect::density_atmosphere:
                c.rung = "closed form";
                break;
            default:
                break;
        }
    }

    static constexpr std::size_t kMostBlobBounds = 4'000'000;
    static constexpr double kFinest = 1e-6;
    static constexpr double kClosedFormError = 1e-12;  // ten times that of medium/airlight.h

    const World& world_;
    const PlanOptions& options_;
    const Scene& scene_;
    Plan plan_;
    double left_out_ = 0, media_bound_ = 0;
    bool attenuation_ = true, environment_ = true;
};

}  // namespace

double Plan::bound() const {
    double sum = 0;
    for (const EffectChoice& choice : effects) sum += choice.bound;
    return sum;
}

Plan make_plan(const World& world, const PlanOptions& options) {
    Plan plan = Planner(world, options).make();
    if (options.engine == Engine::fast && options.bounds && !options.all) {
        choose_fast_methods(world, plan);
    }
    return plan;
}

}  // namespace airlight
