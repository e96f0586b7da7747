// SPDX-License-Identifier: Apache-2.0
#include "viewer/surface_lobes.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"

namespace airlight {

SurfaceLobes lobes_of(const SurfaceMaterial& material) {
    SurfaceLobes lobes;
    if (const auto* lambert = std::get_if<LambertMaterial>(&material.kind)) {
        lobes.diffuse = lambert->diffuse;
    } else if (const auto* phong = std::get_if<PhongMaterial>(&material.kind)) {
        lobes.diffuse = phong->diffuse;
        lobes.specular = phong->specular;
        lobes.exponent = phong->exponent;
    } else {
        constexpr int kRings = 32, kSides = 64;
        const glm::dvec3 normal(0, 1, 0), view(std::sqrt(0.5), std::sqrt(0.5), 0);
        for (int i = 0; i < kRings; ++i) {
            const double y = (i + 0.5) / kRings, across = std::sqrt(1 - y * y);
            for (int j = 0; j < kSides; ++j) {
                const double phi = 2 * kPi * (j + 0.5) / kSides;
                lobes.diffuse += reflect(material, normal, view,
                                         {across * std::cos(phi), y, across * std::sin(phi)});
            }
        }
        lobes.diffuse *= 2 * kPi / (kRings * kSides);
    }
    return lobes;
}

}  // namespace airlight
