// SPDX-License-Identifier: Apache-2.0
// What is in a scene: camera, light, media and objects, as its file describes them.
//
// A scene is small: images, meshes, transfer and BRDFs stay in their files until something needs
// them. World: right-handed, +Y up, metres; colours are linear Rec.709, R, G and B.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/constants.h"
#include "medium/gaussian_density.h"
#include "medium/particles.h"

namespace airlight {

/// A file that a scene names.
struct SceneFile {
    std::string path;   ///< to open it: relative ones are relative to the scene file
    std::string name;   ///< as the scene has it
    std::string where;  ///< "scene.json:7", for messages

    bool given() const { return !name.empty(); }
};

/// A pinhole. The picture's up is `up` less its part along the view.
struct Camera {
    glm::dvec3 position{0, 1, 4};
    glm::dvec3 look_at{0, 1, 0};
    glm::dvec3 up{0, 1, 0};
    double vertical_fov = 40 * kPi / 180;  ///< [rad], in (0, pi)
    int width = 800, height = 600;         ///< pixels, 1 … kLargestPicture
};

inline constexpr int kLargestPicture = 16384;

/// A lat-long map (docs/CONVENTIONS.md) around everything.
struct EnvironmentLight {
    SceneFile file;
    double rotation = 0;  ///< [rad] about +Y, counter-clockwise seen from above
    double scale = 1;     ///< of its radiance, not negative
    /// Metres from the map to whoever receives its light, the camera or a point of a surface;
    /// positive. To uniform media without bounds a direction of the map is a point light there
    /// ([Sun05] sec. 6.1); to others it is infinitely far, and this is how far they dim it.
    double distance = 100;
};

struct PointLight {
    glm::dvec3 position{0};
    glm::dvec3 intensity{0};  ///< radiant intensity [W/sr], not negative
};

enum class PhaseType { isotropic, rayleigh, henyey_greenstein, table };

struct ScenePhase {
    PhaseType type = PhaseType::isotropic;
    double g = 0;    ///< of Henyey-Greenstein, in (-1, 1)
    SceneFile file;  ///< of a table: CSV, angle_degrees,value
};

struct SceneBox {
    glm::dvec3 min{0}, max{0};
};

/// The same everywhere; coefficients [1/m], not negative.
struct SceneUniform {
    glm::dvec3 scattering{0}, absorption{0};
};

/// Sum of amplitude e^{-scale^2 |x - center|^2} [1/m] ([Zhou07] eq. 6), extinction; `albedo` is the
/// part of it that scatters.
struct SceneGaussians {
    std::vector<GaussianBlob> blobs;  ///< those of the file come first
    SceneFile file;
    glm::dvec3 albedo{1};
};

/// Extinction density e^{-y / scale_height} [1/m].
struct SceneExponentialHeight {
    glm::dvec3 density{0};
    double scale_height = 1;  ///< [m], not 0; negative for a medium that thickens upwards
    glm::dvec3 albedo{1};
};

/// Extinction max(0, density + slope y) [1/m].
struct SceneLinearHeight {
    glm::dvec3 density{0};
    glm::dvec3 slope{0};  ///< [1/m^2]
    glm::dvec3 albedo{1};
};

/// Extinction density e^{-(|x - center| - radius) / scale_height} [1/m] around a planet, whose
/// ground is not part of it.
struct SceneAtmosphere {
    glm::dvec3 center{0};
    double radius = 0;  ///< [m], positive
    glm::dvec3 density{0};
    double scale_height = 1;  ///< [m], positive
    glm::dvec3 albedo{1};
};

/// A box of a uniform medium behind surfaces that refract ([Slab]).
struct SceneSlab {
    SceneBox box;
    double ior = 1;  ///< index of refraction inside over that outside, 1 … 4
    glm::dvec3 scattering{0}, absorption{0};
};

struct SceneMedium {
    std::variant<SceneUniform, SceneGaussians, SceneExponentialHeight, SceneLinearHeight,
                 SceneAtmosphere, SceneSlab>
        kind;
    ScenePhase phase;
    std::optional<SceneBox> bounds;  ///< outside it the medium is absent
};

/// The file's word for a medium: "uniform", "gaussians", "height", "atmosphere" or "slab".
const char* medium_type(const SceneMedium& medium);

struct LambertMaterial {
    glm::dvec3 diffuse{0.5};  ///< albedo, in [0, 1]
};

/// diffuse / pi + specular (exponent + 1) / (2 pi) max(0, cos)^exponent about the mirrored view, as
/// [Sun05] has it; specular is the part of the light that a whole lobe sends on.
struct PhongMaterial {
    glm::dvec3 diffuse{0.5}, specular{0.2};  ///< each in [0, 1]
    double exponent = 20;                    ///< 0 … 1e6
};

/// A table in MERL's layout (sh/brdf_file.h).
struct TabulatedMaterial {
    SceneFile file;
};

using Material = std::variant<LambertMaterial, PhongMaterial, TabulatedMaterial>;

struct SceneObject {
    SceneFile mesh;
    glm::dmat4 transform{
        1};  ///< affine and not singular, from the mesh's coordinates to the world's
    Material material;
    SceneFile prt;  ///< not given: the object has no baked transfer
};

/// Light made visible by particles around the lights' shadows ([Shafts]).
struct SceneShafts {
    int shadow_map = 1024;  ///< texels on a side, 16 … 8192
    ParticleDistribution particles;
};

struct Scene {
    std::string path;  ///< as it was given
    Camera camera;
    std::optional<EnvironmentLight> environment;
    std::vector<PointLight> lights;
    std::vector<SceneMedium> media;  ///< they add up; none is clear air
    std::vector<SceneObject> objects;
    std::optional<SceneShafts> shafts;
    double tolerance = 0.01;  ///< relative, in (0, 1]: of radiance, against the brightest pixel
};

}  // namespace airlight
