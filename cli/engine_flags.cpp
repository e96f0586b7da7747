// SPDX-License-Identifier: Apache-2.0
#include "cli/engine_flags.h"

#include "cli/numbers.h"

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

std::string engine_text(const EngineFlags& flags, int order,
                        const std::vector<double>& coefficients) {
    if (!flags.turn) return engine_text(*flags.format, order, coefficients);
    return engine_text(*flags.format, order, turned_about_up(order, coefficients, *flags.turn));
}

}  // namespace airlight
