// SPDX-License-Identifier: Apache-2.0
#include "cli/info_scene.h"

#include <fmt/format.h>

#include <vector>

namespace airlight {
namespace {

template <class... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

// Colours that are grey are one number.
std::string colour(const glm::dvec3& c) {
    return c.x == c.y && c.x == c.z ? fmt::format("{:g}", c.x)
                                    : fmt::format("({:g}, {:g}, {:g})", c.x, c.y, c.z);
}

std::string vector(const glm::dvec3& v) {
    return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z);
}

std::string box(const SceneBox& b) {
    return vector(b.min) + " to " + vector(b.max);
}

std::string phase(const ScenePhase& p) {
    switch (p.type) {
        case PhaseType::rayleigh:
            return ", rayleigh";
        case PhaseType::henyey_greenstein:
            return fmt::format(", hg {:g}", p.g);
        case PhaseType::table:
            return ", phase of " + p.file.name;
        case PhaseType::isotropic:
            break;
    }
    return "";
}

std::string albedo(const glm::dvec3& a) {
    return a == glm::dvec3(1) ? "" : ", albedo " + colour(a);
}

std::string describe(const SceneMedium& medium) {
    const std::string kind = std::visit(
        Overloaded{
            [](const SceneUniform& m) {
                return fmt::format("scattering {}, absorption {} per metre", colour(m.scattering),
                                   colour(m.absorption));
            },
            [](const SceneGaussians& m) {
                return fmt::format("{} blobs{}{}", m.blobs.size(),
                                   m.file.given() ? ", " + m.file.name : "", albedo(m.albedo));
            },
            [](const SceneExponentialHeight& m) {
                return fmt::format("extinction {} per metre at y = 0, scale height {:g} m{}",
                                   colour(m.density), m.scale_height, albedo(m.albedo));
            },
            [](const SceneLinearHeight& m) {
                return fmt::format("extinction {} per metre at y = 0, slope {}{}",
                                   colour(m.density), colour(m.slope), albedo(m.albedo));
            },
            [](const SceneAtmosphere& m) {
                return fmt::format(
                    "extinction {} per metre at the ground, radius {:g} m, scale height {:g} m{}",
                    colour(m.density), m.radius, m.scale_height, albedo(m.albedo));
            },
            [](const SceneSlab& m) {
                return fmt::format("{}, index {:g}, scattering {}, absorption {} per metre",
                                   box(m.box), m.ior, colour(m.scattering), colour(m.absorption));
            }},
        medium.kind);
    return kind + phase(medium.phase) + (medium.bounds ? ", within " + box(*medium.bounds) : "");
}

std::string describe(const Material& material) {
    return std::visit(
        Overloaded{[](const LambertMaterial& m) { return "lambert " + colour(m.diffuse); },
                   [](const PhongMaterial& m) {
                       return fmt::format("phong {} + {}, exponent {:g}", colour(m.diffuse),
                                          colour(m.specular), m.exponent);
                   },
                   [](const TabulatedMaterial& m) { return "table " + m.file.name; }},
        material);
}

nlohmann::ordered_json numbers(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

}  // namespace

std::string to_lines(const std::string& path, const Scene& scene) {
    std::string text = path + "\n  a scene\n";
    const auto row = [&](const std::string& name, const std::string& what) {
        text += fmt::format("  {:<26} {}\n", name, what);
    };
    const Camera& c = scene.camera;
    row("camera", fmt::format("{} to {}, {:g} degrees, {} x {} pixels", vector(c.position),
                              vector(c.look_at), c.vertical_fov * 180 / kPi, c.width, c.height));
    if (scene.environment) {
        const EnvironmentLight& e = *scene.environment;
        row("environment", fmt::format("{}, scale {:g}, turned {:g} degrees, {:g} m away",
                                       e.file.name, e.scale, e.rotation * 180 / kPi, e.distance));
    }
    for (std::size_t i = 0; i < scene.lights.size() && i < 8; ++i) {
        const PointLight& light = scene.lights[i];
        row(fmt::format("light {}", i),
            fmt::format("{}, {} W/sr", vector(light.position), colour(light.intensity)));
    }
    if (scene.lights.size() > 8) row("lights", fmt::format("{} more", scene.lights.size() - 8));
    for (std::size_t i = 0; i < scene.media.size(); ++i) {
        row(fmt::format("medium {}: {}", i, medium_type(scene.media[i])), describe(scene.media[i]));
    }
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        row(fmt::format("object {}", i),
            fmt::format("{}, {}{}", object.mesh.name, describe(object.material),
                        object.prt.given() ? ", transfer " + object.prt.name : ""));
    }
    if (scene.shafts) {
        row("shafts",
            fmt::format("shadow map {}, particles mu {:g}, sigma {:g}", scene.shafts->shadow_map,
                        scene.shafts->particles.mu, scene.shafts->particles.sigma));
    }
    row("tolerance", fmt::format("{:g}", scene.tolerance));
    return text;
}

nlohmann::ordered_json to_json(const std::string& path, const Scene& scene) {
    const Camera& c = scene.camera;
    nlohmann::ordered_json json = {
        {"file", path},
        {"format", "airlight_scene"},
        {"camera",
         {{"position", numbers(c.position)},
          {"look_at", numbers(c.look_at)},
          {"vertical_fov_degrees", c.vertical_fov * 180 / kPi},
          {"size", {c.width, c.height}}}},
    };
    if (scene.environment) {
        json["environment"] = {{"file", scene.environment->file.name},
                               {"distance", scene.environment->distance}};
    }
    json["lights"] = scene.lights.size();
    json["media"] = nlohmann::ordered_json::array();
    for (const SceneMedium& medium : scene.media) {
        nlohmann::ordered_json entry = {{"type", medium_type(medium)}};
        if (const auto* gaussians = std::get_if<SceneGaussians>(&medium.kind)) {
            entry["blobs"] = gaussians->blobs.size();
        }
        entry["text"] = describe(medium);
        json["media"].push_back(entry);
    }
    json["objects"] = nlohmann::ordered_json::array();
    for (const SceneObject& object : scene.objects) {
        nlohmann::ordered_json entry = {{"mesh", object.mesh.name},
                                        {"material", describe(object.material)}};
        if (object.prt.given()) entry["prt"] = object.prt.name;
        json["objects"].push_back(entry);
    }
    json["shafts"] = scene.shafts.has_value();
    json["tolerance"] = scene.tolerance;
    return json;
}

}  // namespace airlight
