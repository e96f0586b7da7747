// SPDX-License-Identifier: Apache-2.0
// Numbers out of bytes that lie anywhere and in either order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace airlight::detail {

/// The unsigned number of `size` (1, 2, 4 or 8) bytes at `bytes`.
inline std::uint64_t load_unsigned(const char* bytes, std::size_t size, bool big_endian) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const auto byte = static_cast<unsigned char>(bytes[big_endian ? size - 1 - i : i]);
        value |= std::uint64_t{byte} << (8 * i);
    }
    return value;
}

inline float load_float(const char* bytes, bool big_endian) {
    const auto bits = static_cast<std::uint32_t>(load_unsigned(bytes, 4, big_endian));
    float value = 0;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
}

inline double load_double(const char* bytes, bool big_endian) {
    const std::uint64_t bits = load_unsigned(bytes, 8, big_endian);
    double value = 0;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
}

/// Writes the number as `size` bytes, the least significant first.
inline void store_unsigned(std::uint64_t value, std::size_t size, char* bytes) {
    for (std::size_t i = 0; i < size; ++i) {
        bytes[i] = static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
    }
}

inline std::uint32_t bits_of(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    return bits;
}

inline std::uint64_t bits_of(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    return bits;
}

}  // namespace airlight::detail
