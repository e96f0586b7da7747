// SPDX-License-Identifier: Apache-2.0
// What sh and export have in common: the formats of engines.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "envmap/engine_light.h"
#include "sh/sh_file.h"

namespace airlight {

struct EngineFlags {
    std::optional<EngineFormat> format;
    std::optional<double> turn;  ///< degrees
};

/// What the formats hold, for --help.
inline constexpr const char* kEngineFormatHelp =
    "filament: irradiance as sh.txt of cmgen; three: LightProbe; unity: SphericalHarmonicsL2; "
    "unreal: FSHVectorRGB3 and SkyIrradianceEnvironmentMap; gltf: an asset with "
    "EXT_lights_image_based, irradiance in the basis of the papers that its text cites (which "
    "leaves the sign of odd m open; Babylon.js expects the other one), its specular images black";

/// The format of that name; none for "json", which `json` allows. Throws Error(usage).
std::optional<EngineFormat> parse_engine(const std::string& text, const std::string& flag,
                                         bool json);

/// --turn.
void add_turn_flag(const Command& command, EngineFlags& flags);

/// Warns that a sun which was taken out is no part of what is written, and says where it is there.
void warn_of_sun(const EngineFlags& flags, const ShFileSun& sun, const std::string& output);

/// engine_text of the light turned as asked; flags.format must be there.
std::string engine_text(const EngineFlags& flags, int order,
                        const std::vector<double>& coefficients);

}  // namespace airlight
