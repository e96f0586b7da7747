// SPDX-License-Identifier: Apache-2.0
// The effects that a scene may call for, and the layers of light that they bring.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <initializer_list>

#include "core/method_names.h"

namespace airlight {

enum class Effect {
    attenuation,           ///< media dim light on its way
    airlight_point,        ///< media that are not Gaussians send light of lamps along rays of view
    airlight_gaussians,    ///< Gaussians do
    airlight_environment,  ///< media send light of the map along rays of view
    surface_point,         ///< media send light of lamps onto surfaces
    surface_environment,   ///< light of the map on surfaces, straight or by way of the media
    shadow_prt,            ///< objects keep light of the map off surfaces
    interreflection,       ///< surfaces light each other, as far as a .prt file holds it
    brdf_glossy,           ///< surfaces mirror in part
    product_dot,           ///< baked transfer times light
    product_triple,        ///< visibility times lobe times light
    density_height,        ///< media that change with height
    density_atmosphere,    ///< media around a planet
    slab,                  ///< media behind surfaces that refract
    shafts,                ///< objects keep light from parts of the media
    particles,             ///< bright specks in the shafts
    noise,                 ///< irregular Gaussians
};

inline constexpr NamedMethod<Effect> kEffects[] = {
    {Effect::attenuation, "attenuation"},
    {Effect::airlight_point, "airlight.point"},
    {Effect::airlight_gaussians, "airlight.gaussians"},
    {Effect::airlight_environment, "airlight.environment"},
    {Effect::surface_point, "surface.point"},
    {Effect::surface_environment, "surface.environment"},
    {Effect::shadow_prt, "shadow.prt"},
    {Effect::interreflection, "interreflection"},
    {Effect::brdf_glossy, "brdf.glossy"},
    {Effect::product_dot, "product.dot"},
    {Effect::product_triple, "product.triple"},
    {Effect::density_height, "density.height"},
    {Effect::density_atmosphere, "density.atmosphere"},
    {Effect::slab, "slab"},
    {Effect::shafts, "shafts"},
    {Effect::particles, "particles"},
    {Effect::noise, "noise"},
};
inline constexpr std::size_t kEffectCount = std::size(kEffects);

class EffectSet {
  public:
    constexpr EffectSet() = default;
    constexpr EffectSet(std::initializer_list<Effect> effects) {
        for (const Effect effect : effects) add(effect);
    }
    static constexpr EffectSet all() {
        EffectSet set;
        set.bits_ = (1u << kEffectCount) - 1;
        return set;
    }
    constexpr bool has(Effect effect) const { return (bits_ >> static_cast<unsigned>(effect)) & 1; }
    constexpr void add(Effect effect) { bits_ |= 1u << static_cast<unsigned>(effect); }
    constexpr void remove(Effect effect) { bits_ &= ~(1u << static_cast<unsigned>(effect)); }
    constexpr bool empty() const { return bits_ == 0; }
    constexpr bool full() const { return bits_ == all().bits_; }

  private:
    unsigned bits_ = 0;
};

/// Light of one kind that reaches the camera; what lies between dims it. They add up.
enum class RadianceLayer {
    direct,                ///< lamps on surfaces, and the map where it is seen
    surface_point,         ///< lamps on surfaces by way of the media
    surface_environment,   ///< the map on surfaces, straight or by way of the media
    airlight_point,        ///< lamps, from media that are not Gaussians, slabs among them
    airlight_gaussians,    ///< lamps, from Gaussians
    airlight_environment,  ///< the map, from any medium
    particles,
};

inline constexpr NamedMethod<RadianceLayer> kRadianceLayers[] = {
    {RadianceLayer::direct, "direct"},
    {RadianceLayer::surface_point, "surface.point"},
    {RadianceLayer::surface_environment, "surface.environment"},
    {RadianceLayer::airlight_point, "airlight.point"},
    {RadianceLayer::airlight_gaussians, "airlight.gaussians"},
    {RadianceLayer::airlight_environment, "airlight.environment"},
    {RadianceLayer::particles, "particles"},
};
inline constexpr std::size_t kRadianceLayerCount = std::size(kRadianceLayers);

/// Radiance by layer [W / (m^2 sr)].
struct LayeredRadiance {
    std::array<glm::dvec3, kRadianceLayerCount> layers{};

    glm::dvec3& operator[](RadianceLayer layer) { return layers[static_cast<std::size_t>(layer)]; }
    const glm::dvec3& operator[](RadianceLayer layer) const {
        return layers[static_cast<std::size_t>(layer)];
    }
    glm::dvec3 total() const {
        glm::dvec3 sum(0);
        for (const glm::dvec3& layer : layers) sum += layer;
        return sum;
    }
};

}  // namespace airlight
