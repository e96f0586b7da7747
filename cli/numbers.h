// SPDX-License-Identifier: Apache-2.0
// Values of flags, parsed strictly: the whole text, decimal, within the flag's limits.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

namespace airlight {

/// The numbers that a flag takes. Infinite ends are never part of it.
struct NumberRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_open = false;
    bool high_open = false;
};

inline constexpr NumberRange kNotNegative = {0};
inline constexpr NumberRange kPositive = {0, std::numeric_limits<double>::infinity(), true};

/// The finite decimal number that is all of `text`. Throws Error(usage) with the flag's name, the
/// value and the limits; so do the others.
double parse_number(const std::string& text, const std::string& flag, const NumberRange& range);

/// One number, or three separated by commas, for R, G and B.
std::vector<double> parse_channels(const std::string& text, const std::string& flag,
                                   const NumberRange& range);

int parse_integer(const std::string& text, const std::string& flag, int low, int high);

/// Bytes, with an optional unit K, M, G or T (also KiB, kB …; all of them powers of 1024).
std::size_t parse_size(const std::string& text, const std::string& flag);

/// The index of `text` among the choices.
int parse_choice(const std::string& text, const std::string& flag,
                 const std::vector<std::string>& choices);
int parse_choice(const std::string& text, const std::string& flag,
                 std::initializer_list<const char*> choices);

/// "a, b or c".
std::string list_choices(const std::vector<std::string>& choices);

}  // namespace airlight
