// SPDX-License-Identifier: Apache-2.0
#include "viewer/scene_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>

#include "core/descriptor.h"
#include "core/error.h"
#include "core/json_fields.h"
#include "core/read_text.h"
#include "sh/sh_file.h"
#include "viewer/blob_file.h"

namespace airlight {
namespace {

constexpr int kSceneVersion = 1;
// A coordinate of a blob of a medium.
constexpr int kDeepest = 6;
constexpr double kDegree = kPi / 180;

class SceneReader {
  public:
    SceneReader(const JsonFields& root, std::string path, std::size_t max_memory)
        : root_(root), folder_(std::filesystem::path(path).parent_path()), max_memory_(max_memory) {
        scene_.path = std::move(path);
    }

    Scene read() {
        root_.know({"airlight_scene", "camera", "environment", "lights", "media", "objects",
                    "shafts", "tolerance"});
        if (root_.has("camera")) scene_.camera = camera_of(root_.object("camera"));
        if (root_.has("environment")) {
            scene_.environment = environment_of(root_.object("environment"));
        }
        if (root_.has("lights")) {
            for (const JsonFields& light : root_.objects("lights")) {
                scene_.lights.push_back(light_of(light));
            }
        }
        if (root_.has("media")) {
            for (const JsonFields& medium : root_.objects("media")) {
                scene_.media.push_back(medium_of(medium));
            }
        }
        if (root_.has("objects")) {
            for (const JsonFields& object : root_.objects("objects")) {
                scene_.objects.push_back(object_of(object));
            }
        }
        if (root_.has("shafts")) scene_.shafts = shafts_of(root_.object("shafts"));
        if (root_.has("tolerance")) scene_.tolerance = root_.number("tolerance", 1e-12, 1);
        return std::move(scene_);
    }

  private:
    static glm::dvec3 vector_of(const JsonFields& fields, const char* key, double limit) {
        const std::vector<double> v = fields.numbers(key, 3, -limit, limit);
        return {v[0], v[1], v[2]};
    }

    static glm::dvec3 point_of(const JsonFields& fields, const char* key) {
        return vector_of(fields, key, kLargestSceneLength);
    }

    static glm::dvec3 colour_of(const JsonFields& fields, const char* key, double low,
                                double high) {
        const std::vector<double> v = fields.channels(key, low, high);
        return v.size() == 1 ? glm::dvec3(v[0]) : glm::dvec3(v[0], v[1], v[2]);
    }

    SceneFile file_of(const JsonFields& fields, const char* key) const {
        SceneFile file;
        file.name = fields.text(key);
        file.where = fmt::format("{}:{}", fields.file(), fields.at(key).line());
        if (file.name.empty()) fields.refuse(key, "is empty, and a file was expected");
        const std::filesystem::path path(file.name);
        file.path = (path.is_absolute() ? path : folder_ / path).string();
        std::error_code error;
        const auto status = std::filesystem::status(file.path, error);
        if (!std::filesystem::exists(status)) {
            fields.refuse(
                key, fmt::format("names {}, and there is no such file", shorten_json(file.path)));
        }
        if (std::filesystem::is_directory(status)) {
            fields.refuse(key, fmt::format("names {}, a directory", shorten_json(file.path)));
        }
        return file;
    }

    static Camera camera_of(const JsonFields& fields) {
        fields.know({"position", "look_at", "up", "vertical_fov_degrees", "size"});
        Camera camera;
        if (fields.has("position")) camera.position = point_of(fields, "position");
        if (fields.has("look_at")) camera.look_at = point_of(fields, "look_at");
        if (fields.has("up")) camera.up = vector_of(fields, "up", kLargestSceneLength);
        if (fields.has("vertical_fov_degrees")) {
            camera.vertical_fov = kDegree * fields.number("vertical_fov_degrees", 1e-3, 179);
        }
        if (fields.has("size")) {
            const std::vector<double> size = fields.numbers("size", 2, 1, kLargestPicture);
            camera.width = static_cast<int>(size[0]);
            camera.height = static_cast<int>(size[1]);
            if (camera.width != size[0] || camera.height != size[1]) {
                fields.refuse("size", "is not a whole number of pixels");
            }
        }
        const glm::dvec3 view = camera.look_at - camera.position;
        if (glm::length(view) == 0) fields.refuse("look_at", "is the position of the camera");
        if (!(glm::length(glm::cross(camera.up, view)) >
              1e-9 * glm::length(camera.up) * glm::length(view))) {
            fields.refuse("up", "is no direction across the view");
        }
        return camera;
    }

    EnvironmentLight environment_of(const JsonFields& fields) const {
        fields.know({"file", "rotation_degrees", "scale", "distance"});
        EnvironmentLight light;
        light.file = file_of(fields, "file");
        if (fields.has("rotation_degrees")) {
            light.rotation = kDegree * fields.number("rotation_degrees", -360, 360);
        }
        if (fields.has("scale")) light.scale = fields.number("scale", 0, kLargestSceneNumber);
        if (fields.has("distance")) {
            light.distance = fields.number("distance", 1e-12, kLargestSceneLength);
        }
        return light;
    }

    static PointLight light_of(const JsonFields& fields) {
        fields.know({"type", "position", "intensity"});
        fields.choice("type", {"point"});
        return {point_of(fields, "position"),
                colour_of(fields, "intensity", 0, kLargestSceneNumber)};
    }

    ScenePhase phase_of(const JsonFields& fields) const {
        ScenePhase phase;
        phase.type =
            static_cast<PhaseType>(fields.choice("type", {"isotropic", "rayleigh", "hg", "table"}));
        if (phase.type == PhaseType::henyey_greenstein) {
            fields.know({"type", "g"});
            phase.g = fields.number("g", -0.999999, 0.999999);
        } else if (phase.type == PhaseType::table) {
            fields.know({"type", "file"});
            phase.file = file_of(fields, "file");
        } else {
            fields.know({"type"});
        }
        return phase;
    }

    static SceneBox box_of(const JsonFields& fields) {
        const SceneBox box = {point_of(fields, "min"), point_of(fields, "max")};
        for (int axis = 0; axis < 3; ++axis) {
            if (!(box.min[axis] < box.max[axis])) {
                fields.refuse("max", fmt::format("[{}] is {}, not more than min's {}", axis,
                                                 box.max[axis], box.min[axis]));
            }
        }
        return box;
    }

    static glm::dvec3 coefficient_of(const JsonFields& fields, const char* key) {
        return fields.has(key) ? colour_of(fields, key, 0, kLargestSceneNumber) : glm::dvec3(0);
    }

    static glm::dvec3 albedo_of(const JsonFields& fields) {
        return fields.has("albedo") ? colour_of(fields, "albedo", 0, 1) : glm::dvec3(1);
    }

    SceneMedium medium_of(const JsonFields& fields) const {
        SceneMedium medium;
        switch (fields.choice("type", {"uniform", "gaussians", "height", "atmosphere", "slab"})) {
            case 0:
                fields.know({"type", "scattering", "absorption", "phase", "bounds"});
                medium.kind = SceneUniform{coefficient_of(fields, "scattering"),
                                           coefficient_of(fields, "absorption")};
                break;
            case 1:
                medium.kind = gaussians_of(fields);
                break;
            case 2:
                height_of(fields, medium);
                break;
            case 3:
                medium.kind = atmosphere_of(fields);
                break;
            default:
                fields.know({"type", "min", "max", "ior", "scattering", "absorption", "phase"});
                medium.kind = SceneSlab{
                    box_of(fields), fields.has("ior") ? fields.number("ior", 1, 4) : 1,
                    coefficient_of(fields, "scattering"), coefficient_of(fields, "absorption")};
        }
        if (fields.has("phase")) medium.phase = phase_of(fields.object("phase"));
        if (fields.has("bounds")) {
            const JsonFields bounds = fields.object("bounds");
            bounds.know({"min", "max"});
            medium.bounds = box_of(bounds);
        }
        return medium;
    }

    SceneGaussians gaussians_of(const JsonFields& fields) const {
        fields.know({"type", "blobs", "file", "albedo", "phase", "bounds"});
        SceneGaussians medium;
        medium.albedo = albedo_of(fields);
        if (fields.has("file")) {
            medium.file = file_of(fields, "file");
            medium.blobs = read_blobs(medium.file.path, max_memory_);
        }
        if (fields.has("blobs")) {
            for (const JsonFields& blob : fields.objects("blobs")) {
                blob.know({"center", "scale", "amplitude"});
                medium.blobs.push_back({point_of(blob, "center"),
                                        blob.number("scale", 0, kLargestSceneNumber),
                                        blob.number("amplitude", 0, kLargestSceneNumber)});
            }
        } else if (!fields.has("file")) {
            fields.at("blobs");
        }
        return medium;
    }

    static void height_of(const JsonFields& fields, SceneMedium& medium) {
        if (fields.choice("profile", {"exponential", "linear"}) == 0) {
            fields.know(
                {"type", "profile", "density", "scale_height", "albedo", "phase", "bounds"});
            SceneExponentialHeight height;
            height.density = colour_of(fields, "density", 0, kLargestSceneNumber);
            height.scale_height =
                fields.number("scale_height", -kLargestSceneLength, kLargestSceneLength);
            if (std::abs(height.scale_height) < 1e-12) {
                fields.refuse("scale_height", "is 0, or less than 1e-12 from it");
            }
            height.albedo = albedo_of(fields);
            medium.kind = height;
        } else {
            fields.know({"type", "profile", "density", "slope", "albedo", "phase", "bounds"});
            SceneLinearHeight height;
            height.density =
                colour_of(fields, "density", -kLargestSceneNumber, kLargestSceneNumber);
            height.slope = colour_of(fields, "slope", -kLargestSceneNumber, kLargestSceneNumber);
            height.albedo = albedo_of(fields);
            medium.kind = height;
        }
    }

    static SceneAtmosphere atmosphere_of(const JsonFields& fields) {
        fields.know(
            {"type", "center", "radius", "density", "scale_height", "albedo", "phase", "bounds"});
        SceneAtmosphere atmosphere;
        atmosphere.radius = fields.number("radius", 1e-12, kLargestSceneLength);
        atmosphere.center = fields.has("center") ? point_of(fields, "center")
                                                 : glm::dvec3(0, -atmosphere.radius, 0);
        atmosphere.density = colour_of(fields, "density", 0, kLargestSceneNumber);
        atmosphere.scale_height = fields.number("scale_height", 1e-12, kLargestSceneLength);
        atmosphere.albedo = albedo_of(fields);
        return atmosphere;
    }

    SceneObject object_of(const JsonFields& fields) const {
        fields.know({"mesh", "transform", "material", "prt"});
        SceneObject object;
        object.mesh = file_of(fields, "mesh");
        if (fields.has("transform")) object.transform = transform_of(fields);
        if (fields.has("material")) object.material = material_of(fields.object("material"));
        if (fields.has("prt")) object.prt = file_of(fields, "prt");
        return object;
    }

    static glm::dmat4 transform_of(const JsonFields& fields) {
        const std::vector<double> values =
            fields.numbers("transform", 16, -kLargestSceneLength, kLargestSceneLength);
        glm::dmat4 transform;
        for (int i = 0; i < 16; ++i) transform[i / 4][i % 4] = values[static_cast<std::size_t>(i)];
        if (values[3] != 0 || values[7] != 0 || values[11] != 0 || values[15] != 1) {
            fields.refuse("transform",
                          "is not affine: of each column of four the last number is 0, of the "
                          "fourth column 1");
        }
        const glm::dvec3 x(transform[0]), y(transform[1]), z(transform[2]);
        const double volume = std::abs(glm::dot(x, glm::cross(y, z)));
        if (!(volume > 1e-12 * glm::length(x) * glm::length(y) * glm::length(z))) {
            fields.refuse("transform", "is singular: it makes the mesh flat");
        }
        return transform;
    }

    Material material_of(const JsonFields& fields) const {
        const auto reflectance = [&](const char* key, const glm::dvec3& otherwise) {
            return fields.has(key) ? colour_of(fields, key, 0, 1) : otherwise;
        };
        switch (fields.choice("type", {"lambert", "phong", "tabulated"})) {
            case 0:
                fields.know({"type", "diffuse"});
                return LambertMaterial{reflectance("diffuse", LambertMaterial{}.diffuse)};
            case 1: {
                fields.know({"type", "diffuse", "specular", "exponent"});
                PhongMaterial phong;
                phong.diffuse = reflectance("diffuse", phong.diffuse);
                phong.specular = reflectance("specular", phong.specular);
                if (fields.has("exponent")) phong.exponent = fields.number("exponent", 0, 1e6);
                return phong;
            }
            default:
                fields.know({"type", "file"});
                return TabulatedMaterial{file_of(fields, "file")};
        }
    }

    static SceneShafts shafts_of(const JsonFields& fields) {
        fields.know({"shadow_map", "particles"});
        SceneShafts shafts;
        if (fields.has("shadow_map")) shafts.shadow_map = fields.integer("shadow_map", 16, 8192);
        if (fields.has("particles")) {
            const JsonFields particles = fields.object("particles");
            particles.know({"mu", "sigma"});
            if (particles.has("mu")) shafts.particles.mu = particles.number("mu", -100, 100);
            if (particles.has("sigma")) {
                shafts.particles.sigma = particles.number("sigma", 1e-6, 100);
            }
        }
        return shafts;
    }

    const JsonFields& root_;
    std::filesystem::path folder_;
    std::size_t max_memory_;
    Scene scene_;
};

}  // namespace

const char* medium_type(const SceneMedium& medium) {
    constexpr const char* kTypes[] = {"uniform", "gaussians",  "height",
                                      "height",  "atmosphere", "slab"};
    static_assert(std::size(kTypes) == std::variant_size_v<decltype(medium.kind)>);
    return kTypes[medium.kind.index()];
}

Scene parse_scene(const std::string& text, const std::string& path, std::size_t max_memory) {
    const std::string name = path == "-" ? "standard input" : path;
    const JsonValue json = parse_json(text, name, kDeepest);
    const JsonFields root = versioned_fields(json, "airlight_scene", kSceneVersion, "scene", name);
    return SceneReader(root, path, max_memory).read();
}

Scene read_scene(const std::string& path, std::size_t max_memory) {
    return parse_scene(read_text(path, "a scene", max_memory / (1 + kJsonTreeBytes)), path,
                       max_memory);
}

bool looks_like_scene(const std::string& path) {
    if (!is_json_file(path)) return false;
    const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
    std::string start(std::size_t{64} << 10, '\0');
    const ssize_t got = pread(file.get(), start.data(), start.size(), 0);
    start.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return start.find("\"airlight_scene\"") != std::string::npos;
}

}  // namespace airlight
