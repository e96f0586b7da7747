// SPDX-License-Identifier: Apache-2.0
// What a PLY file says about itself.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "prt/raw_mesh.h"

namespace airlight::detail {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of a number in a binary file.
std::size_t ply_size(PlyType type);
inline bool is_integer(PlyType type) {
    return type < PlyType::float32;
}

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    bool is_list = false;
    PlyType count_type = PlyType::uint8;  ///< of a list
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;

    /// The least that one row takes: bytes in a binary file, words in a text.
    std::size_t least_bytes() const;
    bool has_list() const;
    /// The place of a property, or the number of properties.
    std::size_t find(std::string_view property) const;
};

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
    std::size_t data_offset = 0;  ///< first byte behind the header
    std::size_t lines = 0;        ///< of the header
};

/// Reads the header and holds its counts against the bytes behind it. Throws Error(data).
PlyHeader read_ply_header(const Source& source);

}  // namespace airlight::detail
