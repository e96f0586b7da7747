// SPDX-License-Identifier: Apache-2.0
// PLY: the elements vertex (x y z, perhaps nx ny nz) and face (vertex_indices or vertex_index).
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "prt/byte_order.h"
#include "prt/mesh_text.h"
#include "prt/ply_header.h"

namespace airlight::detail {
namespace {

/// The numbers of a text's rows, one row a line.
class TextRows {
  public:
    TextRows(const Source& source, const PlyHeader& header)
        : source_(source),
          lines_(source.bytes.substr(header.data_offset), 0, false, header.lines + 1) {}

    void begin_row() {
        if (!lines_.next_filled()) truncated();
    }
    void end_row() {
        if (const std::size_t left = lines_.words_left(); left > 0) {
            refuse(fmt::format("has {} values more than its element", left));
        }
    }
    double real(PlyType) {
        const std::string_view word = next();
        double value = 0;
        if (!parse_real(word, value)) refuse(quote_word(word) + " is no number");
        return value;
    }
    std::int64_t integer(PlyType) {
        const std::string_view word = next();
        std::int64_t value = 0;
        if (!parse_integer(word, value)) refuse(quote_word(word) + " is no integer");
        return value;
    }
    void skip(PlyType, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) next();
    }
    /// Whether that many numbers can still come in this row.
    bool has(std::size_t count, PlyType) const { return lines_.words_left() >= count; }
    std::string place() const { return fmt::format("line {}", lines_.number()); }
    std::size_t bytes_left() const { return lines_.bytes_left(); }
    bool skip_rows(const PlyElement&) { return false; }

    [[noreturn]] void refuse(const std::string& sentence) const {
        source_.refuse(place() + ": " + sentence);
    }
    [[noreturn]] void truncated() const {
        source_.refuse(fmt::format("is truncated: it ends behind line {}", lines_.number()));
    }

  private:
    std::string_view next() {
        const std::string_view word = lines_.word();
        if (word.empty()) refuse("has too few values for its element");
        return word;
    }

    const Source& source_;
    TextLines lines_;
};

/// The same of a binary file.
class BinaryRows {
  public:
    BinaryRows(const Source& source, const PlyHeader& header)
        : source_(source),
          big_endian_(header.encoding == PlyEncoding::big_endian),
          at_(header.data_offset) {}

    void begin_row() {}
    void end_row() {}
    double real(PlyType type) {
        const char* bytes = take(ply_size(type));
        if (type == PlyType::float32) return load_float(bytes, big_endian_);
        if (type == PlyType::float64) return load_double(bytes, big_endian_);
        return static_cast<double>(decode(bytes, type));
    }
    std::int64_t integer(PlyType type) { return decode(take(ply_size(type)), type); }
    void skip(PlyType type, std::size_t count) { take(count * ply_size(type)); }
    bool has(std::size_t count, PlyType type) const {
        return count <= bytes_left() / ply_size(type);
    }
    std::string place() const { return fmt::format("byte {}", at_); }
    std::size_t bytes_left() const { return source_.bytes.size() - at_; }
    /// All rows of an element at once, where they are of one size.
    bool skip_rows(const PlyElement& element) {
        if (element.has_list()) return false;
        const std::size_t row = element.least_bytes();
        if (row > 0 && element.count > bytes_left() / row) truncated();
        at_ += row * element.count;
        return true;
    }

    [[noreturn]] void refuse(const std::string& sentence) const {
        source_.refuse(place() + ": " + sentence);
    }
    [[noreturn]] void truncated() const {
        source_.refuse(fmt::format("is truncated: it ends at byte {} within an element",
                                   source_.bytes.size()));
    }

  private:
    const char* take(std::size_t bytes) {
        if (bytes > bytes_left()) truncated();
        const char* at = source_.bytes.data() + at_;
        at_ += bytes;
        return at;
    }

    std::int64_t decode(const char* bytes, PlyType type) const {
        const std::size_t size = ply_size(type);
        const std::uint64_t bits = load_unsigned(bytes, size, big_endian_);
        const bool is_signed =
            type == PlyType::int8 || type == PlyType::int16 || type == PlyType::int32;
        const std::uint64_t sign = std::uint64_t{1} << (8 * size - 1);
        const auto value = static_cast<std::int64_t>(bits);
        return is_signed && (bits & sign) != 0 ? value - static_cast<std::int64_t>(2 * sign)
                                               : value;
    }

    const Source& source_;
    bool big_endian_;
    std::size_t at_;
};

template <class Rows>
class PlyReader {
  public:
    PlyReader(const Source& source, const PlyHeader& header)
        : source_(source), header_(header), rows_(source, header) {}

    RawMesh read() {
        for (const PlyElement& element : header_.elements) {
            if (element.name == "vertex") vertices_ = element.count;
        }
        if (vertices_ >= kMostVertices) {
            source_.refuse(
                fmt::format("has {} vertices, and they go to {}", vertices_, kMostVertices - 1));
        }
        for (const PlyElement& element : header_.elements) {
            if (element.name == "vertex") {
                read_vertices(element);
            } else if (element.name == "tristrips" && element.count > 0) {
                source_.refuse(
                    "its faces are triangle strips (the element \"tristrips\"), which are not "
                    "read");
            } else if (element.name == "face") {
                read_faces(element);
            } else {
                skip(element);
            }
        }
        const std::size_t rest = rows_.bytes_left();
        // A line end or two are nothing to speak of.
        if (rest > 2) {
            source_.report.notes.push_back(
                fmt::format("{} bytes behind the last element were not read", rest));
        }
        return std::move(raw_);
    }

  private:
    struct Triple {
        std::size_t at[3];
        bool whole = true;
    };

    Triple find(const PlyElement& element, const char* x, const char* y, const char* z) const {
        Triple triple = {{element.find(x), element.find(y), element.find(z)}};
        for (const std::size_t at : triple.at) {
            triple.whole =
                triple.whole && at < element.properties.size() && !element.properties[at].is_list;
        }
        return triple;
    }

    /// The length of a list, held against what is left.
    std::size_t list_length(const PlyProperty& property) {
        const std::int64_t length = rows_.integer(property.count_type);
        if (length < 0 || !rows_.has(static_cast<std::size_t>(length), property.type)) {
            rows_.refuse(fmt::format("the list {} claims {} values, more than are left",
                                     quote_word(property.name), length));
        }
        return static_cast<std::size_t>(length);
    }

    void skip(const PlyProperty& property) {
        rows_.skip(property.type, property.is_list ? list_length(property) : 1);
    }

    void skip(const PlyElement& element) {
        if (element.count == 0 || element.properties.empty()) return;
        source_.report.notes.push_back("the element " + quote_word(element.name) + " was not read");
        if (rows_.skip_rows(element)) return;
        for (std::size_t i = 0; i < element.count; ++i) {
            rows_.begin_row();
            for (const PlyProperty& property : element.properties) skip(property);
            rows_.end_row();
        }
    }

    void read_vertices(const PlyElement& element) {
        const Triple position = find(element, "x", "y", "z");
        const Triple normal = find(element, "nx", "ny", "nz");
        if (!position.whole) {
            source_.refuse("the element \"vertex\" lacks a property \"x\", \"y\" or \"z\"");
        }
        const std::size_t count = element.properties.size();
        source_.budget.reserve(raw_.positions, element.count, "its vertices");
        if (normal.whole) {
            source_.budget.reserve(raw_.vertex_normals, element.count, "its normals");
        }
        if (count > (normal.whole ? 6u : 3u)) {
            source_.report.notes.push_back("further properties of vertices were not read");
        }
        // Where each property goes: 0 to 2 the position, 3 to 5 the normal, 6 nowhere.
        std::vector<std::size_t> target(count, 6);
        for (std::size_t i = 0; i < 3; ++i) {
            target[position.at[i]] = i;
            if (normal.whole) target[normal.at[i]] = 3 + i;
        }
        double row[7] = {};
        for (std::size_t v = 0; v < element.count; ++v) {
            rows_.begin_row();
            for (std::size_t p = 0; p < count; ++p) {
                const PlyProperty& property = element.properties[p];
                if (target[p] == 6) {
                    skip(property);
                } else {
                    row[target[p]] = rows_.real(property.type);
                }
            }
            rows_.end_row();
            if (raw_.nonfinite_place.empty() &&
                !(std::isfinite(row[0]) && std::isfinite(row[1]) && std::isfinite(row[2]))) {
                raw_.nonfinite_place = fmt::format("vertex {}", v);
            }
            raw_.positions.emplace_back(row[0], row[1], row[2]);
            if (normal.whole) raw_.vertex_normals.emplace_back(row[3], row[4], row[5]);
        }
    }

    void read_faces(const PlyElement& element) {
        const std::size_t count = element.properties.size();
        std::size_t indices = element.find("vertex_indices");
        if (indices == count) indices = element.find("vertex_index");
        if (element.count == 0) return;
        if (indices == count || !element.properties[indices].is_list ||
            !is_integer(element.properties[indices].type)) {
            source_.refuse(
                "the element \"face\" lacks a list of integers \"vertex_indices\" or "
                "\"vertex_index\"");
        }
        source_.budget.reserve(raw_.face_sizes, element.count, "its faces");
        for (std::size_t f = 0; f < element.count; ++f) {
            rows_.begin_row();
            for (std::size_t p = 0; p < count; ++p) {
                if (p == indices) {
                    read_corners(element.properties[p], f);
                } else {
                    skip(element.properties[p]);
                }
            }
            rows_.end_row();
        }
    }

    void read_corners(const PlyProperty& property, std::size_t face) {
        const std::size_t length = list_length(property);
        source_.budget.grow(raw_.corners, length, "its faces");
        for (std::size_t i = 0; i < length; ++i) {
            const std::int64_t index = rows_.integer(property.type);
            if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_) {
                rows_.refuse(fmt::format("face {} names vertex {}, and there are {}", face, index,
                                         vertices_));
            }
            raw_.corners.push_back(static_cast<std::uint32_t>(index));
        }
        raw_.face_sizes.push_back(static_cast<std::uint32_t>(length));
    }

    const Source& source_;
    const PlyHeader& header_;
    Rows rows_;
    RawMesh raw_;
    std::size_t vertices_ = 0;
};

}  // namespace

RawMesh parse_ply(const Source& source) {
    const PlyHeader header = read_ply_header(source);
    if (header.encoding == PlyEncoding::ascii) return PlyReader<TextRows>(source, header).read();
    return PlyReader<BinaryRows>(source, header).read();
}

}  // namespace airlight::detail
