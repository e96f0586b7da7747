// SPDX-License-Identifier: Apache-2.0
// Object File Format: OFF with the prefixes N, C and ST; not 4OFF, nOFF and OFF BINARY.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "prt/mesh_text.h"
#include "prt/raw_mesh.h"

namespace airlight::detail {
namespace {

class OffReader {
  public:
    explicit OffReader(const Source& source) : source_(source), lines_(source.bytes, '#', false) {}

    RawMesh read() {
        header();
        const std::size_t per_vertex = normals_ ? 6 : 3;
        source_.budget.reserve(raw_.positions, vertices_, "its vertices");
        if (normals_) source_.budget.reserve(raw_.vertex_normals, vertices_, "its normals");
        for (std::size_t i = 0; i < vertices_; ++i) {
            if (!lines_.next_filled()) truncated(i, vertices_, "vertices");
            vertex(per_vertex);
        }
        source_.budget.reserve(raw_.face_sizes, faces_, "its faces");
        for (std::size_t i = 0; i < faces_; ++i) {
            if (!lines_.next_filled()) truncated(i, faces_, "faces");
            face();
        }
        if (lines_.next_filled()) {
            refuse(fmt::format("goes on beyond the {} vertices and {} faces of its header",
                               vertices_, faces_));
        }
        if (extra_) source_.report.notes.push_back("values behind the coordinates were not read");
        return std::move(raw_);
    }

  private:
    [[noreturn]] void refuse(const std::string& sentence) const {
        source_.refuse(fmt::format("line {}: {}", lines_.number(), sentence));
    }

    [[noreturn]] void truncated(std::size_t got, std::size_t wanted, const char* what) const {
        source_.refuse(fmt::format("is truncated: it has {} of {} {}", got, wanted, what));
    }

    void header() {
        lines_.next_filled();
        std::string_view key = lines_.word();
        source_.report.format = "off";
        // Prefixes come in this order, and "n" and "4" change the number of coordinates.
        for (const std::string_view prefix : {"ST", "C", "N"}) {
            if (key.substr(0, prefix.size()) != prefix) continue;
            normals_ = normals_ || prefix == "N";
            key.remove_prefix(prefix.size());
        }
        if (key != "OFF") {
            refuse(quote_word(key) + " is no kind of OFF that is read (OFF, NOFF, COFF, STOFF)");
        }
        if (lines_.words_left() == 0 && !lines_.next_filled()) {
            source_.refuse("is truncated: its numbers of vertices and faces are missing");
        }
        // The number of edges comes last and is unused; some writers leave it out.
        const std::array<std::size_t*, 3> targets = {&vertices_, &faces_, nullptr};
        for (std::size_t i = 0; i < targets.size(); ++i) {
            const std::string_view word = lines_.word();
            if (word.empty() && i == 2) break;
            std::int64_t value = 0;
            if (!parse_integer(word, value) || value < 0) {
                refuse(quote_word(word) + (word == "BINARY" ? ": binary OFF is not read"
                                                            : " is no number of elements"));
            }
            if (targets[i] != nullptr) *targets[i] = static_cast<std::size_t>(value);
        }
        // Each row is a line of three words, or of one, so the file's size bounds them.
        const std::size_t left = lines_.bytes_left() + 1;
        if (vertices_ > left / 6) too_many("vertices", vertices_);
        if (faces_ > (left - vertices_ * 6) / 2) too_many("faces", faces_);
        if (vertices_ >= kMostVertices) too_many("vertices", vertices_);
    }

    [[noreturn]] void too_many(const char* what, std::size_t claimed) const {
        refuse(fmt::format("claims {} {}, and {} bytes are left for them", claimed, what,
                           lines_.bytes_left()));
    }

    double real() {
        const std::string_view word = lines_.word();
        double value = 0;
        if (!parse_real(word, value)) refuse(quote_word(word) + " is no number");
        return value;
    }

    void vertex(std::size_t per_vertex) {
        if (const std::size_t left = lines_.words_left(); left < per_vertex) {
            refuse(fmt::format("has {} of {} values of a vertex", left, per_vertex));
        }
        glm::dvec3 v(0.0);
        for (int i = 0; i < 3; ++i) v[i] = real();
        if (raw_.nonfinite_place.empty() &&
            !(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z))) {
            raw_.nonfinite_place = fmt::format("line {}", lines_.number());
        }
        raw_.positions.push_back(v);
        if (normals_) {
            for (int i = 0; i < 3; ++i) v[i] = real();
            raw_.vertex_normals.push_back(v);
        }
        extra_ = extra_ || lines_.words_left() > 0;
    }

    void face() {
        const std::string_view word = lines_.word();
        std::int64_t size = 0;
        if (!parse_integer(word, size) || size < 0) {
            refuse(quote_word(word) + " is no number of corners");
        }
        const std::size_t left = lines_.words_left();
        if (static_cast<std::uint64_t>(size) > left) {
            refuse(fmt::format("the face claims {} corners and has {}", size, left));
        }
        const auto corners = static_cast<std::size_t>(size);
        source_.budget.grow(raw_.corners, corners, "its faces");
        for (std::size_t i = 0; i < corners; ++i) {
            const std::string_view corner = lines_.word();
            std::int64_t index = 0;
            if (!parse_integer(corner, index)) refuse(quote_word(corner) + " is no index");
            if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_) {
                refuse(fmt::format("the face names vertex {}, and they go from 0 to {}", index,
                                   static_cast<std::int64_t>(vertices_) - 1));
            }
            raw_.corners.push_back(static_cast<std::uint32_t>(index));
        }
        raw_.face_sizes.push_back(static_cast<std::uint32_t>(corners));
        extra_ = extra_ || left > corners;
    }

    const Source& source_;
    TextLines lines_;
    RawMesh raw_;
    std::size_t vertices_ = 0, faces_ = 0;
    bool normals_ = false;
    bool extra_ = false;
};

}  // namespace

RawMesh parse_off(const Source& source) {
    return OffReader(source).read();
}

}  // namespace airlight::detail
