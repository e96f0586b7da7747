// SPDX-License-Identifier: Apache-2.0
// Meshes for tests, and writers of all formats that are read. PLY goes out in every encoding.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "prt/mesh_io.h"

namespace airlight {

/// A bumpy sphere of `rings` rows of `rings` · 2 vertices and two poles; closed and manifold.
/// Positions are floats, so that every format keeps them.
inline Mesh make_globe(unsigned rings, double radius = 1, glm::dvec3 centre = glm::dvec3(0.0)) {
    Mesh mesh;
    const unsigned columns = 2 * rings;
    const double pi = 3.14159265358979323846;
    const auto add = [&](const glm::dvec3& direction) {
        const double r = radius * (1 + 0.1 * std::sin(5 * direction.x) * direction.y);
        const glm::dvec3 p = centre + r * direction;
        // Volatile, since GCC 12 at -O3 leaves out some of these roundings.
        const volatile float x = static_cast<float>(p.x), y = static_cast<float>(p.y),
                             z = static_cast<float>(p.z);
        mesh.positions.emplace_back(x, y, z);
    };
    add({0, 1, 0});
    for (unsigned i = 0; i < rings; ++i) {
        const double theta = pi * (i + 1) / (rings + 1);
        for (unsigned j = 0; j < columns; ++j) {
            const double phi = 2 * pi * j / columns;
            add({std::sin(theta) * std::sin(phi), std::cos(theta),
                 std::sin(theta) * std::cos(phi)});
        }
    }
    add({0, -1, 0});
    const auto at = [&](unsigned i, unsigned j) { return 1 + i * columns + j % columns; };
    const unsigned south = 1 + rings * columns;
    for (unsigned j = 0; j < columns; ++j) {
        mesh.triangles.emplace_back(0, at(0, j), at(0, j + 1));
        for (unsigned i = 0; i + 1 < rings; ++i) {
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
        mesh.triangles.emplace_back(south, at(rings - 1, j + 1), at(rings - 1, j));
    }
    return mesh;
}

/// "%.17g" of three numbers.
inline std::string words(const glm::dvec3& v) {
    char text[96];
    std::snprintf(text, sizeof(text), "%.17g %.17g %.17g", v.x, v.y, v.z);
    return text;
}

inline std::string words(const glm::uvec3& t, unsigned first = 0) {
    return std::to_string(t.x + first) + " " + std::to_string(t.y + first) + " " +
           std::to_string(t.z + first);
}

inline std::string to_obj(const Mesh& mesh) {
    std::string text = "# a comment\no thing\n";
    for (const glm::dvec3& p : mesh.positions) text += "v " + words(p) + "\n";
    for (const glm::dvec3& n : mesh.normals) text += "vn " + words(n) + "\n";
    for (const glm::uvec3& t : mesh.triangles) {
        text += "f";
        for (int i = 0; i < 3; ++i) {
            const std::string index = std::to_string(t[i] + 1);
            text += " " + index + (mesh.normals.empty() ? "" : "//" + index);
        }
        text += "\n";
    }
    return text;
}

inline std::string to_off(const Mesh& mesh) {
    std::string text = std::string(mesh.normals.empty() ? "OFF" : "NOFF") + "\n" +
                       std::to_string(mesh.positions.size()) + " " +
                       std::to_string(mesh.triangles.size()) + " 0\n";
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        text += words(mesh.positions[i]) +
                (mesh.normals.empty() ? "" : " " + words(mesh.normals[i])) + "\n";
    }
    for (const glm::uvec3& t : mesh.triangles) text += "3 " + words(t) + "\n";
    return text;
}

enum class Encoding { ascii, little, big };

template <class T>
void append(std::string& bytes, T value, bool big_endian) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    const std::uint16_t one = 1;
    unsigned char first = 0;
    std::memcpy(&first, &one, 1);
    if ((first == 0) != big_endian) {
        for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(raw[i], raw[sizeof(T) - 1 - i]);
    }
    bytes.append(raw, sizeof(T));
}

/// With an element and a property that are to be skipped, before and between what counts.
inline std::string to_ply(const Mesh& mesh, Encoding encoding) {
    const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const bool normals = !mesh.normals.empty();
    std::string text =
        std::string("ply\nformat ") + names[static_cast<int>(encoding)] +
        " 1.0\ncomment made by a test\nelement thing 2\nproperty short a\n"
        "property list uchar double b\nelement vertex " +
        std::to_string(mesh.positions.size()) +
        "\nproperty float x\nproperty uchar red\nproperty float y\n"
        "property double z\n" +
        (normals ? "property double nx\nproperty double ny\nproperty double nz\n" : "") +
        "element face " + std::to_string(mesh.triangles.size()) +
        "\nproperty list uchar int vertex_indices\nproperty float quality\n"
        "end_header\n";
    if (encoding == Encoding::ascii) {
        text += "-7 2 0.5 1e3\n8 0\n";
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            char row[128];
            const glm::dvec3& p = mesh.positions[i];
            std::snprintf(row, sizeof(row), "%.17g 255 %.17g %.17g", p.x, p.y, p.z);
            text += row + (normals ? " " + words(mesh.normals[i]) : "") + "\n";
        }
        for (const glm::uvec3& t : mesh.triangles) text += "3 " + words(t) + " 0.25\n";
        return text;
    }
    const bool big = encoding == Encoding::big;
    append(text, std::int16_t{-7}, big);
    append(text, std::uint8_t{2}, big);
    append(text, 0.5, big);
    append(text, 1e3, big);
    append(text, std::int16_t{8}, big);
    append(text, std::uint8_t{0}, big);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3& p = mesh.positions[i];
        append(text, static_cast<float>(p.x), big);
        append(text, std::uint8_t{255}, big);
        append(text, static_cast<float>(p.y), big);
        append(text, p.z, big);
        for (int k = 0; normals && k < 3; ++k) append(text, mesh.normals[i][k], big);
    }
    for (const glm::uvec3& t : mesh.triangles) {
        append(text, std::uint8_t{3}, big);
        for (int i = 0; i < 3; ++i) append(text, static_cast<std::int32_t>(t[i]), big);
        append(text, 0.25f, big);
    }
    return text;
}

inline std::string to_stl_text(const Mesh& mesh) {
    std::string text = "solid thing\n";
    for (const glm::uvec3& t : mesh.triangles) {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for (int i = 0; i < 3; ++i) text += "      vertex " + words(mesh.positions[t[i]]) + "\n";
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid thing\n";
}

inline std::string to_stl_binary(const Mesh& mesh) {
    std::string text = "solid, says this binary file all the same";
    text.resize(80, ' ');
    append(text, static_cast<std::uint32_t>(mesh.triangles.size()), false);
    for (const glm::uvec3& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) append(text, 0.0f, false);
        for (int i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k) {
                append(text, static_cast<float>(mesh.positions[t[i]][k]), false);
            }
        }
        append(text, std::uint16_t{0}, false);
    }
    return text;
}

struct NamedMesh {
    std::string name;
    std::string bytes;
    bool keeps_vertices = true;  ///< not STL
};

/// One mesh in each format and encoding.
inline std::vector<NamedMesh> in_all_formats(const Mesh& mesh) {
    return {{"obj", to_obj(mesh)},
            {"off", to_off(mesh)},
            {"ply_ascii", to_ply(mesh, Encoding::ascii)},
            {"ply_little", to_ply(mesh, Encoding::little)},
            {"ply_big", to_ply(mesh, Encoding::big)},
            {"stl_ascii", to_stl_text(mesh), false},
            {"stl_binary", to_stl_binary(mesh), false}};
}

}  // namespace airlight
