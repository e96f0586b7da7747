// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "envmap/engine_light.h"

namespace airlight {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kChannels = 3;

// Two by two black pixels without alpha, as PNG.
constexpr const char* kBlackPicture =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAIAAAD91JpzAAAAC0lEQVR42mNgQAYAAA4AATo1"
    "BFYAAAAASUVORK5CYII=";
constexpr int kPictureSize = 2;
constexpr const char* kExtension = "EXT_lights_image_based";

const EngineSh& require_floats(const EngineSh& light) {
    for (const auto& rgb : light) {
        for (const double value : rgb) {
            if (!(std::abs(value) <= std::numeric_limits<float>::max())) {
                throw Error(
                    ErrorCode::data,
                    fmt::format("gives the coefficient {}, beyond 3.4e38, which is what the "
                                "floats of engines hold",
                                value));
            }
        }
    }
    return light;
}

Json channel_of(const EngineSh& light, std::size_t channel) {
    Json row;
    for (const auto& value : light) row.push_back(value[channel]);
    return row;
}

Json three_json(const EngineSh& light) {
    Json json = {{"type", "LightProbe"}, {"intensity", 1}};
    for (const auto& rgb : light) {
        for (const double value : rgb) json["sh"].push_back(value);
    }
    return json;
}

Json unity_json(const EngineSh& light) {
    Json json;
    for (std::size_t c = 0; c < kChannels; ++c) {
        json["SphericalHarmonicsL2"].push_back(channel_of(light, c));
    }
    return json;
}

Json unreal_json(const EngineSh& light) {
    return {
        {"FSHVectorRGB3",
         {{"R", channel_of(light, 0)}, {"G", channel_of(light, 1)}, {"B", channel_of(light, 2)}}},
        {"SkyIrradianceEnvironmentMap", unreal_sky_vectors(light)}};
}

Json gltf_json(const EngineSh& light) {
    Json lamp = {{"name", "environment"},
                 {"rotation", {0, 0, 0, 1}},
                 {"intensity", 1},
                 {"irradianceCoefficients", light},
                 {"specularImageSize", kPictureSize}};
    lamp["specularImages"].push_back(std::vector<int>(6, 0));
    Json scene;
    scene["extensions"][kExtension]["light"] = 0;
    Json asset = {{"asset", {{"version", "2.0"}, {"generator", "airlight " AIRLIGHT_VERSION}}}};
    asset["extensionsUsed"].push_back(kExtension);
    asset["extensions"][kExtension]["lights"].push_back(lamp);
    asset["images"].push_back({{"name", "black: no specular light"}, {"uri", kBlackPicture}});
    asset["scene"] = 0;
    asset["scenes"].push_back(scene);
    return asset;
}

}  // namespace

std::string engine_text(EngineFormat format, int order, const std::vector<double>& coefficients) {
    Json json;
    switch (format) {
        case EngineFormat::filament:
            return filament_text(require_floats(filament_light(order, coefficients)));
        case EngineFormat::three:
            json = three_json(require_floats(three_light(order, coefficients)));
            break;
        case EngineFormat::unity:
            json = unity_json(require_floats(unity_light(order, coefficients)));
            break;
        case EngineFormat::unreal:
            json = unreal_json(require_floats(unreal_light(order, coefficients)));
            break;
        case EngineFormat::gltf:
            json = gltf_json(require_floats(gltf_light(order, coefficients)));
            break;
    }
    return json.dump(2) + "\n";
}

}  // namespace airlight
