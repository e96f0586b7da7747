// SPDX-License-Identifier: Apache-2.0
// Light for engines: order 3 of radiance coefficients, as each engine's shaders evaluate them.
//
// Every function takes coefficients (3, order^2) of R, G, B radiance in the world frame of
// sh/basis.h (real, orthonormal, no Condon-Shortley sign, +Y up, right-handed) and reads the first
// three degrees; lower orders are filled with zeros. With c_lm the coefficient, p_lm the
// polynomials 1; y, z, x; xy, yz, 3z^2 - 1, xz, x^2 - y^2, Y_lm = K_lm p_lm, and A = pi, 2 pi / 3,
// pi / 4, the irradiance on a surface with the normal n is E(n) = sum A_l c_lm Y_lm(n) ([Sloan08]).
//
// What an engine does is read off its public sources: Filament's IndirectLight.h, light_indirect.fs
// and cmgen; three.js' SphericalHarmonics3 and shaders; Unity's ShadeSH9, HDRP's
// SphericalHarmonics.cs and its panoramic skybox; Unreal's SHMath.h, SHCommon.ush, GetSkySHDiffuse
// and the glTF importer; the README and schema of EXT_lights_image_based.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace airlight {

/// Nine coefficients of R, G, B.
using EngineSh = std::array<std::array<double, 3>, 9>;

/// Filament, IndirectLight::Builder::irradiance(3, sh): A_l K_lm c_lm / pi, so that sum sh_i p_i(n)
/// is E(n) / pi. Its documentation multiplies negative factors with coefficients of a basis that
/// has the sign, which is the same. Filament's world is ours, and cmgen, which mirrors by default,
/// puts a lat-long picture where we do.
EngineSh filament_light(int order, const std::vector<double>& coefficients);

/// The same as the text that Filament's cmgen writes to sh.txt and its samples read: nine lines
/// "(R, G, B);".
std::string filament_text(const EngineSh& light);

/// three.js, LightProbe.sh: c_lm as they are; its shaders multiply by A_l K_lm and materials
/// divide by pi. three.js' world is ours, but it shows a lat-long picture with its centre at +X:
/// beside such a background, turn the light by 90 degrees about +Y first (turned_about_up).
EngineSh three_light(int order, const std::vector<double>& coefficients);

/// Unity, SphericalHarmonicsL2 [channel, i]: A_l K_lm c_lm / pi, as RenderSettings.ambientProbe
/// holds them. Unity's world is left-handed, +Y up: (x, y, z) there are (Z, Y, X) here, where
/// the same picture stands as Skybox/Panoramic (rotation 0), its centre at Unity's +X. Importers of
/// glTF, which turn meshes to (-X, Y, Z), need a turn by 90 degrees about +Y first.
EngineSh unity_light(int order, const std::vector<double>& coefficients);

/// Unreal, FSHVectorRGB3: c_lm with the sign of odd m turned, Unreal's basis having it. Its world
/// is left-handed, +Z up: (x, y, z) there are (X, Z, Y) here, as its importers of glTF turn meshes.
EngineSh unreal_light(int order, const std::vector<double>& coefficients);

/// The seven vectors of Unreal's SkyIrradianceEnvironmentMap from unreal_light, with which its
/// shaders compute E(n) / pi.
std::array<std::array<double, 4>, 7> unreal_sky_vectors(const EngineSh& light);

/// glTF, irradianceCoefficients of EXT_lights_image_based: A_l c_lm, the coefficients of E, in the
/// basis of the papers that its text cites, which is ours. glTF's world is ours.
///
/// The text says neither the sign of odd m nor whether A_l belongs to them; what is written here is
/// its words, "coefficients for irradiance". Readers differ: some evaluate exactly this, Babylon.js
/// expects odd m with the other sign, and there are those that multiply by A_l once more.
EngineSh gltf_light(int order, const std::vector<double>& coefficients);

/// Coefficients (3, order^2) of the light turned about +Y; +90 degrees takes +X to -Z.
std::vector<double> turned_about_up(int order, const std::vector<double>& coefficients,
                                    double degrees);

enum class EngineFormat { filament, three, unity, unreal, gltf };

/// A direction of the world frame in the axes of an engine, those of its converter above.
std::array<double, 3> engine_direction(EngineFormat format, const std::array<double, 3>& direction);

/// What is written for an engine: nine lines for Filament, else JSON.
///
///   three   the object that LightProbe.fromJSON takes: intensity 1 and sh, 27 numbers
///   unity   SphericalHarmonicsL2, (channel, coefficient)
///   unreal  FSHVectorRGB3, channels R, G, B of 9, and SkyIrradianceEnvironmentMap, (7, 4)
///   gltf    an asset with one light, which its scene refers to; rotation none, intensity 1. The
///           schema also demands specular images: they are one black picture of 2 x 2 pixels, so
///           the asset lights diffuse surfaces only.
///
/// Throws Error(data) where a number exceeds what the engine's floats hold, 3.4e38.
std::string engine_text(EngineFormat format, int order, const std::vector<double>& coefficients);

}  // namespace airlight
