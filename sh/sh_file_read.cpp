// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/constants.h"
#include "core/descriptor.h"
#include "core/error.h"
#include "core/json_fields.h"
#include "core/read_text.h"
#include "sh/index.h"
#include "sh/sh_file.h"
#include "sh/sh_file_text.h"

namespace airlight {
namespace {

// The file's deepest value: a coefficient in its channel's array in "coefficients".
constexpr int kDeepest = 3;
constexpr double kUnitTolerance = 1e-6;

void expect(const JsonFields& fields, const char* key, const char* known) {
    if (fields.at(key).text() != known) {
        fields.refuse_value(key, fields.at(key), fmt::format("\"{}\"", known));
    }
}

void expect_channels(const JsonFields& fields) {
    const JsonValue& value = fields.at("channels");
    const auto is_name = [](const JsonValue& item, const char* name) {
        return item.text() == name;
    };
    if (!std::equal(value.items().begin(), value.items().end(), detail::kShChannels.begin(),
                    detail::kShChannels.end(), is_name)) {
        fields.refuse_value("channels", value, "[\"R\", \"G\", \"B\"]");
    }
}

std::vector<double> coefficients_of(const JsonFields& fields, int order) {
    const JsonValue& rows = fields.at("coefficients");
    const std::size_t channels = detail::kShChannels.size(), count = sh_count(order);
    if (rows.kind() != JsonValue::Kind::array || rows.items().size() != channels) {
        fields.refuse_value("coefficients", rows, "an array of 3 arrays, for R, G and B");
    }
    std::vector<double> values;
    for (std::size_t c = 0; c < channels; ++c) {
        const JsonValue& row = rows.items()[c];
        const std::string key = fmt::format("coefficients[{}]", c);
        if (row.kind() != JsonValue::Kind::array || row.items().size() != count) {
            fields.refuse_value(key, row,
                                fmt::format("an array of {} numbers, for order {}", count, order));
        }
        for (std::size_t i = 0; i < count; ++i) {
            values.push_back(fields.number_of(fmt::format("{}[{}]", key, i), row.items()[i],
                                              -kAnyNumber, kAnyNumber));
        }
    }
    return values;
}

/// The names that `airlight sh` writes; G is in (-1, 1).
bool is_phase(const std::string& name) {
    if (name.rfind("hg:", 0) != 0) {
        return name == "isotropic" || name == "rayleigh" || name == "table";
    }
    double g = 0;
    const char* end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data() + 3, end, g);
    return error == std::errc() && stop == end && g > -1 && g < 1;
}

ShFileFog fog_of(const JsonFields& fields) {
    fields.know({"optical_thickness", "albedo", "phase"});
    ShFileFog fog;
    fog.optical_thickness = fields.channels("optical_thickness", 0, kAnyNumber);
    fog.albedo = fields.channels("albedo", 0, 1);
    fog.phase = fields.text("phase");
    if (!is_phase(fog.phase)) {
        fields.refuse_value("phase", fields.at("phase"), "isotropic, rayleigh, hg:G or table");
    }
    return fog;
}

ShFileWindow window_of(const JsonFields& fields, int order) {
    ShFileWindow window;
    fields.choice("name", {"hann", "lanczos", "auto", "bands", "nearest"});
    window.name = fields.text("name");
    if (window.name == "hann" || window.name == "lanczos") {
        fields.know({"name"});
        return window;
    }
    window.least = fields.number("least");
    if (window.name == "auto") {
        fields.know({"name", "least", "strength"});
        window.strength = fields.number("strength", 0);
    } else if (window.name == "bands") {
        fields.know({"name", "least", "factors"});
        window.factors = fields.numbers("factors", static_cast<std::size_t>(order), 0, 1);
    } else {
        fields.know({"name", "least"});
    }
    return window;
}

std::array<double, 3> three_of(const JsonFields& fields, const char* key, double low, double high) {
    const std::vector<double> values = fields.channels(key, low, high);
    if (values.size() != 3) fields.refuse(key, "holds one number, not 3");
    return {values[0], values[1], values[2]};
}

ShFileSun sun_of(const JsonFields& fields) {
    fields.know({"direction", "irradiance", "angular_radius"});
    ShFileSun sun;
    sun.direction = three_of(fields, "direction", -1, 1);
    const auto [x, y, z] = sun.direction;
    const double length = std::sqrt(x * x + y * y + z * z);
    if (std::abs(length - 1) > kUnitTolerance) {
        fields.refuse("direction", fmt::format("has the length {}, not 1", length));
    }
    sun.irradiance = three_of(fields, "irradiance", 0, kAnyNumber);
    sun.angular_radius = fields.number("angular_radius", 0, kPi / 2);
    return sun;
}

}  // namespace

ShFile parse_sh_file(const std::string& text, const std::string& name) {
    const JsonValue json = parse_json(text, name, kDeepest);
    const JsonFields fields =
        versioned_fields(json, "airlight_sh", detail::kShFileVersion, "coefficient file", name);
    fields.know({"airlight_sh", "quantity", "unit", "convention", "frame", "channels", "order",
                 "map", "fog", "window", "sun", "coefficients"});
    expect(fields, "quantity", detail::kShQuantity);
    expect(fields, "unit", detail::kShUnit);
    expect(fields, "convention", detail::kShConvention);
    expect(fields, "frame", detail::kShFrame);
    expect_channels(fields);
    ShFile file;
    file.order = fields.integer("order", 1, kLargestShFileOrder);
    file.coefficients = coefficients_of(fields, file.order);
    constexpr int kLargestSize = std::numeric_limits<int>::max();
    if (fields.has("map")) {
        const JsonFields map = fields.object("map");
        map.know({"width", "height"});
        file.map = ShFileMap{map.integer("width", 1, kLargestSize),
                             map.integer("height", 1, kLargestSize)};
    }
    if (fields.has("fog")) file.fog = fog_of(fields.object("fog"));
    if (fields.has("window")) file.window = window_of(fields.object("window"), file.order);
    if (fields.has("sun")) file.sun = sun_of(fields.object("sun"));
    return file;
}

ShFile read_sh_file(const std::string& path, std::size_t max_memory) {
    const std::string text =
        read_text(path, "a coefficient file", max_memory / (1 + kJsonTreeBytes));
    return parse_sh_file(text, path == "-" ? "standard input" : path);
}

bool is_json_file(const std::string& path) {
    const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
    char start[64];
    const ssize_t got = file.get() < 0 ? 0 : pread(file.get(), start, sizeof start, 0);
    // A byte order mark is no part of the text, for the parser, too.
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    const bool marked = got >= 3 && std::string_view(start, 3) == kMark;
    for (ssize_t i = marked ? 3 : 0; i < got; ++i) {
        if (start[i] != ' ' && start[i] != '\n' && start[i] != '\t' && start[i] != '\r') {
            return start[i] == '{';
        }
    }
    return false;
}

}  // namespace airlight
