// SPDX-License-Identifier: Apache-2.0
// PLY: the elements vertex (x y z, perhaps nx ny nz) and face (vertex_indices or vertex_index).
#include <fmt/format.h>

#include <cmath>

#include "prt/ply_rows.h"

namespace airlight::detail {
namespace {

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

    void skip(const PlyElement& element) {
        if (element.count == 0 || element.properties.empty()) return;
        source_.report.notes.push_back("the element " + quote_word(element.name) + " was not read");
        skip_element(rows_, element);
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
                    skip_property(rows_, property);
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
                    skip_property(rows_, element.properties[p]);
                }
            }
            rows_.end_row();
        }
    }

    void read_corners(const PlyProperty& property, std::size_t face) {
        const std::size_t length = list_length(rows_, property);
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
