// SPDX-License-Identifier: Apache-2.0
#include "cli/engine_flags.h"

#include <spdlog/spdlog.h>

#include <cmath>

#include "cli/numbers.h"
#include "core/constants.h"

namespace airlight {

std::optional<EngineFormat> parse_engine(const std::string& text, const std::string& flag,
                                         bool json) {
    if (json) {
        const int choice =
            parse_choice(text, flag, {"json", "filament", "three", "unity", "unreal", "gltf"});
        if (choice == 0) return std::nullopt;
        return static_cast<EngineFormat>(choice - 1);
    }
    return static_cast<EngineFormat>(
        parse_choice(text, flag, {"filament", "three", "unity", "unreal", "gltf"}));
}

void add_turn_flag(const Command& command, EngineFlags& flags) {
    add_flag(
        command, "--turn", "DEGREES",
        "For engines: turn the light about +Y first, +X towards -Z (90 for three.js beside the "
        "map as its background, and for Unity beside meshes from glTF; default: 0)",
        [&](const std::string& text) {
            flags.turn = parse_number(text, "--turn", {-360, 360});
        });
}

void warn_of_sun(const EngineFlags& flags, const ShFileSun& sun, const std::string& output) {
    const auto [x, y, z] = sun.direction;
    const double angle = flags.turn.value_or(0) * kPi / 180;
    const std::array<double, 3> turned = {std::cos(angle) * x + std::sin(angle) * z, y,
                                          std::cos(angle) * z - std::sin(angle) * x};
    const std::array<double, 3> there = engine_direction(*flags.format, turned);
    spdlog::warn(
        "{}: the sun is no part of it: it stands at ({:.6g}, {:.6g}, {:.6g}) in the engine's axes, "
        "irradiance ({:.6g}, {:.6g}, {:.6g}), angular radius {:.4g} degrees",
        output == "-" ? "standard output" : output, there[0], there[1], there[2], sun.irradiance[0],
        sun.irradiance[1], sun.irradiance[2], sun.angular_radius * 180 / kPi);
}

std::string engine_text(const EngineFlags& flags, int order,
                        const std::vector<double>& coefficients) {
    if (!flags.turn) return engine_text(*flags.format, order, coefficients);
    return engine_text(*flags.format, order, turned_about_up(order, coefficients, *flags.turn));
}

}  // namespace airlight
