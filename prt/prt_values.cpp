// SPDX-License-Identifier: Apache-2.0
#include "prt/prt_values.h"

#include <Imath/half.h>

#include <array>
#include <cmath>
#include <type_traits>

namespace airlight::detail {
namespace {

constexpr std::uint32_t kExponent = 0x7f800000;
// Independent sums, so that the compiler may use vectors; they are combined in their order.
constexpr std::size_t kLanes = 8;

/// The smallest and the largest value of a chunk, which has at least one.
template <class T>
void find_range(const T* values, std::size_t count, ChunkFigures& figures) {
    std::array<T, kLanes> low, high;
    low.fill(values[0]);
    high.fill(values[0]);
    const std::size_t whole = count / kLanes * kLanes;
    for (std::size_t i = 0; i < whole; i += kLanes) {
        for (std::size_t k = 0; k < kLanes; ++k) {
            const T v = values[i + k];
            low[k] = v < low[k] ? v : low[k];
            high[k] = v > high[k] ? v : high[k];
        }
    }
    for (std::size_t i = whole; i < count; ++i) {
        low[0] = std::min(low[0], values[i]);
        high[0] = std::max(high[0], values[i]);
    }
    figures.minimum = static_cast<double>(*std::min_element(low.begin(), low.end()));
    figures.maximum = static_cast<double>(*std::max_element(high.begin(), high.end()));
}

std::optional<std::size_t> find_nonfinite(const float* values, std::size_t count) {
    std::uint32_t found = 0;
    for (std::size_t i = 0; i < count; ++i) {
        found |= static_cast<std::uint32_t>((bits_of(values[i]) & kExponent) == kExponent);
    }
    if (found == 0) return std::nullopt;
    return static_cast<std::size_t>(
        std::find_if(values, values + count, [](float v) { return !std::isfinite(v); }) - values);
}

std::optional<std::size_t> find_beyond(const std::uint32_t* values, std::size_t count,
                                       std::uint64_t limit) {
    const std::uint32_t* found =
        std::find_if(values, values + count, [&](std::uint32_t v) { return v >= limit; });
    if (found == values + count) return std::nullopt;
    return static_cast<std::size_t>(found - values);
}

void store_words(const std::uint32_t* words, std::size_t count, char* bytes) {
    for (std::size_t i = 0; i < count; ++i) store_unsigned(words[i], 4, bytes + 4 * i);
}

}  // namespace

std::optional<std::size_t> store_values(const float* values, std::size_t count, PrtType type,
                                        char* bytes, ChunkFigures& figures) {
    figures = {};
    if (count == 0) return std::nullopt;
    if (const auto bad = find_nonfinite(values, count)) return bad;
    if (type == PrtType::float32) {
        for (std::size_t i = 0; i < count; ++i) {
            store_unsigned(bits_of(values[i]), 4, bytes + 4 * i);
        }
        find_range(values, count, figures);
        return std::nullopt;
    }
    figures.minimum = figures.maximum = half(values[0]);
    for (std::size_t i = 0; i < count; ++i) {
        const half rounded(values[i]);
        if (rounded.isInfinity()) return i;
        store_unsigned(rounded.bits(), 2, bytes + 2 * i);
        const double stored = rounded;
        const double error = std::fabs(stored - static_cast<double>(values[i]));
        figures.minimum = std::min(figures.minimum, stored);
        figures.maximum = std::max(figures.maximum, stored);
        figures.largest_error = std::max(figures.largest_error, error);
        figures.squared_error += error * error;
    }
    return std::nullopt;
}

std::optional<std::size_t> load_values(const char* bytes, std::size_t count, PrtType type,
                                       float* values) {
    if (type == PrtType::float32) {
        for (std::size_t i = 0; i < count; ++i) values[i] = load_float(bytes + 4 * i, false);
    } else {
        for (std::size_t i = 0; i < count; ++i) {
            half value;
            value.setBits(static_cast<std::uint16_t>(load_unsigned(bytes + 2 * i, 2, false)));
            values[i] = value;
        }
    }
    return find_nonfinite(values, count);
}

std::optional<std::size_t> store_integers(const std::uint32_t* values, std::size_t count,
                                          std::uint64_t limit, char* bytes, ChunkFigures& figures) {
    figures = {};
    if (count == 0) return std::nullopt;
    if (const auto bad = find_beyond(values, count, limit)) return bad;
    store_words(values, count, bytes);
    find_range(values, count, figures);
    return std::nullopt;
}

std::optional<std::size_t> load_integers(const char* bytes, std::size_t count, std::uint64_t limit,
                                         std::uint32_t* values) {
    for (std::size_t i = 0; i < count; ++i) {
        values[i] = static_cast<std::uint32_t>(load_unsigned(bytes + 4 * i, 4, false));
    }
    return find_beyond(values, count, limit);
}

}  // namespace airlight::detail
