// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ: v, vn and f; the rest of the format has no bearing on visibility.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "prt/mesh_text.h"
#include "prt/raw_mesh.h"

namespace airlight::detail {
namespace {

constexpr std::string_view kNotFaces[] = {"l", "p", "curv", "curv2", "surf"};
constexpr std::string_view kNoBearing[] = {
    "vt",     "vp",         "o",         "g",     "s",     "mg",    "usemtl",   "mtllib",
    "usemap", "maplib",     "cstype",    "deg",   "bmat",  "step",  "parm",     "trim",
    "hole",   "scrv",       "sp",        "end",   "con",   "bevel", "c_interp", "d_interp",
    "lod",    "shadow_obj", "trace_obj", "ctech", "stech", "call",  "csh"};

template <std::size_t count>
bool is_among(const std::string_view (&words)[count], std::string_view word) {
    return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

struct Counts {
    std::size_t vertices = 0, normals = 0;
};

TextLines lines_of(const Source& source) {
    return TextLines(source.bytes, '#', true);
}

/// Indices may point forward, so the numbers of vertices and normals are found before.
Counts count(const Source& source) {
    Counts counts;
    TextLines lines = lines_of(source);
    while (lines.next()) {
        const std::string_view key = lines.word();
        counts.vertices += key == "v";
        counts.normals += key == "vn";
    }
    return counts;
}

class ObjReader {
  public:
    explicit ObjReader(const Source& source)
        : source_(source), counts_(count(source)), lines_(lines_of(source)) {
        if (counts_.vertices >= kMostVertices || counts_.normals >= kMostVertices) {
            source.refuse(fmt::format("has {} vertices, and they go to {}", counts_.vertices,
                                      kMostVertices - 1));
        }
        source.budget.reserve(raw_.positions, counts_.vertices, "its vertices");
        source.budget.reserve(raw_.normal_table, counts_.normals, "its normals");
    }

    RawMesh read() {
        while (lines_.next()) {
            const std::string_view key = lines_.word();
            if (key == "v") {
                vertex();
            } else if (key == "vn") {
                raw_.normal_table.push_back(vector());
            } else if (key == "f" || key == "fo") {
                face();
            } else if (is_among(kNotFaces, key)) {
                ++not_faces_;
            } else if (!key.empty() && !is_among(kNoBearing, key) && unknown_++ == 0) {
                first_unknown_ = fmt::format("{} in line {}", quote_word(key), lines_.number());
            }
        }
        if (unknown_ > 0) {
            source_.report.notes.push_back(
                fmt::format("{} lines begin with no word of OBJ, the first {}, and were not read",
                            unknown_, first_unknown_));
        }
        if (colours_) source_.report.notes.push_back("colours of vertices were not read");
        if (not_faces_ > 0) {
            source_.report.notes.push_back(
                fmt::format("{} lines, points or free-form elements were not read", not_faces_));
        }
        return std::move(raw_);
    }

  private:
    [[noreturn]] void refuse(const std::string& sentence) const {
        source_.refuse(fmt::format("line {}: {}", lines_.number(), sentence));
    }

    glm::dvec3 vector() {
        glm::dvec3 v(0.0);
        for (int i = 0; i < 3; ++i) {
            const std::string_view word = lines_.word();
            if (word.empty()) refuse(fmt::format("has {} of 3 coordinates", i));
            if (!parse_real(word, v[i])) refuse(quote_word(word) + " is no number");
        }
        return v;
    }

    void vertex() {
        const glm::dvec3 v = vector();
        if (raw_.nonfinite_place.empty() &&
            !(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z))) {
            raw_.nonfinite_place = fmt::format("line {}", lines_.number());
        }
        raw_.positions.push_back(v);
        // A weight, or a colour, or both may follow.
        std::size_t more = 0;
        for (std::string_view word = lines_.word(); !word.empty(); word = lines_.word(), ++more) {
            double value = 0;
            if (!parse_real(word, value)) refuse(quote_word(word) + " is no number");
        }
        if (more > 5) refuse(fmt::format("has {} coordinates", 3 + more));
        colours_ = colours_ || more > 1;
    }

    /// An index of `of` things of which `so_far` have come: from 1, or from -1 backwards.
    std::uint32_t index(std::string_view word, std::size_t so_far, std::size_t of,
                        const char* what) const {
        std::int64_t value = 0;
        if (!parse_integer(word, value)) refuse(quote_word(word) + " is no index");
        if (value > 0 && static_cast<std::uint64_t>(value) <= of) {
            return static_cast<std::uint32_t>(value - 1);
        }
        if (value < 0 && value >= -static_cast<std::int64_t>(so_far)) {
            return static_cast<std::uint32_t>(static_cast<std::int64_t>(so_far) + value);
        }
        refuse(fmt::format("the face names {} {}, and {} are there{}", what, value,
                           value < 0 ? so_far : of, value < 0 ? " so far" : ""));
    }

    void face() {
        std::uint32_t corners = 0;
        for (std::string_view word = lines_.word(); !word.empty(); word = lines_.word()) {
            const std::size_t slash = word.find('/');
            const std::uint32_t vertex =
                index(word.substr(0, slash), raw_.positions.size(), counts_.vertices, "vertex");
            std::uint32_t normal = kNoNormal;
            if (slash != std::string_view::npos) {
                const std::string_view rest = word.substr(slash + 1);
                const std::size_t second = rest.find('/');
                if (second != std::string_view::npos && second + 1 < rest.size()) {
                    normal = index(rest.substr(second + 1), raw_.normal_table.size(),
                                   counts_.normals, "normal");
                }
            }
            add_corner(vertex, normal);
            ++corners;
        }
        source_.budget.grow(raw_.face_sizes, 1, "its faces");
        raw_.face_sizes.push_back(corners);
    }

    void add_corner(std::uint32_t vertex, std::uint32_t normal) {
        // The array of normals begins with the first corner that has one.
        if (normal != kNoNormal || !raw_.corner_normals.empty()) {
            const std::size_t missing = raw_.corners.size() + 1 - raw_.corner_normals.size();
            source_.budget.grow(raw_.corner_normals, missing, "its faces");
            raw_.corner_normals.resize(raw_.corners.size(), kNoNormal);
            raw_.corner_normals.push_back(normal);
        }
        source_.budget.grow(raw_.corners, 1, "its faces");
        raw_.corners.push_back(vertex);
    }

    const Source& source_;
    Counts counts_;
    TextLines lines_;
    RawMesh raw_;
    bool colours_ = false;
    std::uint64_t not_faces_ = 0, unknown_ = 0;
    std::string first_unknown_;
};

}  // namespace

RawMesh parse_obj(const Source& source) {
    source.report.format = "obj";
    return ObjReader(source).read();
}

}  // namespace airlight::detail
