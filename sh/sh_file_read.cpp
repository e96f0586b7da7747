// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <system_error>

#include "core/atomic_file.h"
#include "core/constants.h"
#include "core/descriptor.h"
#include "core/error.h"
#include "core/open_input.h"
#include "sh/index.h"
#include "sh/sh_file.h"
#include "sh/sh_file_text.h"

namespace airlight {
namespace {

using Json = nlohmann::json;

// Bytes of memory that parsing takes per byte of the file, at most.
constexpr std::size_t kMemoryPerByte = 32;
// The file's deepest value: a coefficient in its channel's array in "coefficients".
constexpr int kDeepest = 3;
constexpr std::size_t kLongestQuote = 40;
constexpr double kUnitTolerance = 1e-6;

std::string shorten(std::string text) {
    if (text.size() <= kLongestQuote) return text;
    text.resize(kLongestQuote);
    // Not in the middle of a character.
    while (!text.empty() && (text.back() & 0xC0) == 0x80) text.pop_back();
    if (!text.empty() && (text.back() & 0x80) != 0) text.pop_back();
    return text + "...";
}

// A field's name as JSON writes it, without the quotation marks, so that it stays on one line.
std::string escape(const std::string& key) {
    const std::string text = Json(key).dump();
    return shorten(text.substr(1, text.size() - 2));
}

std::string quote(const Json& value) {
    if (value.is_array()) return fmt::format("an array of {} values", value.size());
    if (value.is_object()) return "an object";
    return shorten(value.dump());
}

/// One object of the file and what messages call it.
class Fields {
  public:
    Fields(const Json& object, std::string prefix, std::string file)
        : object_(object), prefix_(std::move(prefix)), file_(std::move(file)) {}

    [[noreturn]] void refuse(const std::string& key, const std::string& sentence) const {
        throw Error(ErrorCode::data, prefix_ + key + " " + sentence, file_);
    }

    [[noreturn]] void refuse_value(const std::string& key, const Json& value,
                                   const std::string& wanted) const {
        refuse(key, "is " + quote(value) + ", not " + wanted);
    }

    void know(std::initializer_list<const char*> keys) const {
        for (const auto& item : object_.items()) {
            if (std::find(keys.begin(), keys.end(), item.key()) == keys.end()) {
                throw Error(ErrorCode::data,
                            "the field " + prefix_ + escape(item.key()) + " is unknown", file_);
            }
        }
    }

    const Json* find(const char* key) const {
        const auto at = object_.find(key);
        return at == object_.end() ? nullptr : &*at;
    }

    const Json& at(const char* key) const {
        if (const Json* value = find(key)) return *value;
        throw Error(ErrorCode::data, "the field " + prefix_ + key + " is missing", file_);
    }

    int integer(const char* key, int low, int high) const {
        const Json& value = at(key);
        const bool fits = value.is_number_integer() &&
                          (value.is_number_unsigned()
                               ? value.get<std::uint64_t>() <= static_cast<std::uint64_t>(high) &&
                                     value.get<std::uint64_t>() >= static_cast<std::uint64_t>(low)
                               : value.get<std::int64_t>() >= low);
        if (!fits) refuse_value(key, value, fmt::format("an integer in [{}, {}]", low, high));
        return value.get<int>();
    }

    double number(const std::string& key, const Json& value, double low, double high) const {
        if (!value.is_number() || !(value.get<double>() >= low && value.get<double>() <= high)) {
            constexpr double kLargest = std::numeric_limits<double>::max();
            refuse_value(key, value,
                         low == -kLargest   ? "a number"
                         : high == kLargest ? fmt::format("a number >= {}", low)
                                            : fmt::format("a number in [{}, {}]", low, high));
        }
        return value.get<double>();
    }

    std::vector<double> channels(const char* key, double low, double high) const {
        const Json& value = at(key);
        if (!value.is_array() || (value.size() != 1 && value.size() != 3)) {
            refuse_value(key, value, "an array of one number or three");
        }
        return all_of(key, value, low, high);
    }

    std::vector<double> numbers(const char* key, std::size_t count, double low, double high) const {
        const Json& value = at(key);
        if (!value.is_array() || value.size() != count) {
            refuse_value(key, value, fmt::format("an array of {} numbers", count));
        }
        return all_of(key, value, low, high);
    }

    std::string text(const char* key) const {
        const Json& value = at(key);
        if (!value.is_string()) refuse_value(key, value, "a text");
        return value.get<std::string>();
    }

    void expect(const char* key, const char* known) const {
        const Json& value = at(key);
        if (value != known) refuse_value(key, value, fmt::format("\"{}\"", known));
    }

    Fields inner(const char* key) const {
        const Json& value = at(key);
        if (!value.is_object()) refuse_value(key, value, "an object");
        return Fields(value, prefix_ + key + ".", file_);
    }

  private:
    std::vector<double> all_of(const char* key, const Json& array, double low, double high) const {
        std::vector<double> numbers;
        for (std::size_t i = 0; i < array.size(); ++i) {
            numbers.push_back(number(fmt::format("{}[{}]", key, i), array[i], low, high));
        }
        return numbers;
    }

    const Json& object_;
    std::string prefix_, file_;
};

constexpr double kAny = std::numeric_limits<double>::max();

/// Parses, and refuses fields given twice and depths that no coefficient file has.
Json parse(const std::string& text, const std::string& name) {
    std::vector<std::set<std::string>> keys;
    const Json::parser_callback_t watch = [&](int depth, Json::parse_event_t event, Json& value) {
        using Event = Json::parse_event_t;
        if ((event == Event::object_start || event == Event::array_start) && depth >= kDeepest) {
            throw Error(ErrorCode::data, fmt::format("is nested more than {} deep", kDeepest),
                        name);
        }
        if (event == Event::object_start) keys.emplace_back();
        if (event == Event::object_end) keys.pop_back();
        if (event == Event::key && !keys.back().insert(value.get<std::string>()).second) {
            throw Error(ErrorCode::data,
                        "the field " + escape(value.get<std::string>()) + " is given twice", name);
        }
        return true;
    };
    try {
        return Json::parse(text, watch);
    } catch (const Json::parse_error& error) {
        const std::size_t byte = std::min(error.byte == 0 ? 0 : error.byte - 1, text.size());
        if (text.find_last_not_of(" \t\r\n") == std::string::npos || byte >= text.size()) {
            throw Error(ErrorCode::data, "is no whole JSON: it ends too early", name);
        }
        const auto line =
            std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(byte), '\n');
        throw Error(ErrorCode::data, fmt::format("is no JSON: line {} cannot be read", line + 1),
                    name);
    } catch (const Json::out_of_range& error) {
        const std::string message = error.what();
        const std::size_t begin = message.find('\'');
        const std::string number = begin == std::string::npos
                                       ? "a number"
                                       : message.substr(begin + 1, message.rfind('\'') - begin - 1);
        throw Error(ErrorCode::data, shorten(number) + " is beyond 1.8e308, the largest number",
                    name);
    }
}

std::vector<double> coefficients_of(const Fields& fields, int order) {
    const Json& rows = fields.at("coefficients");
    const std::size_t channels = detail::kShChannels.size(), count = sh_count(order);
    if (!rows.is_array() || rows.size() != channels) {
        fields.refuse_value("coefficients", rows, "an array of 3 arrays, for R, G and B");
    }
    std::vector<double> values;
    for (std::size_t c = 0; c < channels; ++c) {
        const std::string row = fmt::format("coefficients[{}]", c);
        if (!rows[c].is_array() || rows[c].size() != count) {
            fields.refuse_value(row, rows[c],
                                fmt::format("an array of {} numbers, for order {}", count, order));
        }
        for (std::size_t i = 0; i < count; ++i) {
            values.push_back(fields.number(fmt::format("{}[{}]", row, i), rows[c][i], -kAny, kAny));
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

ShFileFog fog_of(const Fields& fields) {
    fields.know({"optical_thickness", "albedo", "phase"});
    ShFileFog fog;
    fog.optical_thickness = fields.channels("optical_thickness", 0, kAny);
    fog.albedo = fields.channels("albedo", 0, 1);
    fog.phase = fields.text("phase");
    if (!is_phase(fog.phase)) {
        fields.refuse_value("phase", fog.phase, "isotropic, rayleigh, hg:G or table");
    }
    return fog;
}

ShFileWindow window_of(const Fields& fields, int order) {
    ShFileWindow window;
    window.name = fields.text("name");
    const bool bands = window.name == "bands", automatic = window.name == "auto";
    if (window.name == "hann" || window.name == "lanczos") {
        fields.know({"name"});
        return window;
    }
    if (!bands && !automatic && window.name != "nearest") {
        fields.refuse_value("name", window.name, "hann, lanczos, auto, bands or nearest");
    }
    window.least = fields.number("least", fields.at("least"), -kAny, kAny);
    if (automatic) {
        fields.know({"name", "least", "strength"});
        window.strength = fields.number("strength", fields.at("strength"), 0, kAny);
    } else if (bands) {
        fields.know({"name", "least", "factors"});
        window.factors = fields.numbers("factors", static_cast<std::size_t>(order), 0, 1);
    } else {
        fields.know({"name", "least"});
    }
    return window;
}

std::array<double, 3> three_of(const Fields& fields, const char* key, double low, double high) {
    const std::vector<double> values = fields.channels(key, low, high);
    if (values.size() != 3) fields.refuse(key, "holds one number, not 3");
    return {values[0], values[1], values[2]};
}

ShFileSun sun_of(const Fields& fields) {
    fields.know({"direction", "irradiance", "angular_radius"});
    ShFileSun sun;
    sun.direction = three_of(fields, "direction", -1, 1);
    const auto [x, y, z] = sun.direction;
    const double length = std::sqrt(x * x + y * y + z * z);
    if (std::abs(length - 1) > kUnitTolerance) {
        fields.refuse("direction", fmt::format("has the length {}, not 1", length));
    }
    sun.irradiance = three_of(fields, "irradiance", 0, kAny);
    sun.angular_radius = fields.number("angular_radius", fields.at("angular_radius"), 0, kPi / 2);
    return sun;
}

std::string read_all(int descriptor, std::size_t limit, const std::string& name) {
    std::string text;
    std::vector<char> block(std::size_t{1} << 16);
    for (;;) {
        const ssize_t got = read(descriptor, block.data(), block.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            throw Error(ErrorCode::io, "cannot be read: " + system_message(errno), name);
        }
        if (got == 0) return text;
        text.append(block.data(), static_cast<std::size_t>(got));
        if (text.size() > limit) {
            throw Error(ErrorCode::memory,
                        fmt::format("holds more than {}, which is what the limit on memory leaves "
                                    "for a coefficient file (--max-memory)",
                                    format_bytes(limit)),
                        name);
        }
    }
}

}  // namespace

ShFile parse_sh_file(const std::string& text, const std::string& name) {
    if (text.empty()) throw Error(ErrorCode::data, "is empty", name);
    const Json json = parse(text, name);
    if (!json.is_object() || !json.contains("airlight_sh")) {
        throw Error(ErrorCode::data, "is no coefficient file: the field airlight_sh is missing",
                    name);
    }
    const Fields fields(json, "", name);
    if (json["airlight_sh"] != detail::kShFileVersion) {
        fields.refuse_value("airlight_sh", json["airlight_sh"],
                            fmt::format("version {}, the only one known", detail::kShFileVersion));
    }
    fields.know({"airlight_sh", "quantity", "unit", "convention", "frame", "channels", "order",
                 "map", "fog", "window", "sun", "coefficients"});
    fields.expect("quantity", detail::kShQuantity);
    fields.expect("unit", detail::kShUnit);
    fields.expect("convention", detail::kShConvention);
    fields.expect("frame", detail::kShFrame);
    if (fields.at("channels") != Json(detail::kShChannels)) {
        fields.refuse_value("channels", fields.at("channels"), "[\"R\", \"G\", \"B\"]");
    }
    ShFile file;
    file.order = fields.integer("order", 1, kLargestShFileOrder);
    file.coefficients = coefficients_of(fields, file.order);
    constexpr int kLargestSize = std::numeric_limits<int>::max();
    if (fields.find("map") != nullptr) {
        const Fields map = fields.inner("map");
        map.know({"width", "height"});
        file.map = ShFileMap{map.integer("width", 1, kLargestSize),
                             map.integer("height", 1, kLargestSize)};
    }
    if (fields.find("fog") != nullptr) file.fog = fog_of(fields.inner("fog"));
    if (fields.find("window") != nullptr)
        file.window = window_of(fields.inner("window"), file.order);
    if (fields.find("sun") != nullptr) file.sun = sun_of(fields.inner("sun"));
    return file;
}

ShFile read_sh_file(const std::string& path, std::size_t max_memory) {
    const OpenInput input = open_input(path, "a coefficient file");
    return parse_sh_file(
        read_all(input.descriptor.get(), max_memory / (1 + kMemoryPerByte), input.name),
        input.name);
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
