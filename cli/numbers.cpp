// SPDX-License-Identifier: Apache-2.0
#include "cli/numbers.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include "core/error.h"

namespace airlight {
namespace {

// from_chars is used for its independence of the locale; it refuses "0x" and white space by itself.
std::optional<double> finite_number(const std::string& text) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::string describe(const NumberRange& range) {
    if (std::isinf(range.high)) {
        return fmt::format("a finite number {} {}", range.low_open ? ">" : ">=", range.low);
    }
    return fmt::format("a number in {}{}, {}{}", range.low_open ? '(' : '[', range.low, range.high,
                       range.high_open ? ')' : ']');
}

bool contains(const NumberRange& range, double value) {
    return (range.low_open ? value > range.low : value >= range.low) &&
           (range.high_open ? value < range.high : value <= range.high);
}

}  // namespace

double parse_number(const std::string& text, const std::string& flag, const NumberRange& range) {
    const std::optional<double> value = finite_number(text);
    if (!value || !contains(range, *value)) {
        throw Error(ErrorCode::usage, fmt::format("'{}' is not {}", text, describe(range)), flag);
    }
    return *value;
}

std::vector<double> parse_channels(const std::string& text, const std::string& flag,
                                   const NumberRange& range) {
    std::vector<double> values;
    for (std::size_t begin = 0;;) {
        const std::size_t comma = text.find(',', begin);
        values.push_back(parse_number(text.substr(begin, comma - begin), flag, range));
        if (comma == std::string::npos) break;
        begin = comma + 1;
    }
    if (values.size() != 1 && values.size() != 3) {
        throw Error(
            ErrorCode::usage,
            fmt::format("'{}' has {} values, and it takes 1 or 3 (R,G,B)", text, values.size()),
            flag);
    }
    return values;
}

int parse_integer(const std::string& text, const std::string& flag, int low, int high) {
    int value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || value < low || value > high) {
        throw Error(ErrorCode::usage,
                    fmt::format("'{}' is not an integer in [{}, {}]", text, low, high), flag);
    }
    return value;
}

std::size_t parse_size(const std::string& text, const std::string& flag) {
    const std::size_t digits = text.find_first_not_of("0123456789.");
    std::string unit = digits == std::string::npos ? "" : text.substr(digits);
    for (char& c : unit) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    int power = -1;
    if (unit.empty() || unit == "b") power = 0;
    for (int i = 0; i < 4; ++i) {
        const std::string letter(1, "kmgt"[i]);
        if (unit == letter || unit == letter + "b" || unit == letter + "ib") power = i + 1;
    }
    const std::optional<double> number = finite_number(text.substr(0, digits));
    const double bytes = number.value_or(0) * std::pow(1024.0, power);
    if (power < 0 || !(bytes >= 1) || bytes >= 0x1p63) {
        throw Error(
            ErrorCode::usage,
            fmt::format("'{}' is not a size from 1 byte up such as 512M, 2G or 1048576", text),
            flag);
    }
    return static_cast<std::size_t>(bytes);
}

int parse_choice(const std::string& text, const std::string& flag,
                 const std::vector<std::string>& choices) {
    for (std::size_t i = 0; i < choices.size(); ++i) {
        if (text == choices[i]) return static_cast<int>(i);
    }
    throw Error(ErrorCode::usage,
                fmt::format("'{}' is unknown; it can be {}", text, list_choices(choices)), flag);
}

int parse_choice(const std::string& text, const std::string& flag,
                 std::initializer_list<const char*> choices) {
    return parse_choice(text, flag, std::vector<std::string>(choices.begin(), choices.end()));
}

std::string list_choices(const std::vector<std::string>& choices) {
    std::string list;
    for (std::size_t i = 0; i < choices.size(); ++i) {
        list += (i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ") + choices[i];
    }
    return list;
}

}  // namespace airlight
