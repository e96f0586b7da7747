// SPDX-License-Identifier: Apache-2.0
#include "sh/sh_file.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "core/atomic_file.h"
#include "sh/index.h"
#include "sh/sh_file_text.h"

namespace airlight {
namespace {

std::string number(double value) {
    // JSON's -0 is an integer to many readers, which loses the sign.
    return value == 0 && std::signbit(value) ? "-0.0" : fmt::format("{}", value);
}

template <class Values>
std::string list(const Values& values) {
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : ", ") + number(value);
    return "[" + text + "]";
}

// One degree to a line.
std::string rows_of(const ShFile& file, std::size_t channel) {
    const std::size_t count = sh_count(file.order);
    std::string text;
    for (std::size_t i = 0; i < count; ++i) {
        const double value = file.coefficients[channel * count + i];
        assert(std::isfinite(value));
        const ShDegree at = sh_degree(i);
        text += at.m == -at.l ? (i == 0 ? "\n     " : ",\n     ") : ", ";
        text += number(value);
    }
    return text;
}

}  // namespace

std::string sh_file_text(const ShFile& file) {
    assert(file.coefficients.size() == detail::kShChannels.size() * sh_count(file.order));
    std::string text = fmt::format(
        "{{\n  \"airlight_sh\": {},\n  \"quantity\": \"{}\",\n  \"unit\": \"{}\",\n"
        "  \"convention\": \"{}\",\n  \"frame\": \"{}\",\n  \"channels\": [\"R\", \"G\", \"B\"],\n"
        "  \"order\": {}",
        detail::kShFileVersion, detail::kShQuantity, detail::kShUnit, detail::kShConvention,
        detail::kShFrame, file.order);
    if (file.map) {
        text += fmt::format(",\n  \"map\": {{\"width\": {}, \"height\": {}}}", file.map->width,
                            file.map->height);
    }
    if (file.fog) {
        text += fmt::format(
            ",\n  \"fog\": {{\"optical_thickness\": {}, \"albedo\": {}, \"phase\": \"{}\"}}",
            list(file.fog->optical_thickness), list(file.fog->albedo), file.fog->phase);
    }
    if (file.window) {
        text += fmt::format(",\n  \"window\": {{\"name\": \"{}\"", file.window->name);
        const bool bands = file.window->name == "bands", automatic = file.window->name == "auto";
        if (bands || automatic || file.window->name == "nearest") {
            text += fmt::format(", \"least\": {}", number(file.window->least));
        }
        if (automatic) text += fmt::format(", \"strength\": {}", number(file.window->strength));
        if (bands) text += fmt::format(", \"factors\": {}", list(file.window->factors));
        text += "}";
    }
    if (file.sun) {
        text += fmt::format(
            ",\n  \"sun\": {{\"direction\": {}, \"irradiance\": {}, \"angular_radius\": {}}}",
            list(file.sun->direction), list(file.sun->irradiance),
            number(file.sun->angular_radius));
    }
    text += ",\n  \"coefficients\": [";
    for (std::size_t c = 0; c < detail::kShChannels.size(); ++c) {
        text += (c == 0 ? "\n    [" : ",\n    [") + rows_of(file, c) + "]";
    }
    return text + "\n  ]\n}\n";
}

void write_sh_file(const std::string& path, const ShFile& file, bool force) {
    write_file_atomically(path, sh_file_text(file), force);
}

}  // namespace airlight
