// SPDX-License-Identifier: Apache-2.0
#include "cli/plan_flags.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>

#include "cli/numbers.h"
#include "core/error.h"

namespace airlight {
namespace {

EffectSet parse_effects(const std::string& text, const std::string& flag) {
    std::vector<std::string> names;
    for (const auto& [effect, name] : kEffects) names.emplace_back(name);
    EffectSet set;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        const int choice = parse_choice(text.substr(begin, comma - begin), flag, names);
        set.add(kEffects[static_cast<std::size_t>(choice)].method);
        begin = comma + 1;
    }
    return set;
}

std::string percent(double share) {
    return share > 0 && share < 0.005 ? "<1 %" : fmt::format("{:.0f} %", 100 * share);
}

std::string bound_text(const EffectChoice& choice) {
    if (choice.bound == 0) return "-";
    return fmt::format("{:.1e}{}", choice.bound,
                       choice.bound_kind == BoundKind::estimated ? " est." : "");
}

const char* product_name(SurfaceProduct product) {
    switch (product) {
        case SurfaceProduct::dot:
            return "dot";
        case SurfaceProduct::triple:
            return "triple";
        case SurfaceProduct::none:
            break;
    }
    return "none";
}

}  // namespace

double parse_tolerance(const std::string& text) {
    return parse_number(text, "--tolerance", {1e-12, 1});
}

void warn_of_tolerance(const std::string& path, const Plan& plan) {
    if (plan.tolerance >= kFinestQuadrature || plan.bound() <= plan.tolerance) return;
    spdlog::warn(
        "{}: no method reaches the tolerance {:.3g}; errors stay below {:.2g} of the brightest "
        "pixel",
        path, plan.tolerance, plan.bound());
}

void add_plan_flags(const Command& command, PlanOptions& options) {
    add_flag(
        command, "--engine", "reference|fast",
        "reference: single scattering done exactly; fast: the papers' approximations "
        "(default: reference)",
        [&](const std::string& text) {
            const auto names = method_names(kEngines, Engine::reference);
            options.engine =
                kEngines[static_cast<std::size_t>(parse_choice(text, "--engine", names))].method;
        });
    command.app
        ->add_flag_callback(
            "--all", [&] { options.all = true; },
            "Evaluate every effect, each by its most general method, needed or not")
        ->option_text(" ");
    add_flag(command, "--only", "EFFECT[,...]", "Leave out all other effects (see airlight plan)",
             [&](const std::string& text) { options.only = parse_effects(text, "--only"); });
    add_flag(command, "--without", "EFFECT[,...]", "Leave these out", [&](const std::string& text) {
        const EffectSet out = parse_effects(text, "--without");
        for (const auto& [effect, name] : kEffects) {
            if (out.has(effect)) options.only.remove(effect);
        }
    });
}

void parse_picture_size(const std::string& text, int& width, int& height) {
    const std::size_t cross = text.find('x');
    if (cross == std::string::npos) {
        throw Error(ErrorCode::usage, "'" + text + "' is no size such as 800x600", "--size");
    }
    width = parse_integer(text.substr(0, cross), "--size", 1, kLargestPicture);
    height = parse_integer(text.substr(cross + 1), "--size", 1, kLargestPicture);
}

std::string to_lines(const std::string& path, const Plan& plan) {
    std::string text = fmt::format("{}: {} engine, tolerance {:g}\n\n", path,
                                   method_name(kEngines, plan.engine), plan.tolerance);
    const std::string row = "{:21} {:4} {:>6} {:>13}  {}\n";
    text += fmt::format(fmt::runtime(row), "effect", "runs", "cost", "error below", "why and how");
    const double whole = plan.cost();
    for (const auto& [effect, name] : kEffects) {
        const EffectChoice& choice = plan[effect];
        text +=
            fmt::format(fmt::runtime(row), name, choice.runs ? "yes" : "no",
                        choice.runs ? percent(choice.cost / whole) : "",
                        choice.runs || choice.bound > 0 ? bound_text(choice) : "",
                        choice.rung.empty() ? choice.reason : choice.reason + "; " + choice.rung);
    }
    text += fmt::format("\nTogether: error below {:.1e} of the brightest pixel", plan.bound());
    if (plan.level > 0) text += fmt::format(" (about {:.3g} W/(m2 sr))", plan.level);
    text += fmt::format(", {:.2g} us of CPU time for a ray of view.\n", 1e-3 * whole);
    for (std::size_t i = 0; i < plan.lights.size(); ++i) {
        const LampPlan& lamp = plan.lights[i];
        std::string out;
        const auto add = [&](bool used, Effect effect) {
            if (used || !plan.runs(effect)) return;
            out += (out.empty() ? "" : ", ") + std::string(method_name(kEffects, effect));
        };
        add(lamp.airlight_point, Effect::airlight_point);
        add(lamp.airlight_gaussians, Effect::airlight_gaussians);
        add(lamp.surface, Effect::surface_point);
        add(lamp.shafts, Effect::shafts);
        if (!out.empty()) text += fmt::format("Light {}: without {}.\n", i + 1, out);
    }
    for (std::size_t i = 0; i < plan.objects.size(); ++i) {
        const ObjectPlan& object = plan.objects[i];
        text += fmt::format("Object {}: {}{}.\n", i + 1, object.reason,
                            object.product == SurfaceProduct::none
                                ? ""
                                : fmt::format("; {} product", product_name(object.product)));
    }
    if (plan.media_left_out > 0) {
        text += fmt::format("Left out: {} of the media.\n", plan.media_left_out);
    }
    if (plan.blobs_left_out > 0) text += fmt::format("Left out: {} blobs.\n", plan.blobs_left_out);
    return text;
}

nlohmann::ordered_json to_json(const Plan& plan) {
    nlohmann::ordered_json report = {{"engine", method_name(kEngines, plan.engine)},
                                     {"tolerance", plan.tolerance},
                                     {"level", plan.level},
                                     {"bound", plan.bound()},
                                     {"nanoseconds_per_ray", plan.cost()},
                                     {"quadrature", plan.quadrature},
                                     {"media_left_out", plan.media_left_out},
                                     {"blobs_left_out", plan.blobs_left_out}};
    nlohmann::ordered_json effects;
    for (const auto& [effect, name] : kEffects) {
        const EffectChoice& choice = plan[effect];
        effects[std::string(name)] = {
            {"runs", choice.runs},
            {"reason", choice.reason},
            {"method", choice.rung},
            {"bound", choice.bound},
            {"proven", choice.bound_kind == BoundKind::proven},
            {"cost_share", choice.cost / plan.cost()},
        };
    }
    report["effects"] = effects;
    for (const LampPlan& lamp : plan.lights) {
        report["lights"].push_back({{"airlight.point", lamp.airlight_point},
                                    {"airlight.gaussians", lamp.airlight_gaussians},
                                    {"surface.point", lamp.surface},
                                    {"shafts", lamp.shafts}});
    }
    for (const ObjectPlan& object : plan.objects) {
        report["objects"].push_back({{"glossy", object.glossy},
                                     {"product", product_name(object.product)},
                                     {"reason", object.reason}});
    }
    return report;
}

}  // namespace airlight
