// SPDX-License-Identifier: Apache-2.0
#include "prt/prt_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/atomic_file.h"
#include "core/constants.h"
#include "core/error.h"
#include "prt/byte_order.h"
#include "prt/prt_match.h"

namespace airlight {
namespace {

using detail::bits_of;
using detail::store_unsigned;

// Floats keep seven digits of coordinates whose largest lies between these.
constexpr double kLargestFloatExtent = 1e30, kSmallestFloatExtent = 1e-30;
// Of the version 1.0: magic, version and length come before the text.
constexpr std::size_t kNpyStart = 10, kNpyAlignment = 64;
constexpr std::size_t kTrianglesAtOnce = std::size_t{1} << 14;

std::size_t rows_of(const PrtReader& reader) {
    return static_cast<std::size_t>(reader.header().rows);
}

bool is_integer(const PrtReader& reader, PrtKind kind) {
    return reader.header().tables[*reader.find(kind)].type == PrtType::uint32;
}

/// The rows of a table as the bit patterns of their numbers, some at a time.
class Rows {
  public:
    Rows(const PrtReader& reader, PrtKind kind)
        : reader_(reader),
          kind_(kind),
          components_(reader.components(kind)),
          integer_(is_integer(reader, kind)) {}

    std::size_t components() const { return components_; }
    bool integer() const { return integer_; }
    /// The value in a slot of a row that was read, counted from the first of them.
    float value(std::size_t row, std::size_t slot) const {
        return values_[row * components_ + slot];
    }
    std::uint32_t bits(std::size_t row, std::size_t slot) const {
        const std::size_t i = row * components_ + slot;
        return integer_ ? integers_[i] : bits_of(values_[i]);
    }

    void read(std::size_t first, std::size_t count) {
        if (integer_) {
            integers_.resize(count * components_);
            reader_.read(kind_, first, count, integers_.data());
        } else {
            values_.resize(count * components_);
            reader_.read(kind_, first, count, values_.data());
        }
    }

  private:
    const PrtReader& reader_;
    PrtKind kind_;
    std::size_t components_;
    bool integer_;
    std::vector<float> values_;
    std::vector<std::uint32_t> integers_;
};

/// A buffer of little-endian numbers on the way to a file.
class Bytes {
  public:
    void put(std::uint64_t value, std::size_t size) {
        bytes_.resize(bytes_.size() + size);
        store_unsigned(value, size, bytes_.data() + bytes_.size() - size);
    }
    void put_real(double value, bool wide) {
        if (wide) {
            put(bits_of(value), 8);
        } else {
            put(bits_of(static_cast<float>(value)), 4);
        }
    }
    void flush(AtomicFile& file) {
        file.write(bytes_.data(), bytes_.size());
        bytes_.clear();
    }

  private:
    std::string bytes_;
};

std::string npy_header(std::size_t rows, std::size_t components, bool integer) {
    std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}, {}), }}",
                                   integer ? "<u4" : "<f4", rows, components);
    const std::size_t used = kNpyStart + text.size() + 1;
    const std::size_t whole = (used + kNpyAlignment - 1) / kNpyAlignment * kNpyAlignment;
    text.append(whole - used, ' ');
    text += '\n';
    std::string bytes("\x93NUMPY\x01\x00", 8);
    bytes.resize(kNpyStart);
    store_unsigned(text.size(), 2, bytes.data() + 8);
    return bytes + text;
}

/// Which table colours come from, and by what its first number is multiplied.
struct Shade {
    PrtKind kind;
    double scale;
};

Shade choose_shade(const PrtReader& reader) {
    if (reader.find(PrtKind::ambient_occlusion)) return {PrtKind::ambient_occlusion, 1};
    if (reader.find(PrtKind::transfer)) return {PrtKind::transfer, std::sqrt(4 * kPi)};
    if (reader.find(PrtKind::visibility)) return {PrtKind::visibility, 1 / std::sqrt(kPi)};
    throw Error(ErrorCode::usage,
                "holds no ambient_occlusion, transfer or visibility to colour a PLY with",
                reader.path());
}

std::uint8_t to_srgb(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    const double curve = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * curve));
}

bool needs_double(const Mesh& mesh) {
    double largest = 0;
    for (const glm::dvec3& p : mesh.positions) {
        largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }
    return largest > 0 && !(largest <= kLargestFloatExtent && largest >= kSmallestFloatExtent);
}

std::string ply_header(const Mesh& mesh, bool wide, bool bent, PrtKind kind, const Rows& table) {
    std::string text = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n",
                                   mesh.positions.size());
    const auto add = [&](const char* type, const std::string& name) {
        text += fmt::format("property {} {}\n", type, name);
    };
    for (const char* name : {"x", "y", "z"}) add(wide ? "double" : "float", name);
    for (const char* name : {"nx", "ny", "nz"}) add("float", name);
    for (const char* name : {"red", "green", "blue"}) add("uchar", name);
    add("float", "quality");
    if (bent) {
        for (const char* name : {"bent_x", "bent_y", "bent_z"}) add("float", name);
    }
    for (std::size_t i = 0; i < table.components(); ++i) {
        add(table.integer() ? "uint" : "float", fmt::format("{}_{}", prt_name(kind), i));
    }
    const bool small = mesh.positions.size() <= std::numeric_limits<std::int32_t>::max();
    return text +
           fmt::format("element face {}\nproperty list uchar {} vertex_indices\nend_header\n",
                       mesh.triangles.size(), small ? "int" : "uint");
}

void write_triangles(const Mesh& mesh, AtomicFile& file) {
    Bytes bytes;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        bytes.put(3, 1);
        for (int i = 0; i < 3; ++i) bytes.put(mesh.triangles[t][i], 4);
        if ((t + 1) % kTrianglesAtOnce == 0) bytes.flush(file);
    }
    bytes.flush(file);
}

}  // namespace

void write_prt_npy(const PrtReader& reader, PrtKind kind, const std::string& path, bool force) {
    Rows table(reader, kind);
    const std::size_t rows = rows_of(reader), block = reader.header().block_rows;
    AtomicFile file(path, AtomicFileOptions{force});
    const std::string start = npy_header(rows, table.components(), table.integer());
    file.write(start.data(), start.size());
    Bytes bytes;
    for (std::size_t first = 0; first < rows; first += block) {
        const std::size_t count = std::min(block, rows - first);
        table.read(first, count);
        for (std::size_t row = 0; row < count; ++row) {
            for (std::size_t i = 0; i < table.components(); ++i) bytes.put(table.bits(row, i), 4);
        }
        bytes.flush(file);
    }
    file.commit();
}

void write_prt_ply(const PrtReader& reader, PrtKind kind, const Mesh& mesh,
                   const std::string& mesh_name, const std::string& path, bool force) {
    require_whole(reader, "a PLY");
    require_mesh(reader, mesh, mesh_name);
    const Shade shade = choose_shade(reader);
    const bool bent = reader.find(PrtKind::bent_normal).has_value();
    const bool wide = needs_double(mesh);
    Rows table(reader, kind), shades(reader, shade.kind);
    Rows directions(reader, bent ? PrtKind::bent_normal : kind);
    AtomicFile file(path, AtomicFileOptions{force});
    const std::string start = ply_header(mesh, wide, bent, kind, table);
    file.write(start.data(), start.size());
    const std::size_t rows = rows_of(reader), block = reader.header().block_rows;
    Bytes bytes;
    for (std::size_t first = 0; first < rows; first += block) {
        const std::size_t count = std::min(block, rows - first);
        table.read(first, count);
        shades.read(first, count);
        if (bent) directions.read(first, count);
        for (std::size_t row = 0; row < count; ++row) {
            for (int i = 0; i < 3; ++i) bytes.put_real(mesh.positions[first + row][i], wide);
            for (int i = 0; i < 3; ++i) bytes.put_real(mesh.normals[first + row][i], false);
            const double quality = shade.scale * static_cast<double>(shades.value(row, 0));
            for (int i = 0; i < 3; ++i) bytes.put(to_srgb(quality), 1);
            bytes.put_real(quality, false);
            for (std::size_t i = 0; bent && i < 3; ++i) bytes.put(directions.bits(row, i), 4);
            for (std::size_t i = 0; i < table.components(); ++i) bytes.put(table.bits(row, i), 4);
        }
        bytes.flush(file);
    }
    write_triangles(mesh, file);
    file.commit();
}

}  // namespace airlight
