// SPDX-License-Identifier: Apache-2.0
// STL, a soup of triangles: equal positions become one vertex.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <tuple>

#include "prt/byte_order.h"
#include "prt/mesh_text.h"
#include "prt/raw_mesh.h"

namespace airlight::detail {
namespace {

using Bits = PositionBits;

// Equal bits are equal positions once -0 is +0; NaNs stay what they are.
Bits bits_of(const glm::dvec3& position) {
    Bits bits{};
    for (int i = 0; i < 3; ++i) {
        const double value = position[i] == 0 ? 0.0 : position[i];
        std::memcpy(&bits[static_cast<std::size_t>(i)], &value, sizeof(value));
    }
    return bits;
}

std::uint64_t mix(std::uint64_t hash, std::uint64_t bits) {
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 32;
}

struct Corner {
    std::uint64_t hash;
    std::uint32_t index;
};

/// Numbers the different positions in the order of their first corners. By sorting, since a file
/// could be made whose positions share a place in any table of hashes.
void merge_corners(RawMesh& raw, const Source& source) {
    std::vector<glm::dvec3>& positions = raw.positions;
    if (positions.size() >= kMostVertices) {
        source.refuse(
            fmt::format("has {} corners, and they go to {}", positions.size(), kMostVertices - 1));
    }
    const auto count = static_cast<std::uint32_t>(positions.size());
    std::vector<Corner> order;
    source.budget.reserve(order, count, "the merging of its corners");
    for (std::uint32_t i = 0; i < count; ++i)
        order.push_back({hash_position(bits_of(positions[i])), i});
    std::sort(order.begin(), order.end(), [](const Corner& a, const Corner& b) {
        return a.hash != b.hash ? a.hash < b.hash : a.index < b.index;
    });
    // Every corner's first equal one, then numbers in the order of those.
    source.budget.reserve(raw.corners, count, "its faces");
    raw.corners.resize(count);
    const auto bits = [&](const Corner& corner) { return bits_of(positions[corner.index]); };
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        const Bits first = bits(order[begin]);
        bool alike = true;
        for (end = begin; end < order.size() && order[end].hash == order[begin].hash; ++end) {
            alike = alike && bits(order[end]) == first;
        }
        // Different positions of one hash are rare, unless the file was made so.
        if (!alike) {
            std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
                      order.begin() + static_cast<std::ptrdiff_t>(end),
                      [&](const Corner& a, const Corner& b) {
                          const Bits left = bits(a), right = bits(b);
                          return std::tie(left, a.index) < std::tie(right, b.index);
                      });
        }
        for (std::size_t i = begin; i < end; ++i) {
            const bool same = i > begin && (alike || bits(order[i]) == bits(order[i - 1]));
            raw.corners[order[i].index] = same ? raw.corners[order[i - 1].index] : order[i].index;
        }
    }
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t first = raw.corners[i];
        if (first == i) {
            positions[kept] = positions[i];
            raw.corners[i] = kept++;
        } else {
            raw.corners[i] = raw.corners[first];
        }
    }
    positions.resize(kept);
    source.report.merged = count - kept;
    source.budget.give_back(count * sizeof(Corner));
    source.budget.reserve(raw.face_sizes, count / 3, "its faces");
    raw.face_sizes.assign(count / 3, 3);
}

class StlText {
  public:
    explicit StlText(const Source& source) : source_(source), lines_(source.bytes, 0, false) {}

    RawMesh read() {
        bool inside = false;
        while (lines_.next_filled()) {
            const std::string key = lower_case(lines_.word());
            if (key == "solid" && !inside) {
                inside = true;
            } else if (key == "endsolid" && inside) {
                inside = false;
            } else if (key == "facet" && inside) {
                facet();
            } else {
                refuse(quote_word(key) + " is no " +
                       (inside ? "\"facet\" or \"endsolid\"" : "\"solid\""));
            }
        }
        if (inside) source_.refuse("is truncated: it ends without \"endsolid\"");
        return std::move(raw_);
    }

  private:
    [[noreturn]] void refuse(const std::string& sentence) const {
        source_.refuse(fmt::format("line {}: {}", lines_.number(), sentence));
    }

    std::string next_key() {
        if (!lines_.next_filled()) source_.refuse("is truncated: it ends within a facet");
        return lower_case(lines_.word());
    }

    void expect(const char* wanted) {
        const std::string key = next_key();
        if (key != wanted) refuse(quote_word(key) + " is no \"" + wanted + "\"");
    }

    void facet() {
        expect("outer");
        source_.budget.grow(raw_.positions, 3, "its corners");
        for (int corner = 0; corner < 3; ++corner) {
            expect("vertex");
            glm::dvec3 v(0.0);
            for (int i = 0; i < 3; ++i) {
                const std::string_view word = lines_.word();
                if (!parse_real(word, v[i])) refuse(quote_word(word) + " is no number");
            }
            if (!lines_.word().empty()) refuse("has more than 3 coordinates");
            if (raw_.nonfinite_place.empty() &&
                !(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z))) {
                raw_.nonfinite_place = fmt::format("line {}", lines_.number());
            }
            raw_.positions.push_back(v);
        }
        expect("endloop");
        expect("endfacet");
    }

    const Source& source_;
    TextLines lines_;
    RawMesh raw_;
};

}  // namespace

std::uint64_t hash_prefix(const PositionBits& bits) {
    return mix(mix(0, bits[0]), bits[1]);
}

std::uint64_t hash_position(const PositionBits& bits) {
    return mix(hash_prefix(bits), bits[2]);
}

std::size_t stl_claim(std::string_view bytes) {
    return bytes.size() < kStlHeader ? 0 : load_unsigned(bytes.data() + 80, 4, false);
}

RawMesh parse_stl_text(const Source& source) {
    source.report.format = "stl ascii";
    RawMesh raw = StlText(source).read();
    merge_corners(raw, source);
    return raw;
}

RawMesh parse_stl_binary(const Source& source) {
    source.report.format = "stl binary";
    const std::size_t size = source.bytes.size();
    if (size < kStlHeader) {
        source.refuse(
            fmt::format("is truncated: it has {} bytes, and the header of a binary STL "
                        "takes {}",
                        size, kStlHeader));
    }
    const std::size_t count = stl_claim(source.bytes);
    if (count > (size - kStlHeader) / kStlRecord) {
        source.refuse(
            fmt::format("is truncated: it claims {} triangles, which take {} bytes, and "
                        "has {}",
                        count, kStlHeader + count * kStlRecord, size));
    }
    if (const std::size_t rest = size - kStlHeader - count * kStlRecord; rest > 0) {
        source.report.notes.push_back(
            fmt::format("{} bytes behind the last triangle were not read", rest));
    }
    RawMesh raw;
    source.budget.reserve(raw.positions, 3 * count, "its corners");
    for (std::size_t t = 0; t < count; ++t) {
        // Behind the facet's normal.
        const char* at = source.bytes.data() + kStlHeader + t * kStlRecord + 12;
        for (int corner = 0; corner < 3; ++corner, at += 12) {
            const glm::dvec3 v(load_float(at, false), load_float(at + 4, false),
                               load_float(at + 8, false));
            if (raw.nonfinite_place.empty() &&
                !(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z))) {
                raw.nonfinite_place = fmt::format("triangle {}", t);
            }
            raw.positions.push_back(v);
        }
    }
    merge_corners(raw, source);
    return raw;
}

}  // namespace airlight::detail
