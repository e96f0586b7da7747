// SPDX-License-Identifier: Apache-2.0
#include "prt/mesh_normals.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace airlight {
namespace {

constexpr double kCancelled = 1e-9;
constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();

double largest(const glm::dvec3& v) {
    return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

/// A vector of any length, made unit; zero for zero and what is not finite.
glm::dvec3 unit(const glm::dvec3& v) {
    const double scale = largest(v);
    if (!(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) || scale == 0) {
        return glm::dvec3(0.0);
    }
    // Divided, since a denormal scale has no reciprocal.
    const glm::dvec3 scaled = v / scale;
    return scaled / std::sqrt(glm::dot(scaled, scaled));
}

struct Face {
    glm::dvec3 normal{0.0};  ///< zero for one without area
    double area = 0;         ///< compared only; +inf and 0 where it has no double
    double angles[3] = {0, 0, 0};
};

double angle(const glm::dvec3& u, const glm::dvec3& v) {
    const glm::dvec3 cross = glm::cross(u, v);
    return std::atan2(std::sqrt(glm::dot(cross, cross)), glm::dot(u, v));
}

Face measure(const Mesh& mesh, const glm::uvec3& t) {
    const glm::dvec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
    const glm::dvec3 edges[3] = {b - a, c - b, a - c};
    const double size = std::max({largest(edges[0]), largest(edges[1]), largest(edges[2])});
    Face face;
    if (size == 0) return face;
    // Each edge by its own size: those of needles differ by more than squares can hold.
    glm::dvec3 scaled[3];
    double sizes[3];
    for (int i = 0; i < 3; ++i) {
        sizes[i] = largest(edges[i]);
        scaled[i] = sizes[i] > 0 ? edges[i] / sizes[i] : glm::dvec3(0.0);
    }
    // The two shortest edges give the cross product with the least rounding.
    int longest = 0;
    for (int i = 1; i < 3; ++i) longest = sizes[i] > sizes[longest] ? i : longest;
    const int first = (longest + 1) % 3, second = (longest + 2) % 3;
    const glm::dvec3 cross = glm::cross(scaled[first], scaled[second]);
    const double length = std::sqrt(glm::dot(cross, cross));
    // The area over size², against the rounding of the coordinates over size.
    const double ratio = length * (sizes[first] / size) * (sizes[second] / size);
    const double rounding = kRounding * (std::max({largest(a), largest(b), largest(c)}) / size);
    if (!(ratio > rounding)) return face;
    face.normal = cross / length;
    face.area = ratio * size * size;
    face.angles[0] = angle(scaled[0], -scaled[2]);
    face.angles[1] = angle(scaled[1], -scaled[0]);
    face.angles[2] = angle(scaled[2], -scaled[1]);
    return face;
}

}  // namespace

void compute_normals(Mesh& mesh, const std::vector<glm::dvec3>& from_file, MeshReport& report) {
    const std::size_t count = mesh.positions.size();
    struct Largest {
        double area = -1;
        std::uint32_t triangle = 0;
    };
    std::vector<Largest> largest_face(count);
    std::vector<double> angles(count, 0.0);
    mesh.normals.assign(count, glm::dvec3(0.0));
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec3& t = mesh.triangles[i];
        const Face face = measure(mesh, t);
        const bool flat = face.normal == glm::dvec3(0.0);
        report.zero_area += flat;
        if (flat) continue;
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t v = t[corner];
            mesh.normals[v] += face.angles[corner] * face.normal;
            angles[v] += face.angles[corner];
            if (face.area > largest_face[v].area) {
                largest_face[v] = {face.area, static_cast<std::uint32_t>(i)};
            }
        }
    }
    for (std::size_t v = 0; v < count; ++v) {
        glm::dvec3& normal = mesh.normals[v];
        if (!from_file.empty()) {
            const glm::dvec3 given = unit(from_file[v]);
            if (given != glm::dvec3(0.0)) {
                normal = given;
                ++report.normals_from_file;
                continue;
            }
        }
        if (glm::dot(normal, normal) > (kCancelled * angles[v]) * (kCancelled * angles[v])) {
            normal = unit(normal);
            ++report.normals_from_angles;
        } else if (largest_face[v].area >= 0) {
            normal = measure(mesh, mesh.triangles[largest_face[v].triangle]).normal;
            ++report.normals_from_one_face;
        } else {
            normal = glm::dvec3(0.0, 1.0, 0.0);
            ++report.normals_up;
        }
    }
    if (report.normals_from_file == 0) return;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 sum = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
        report.against_winding += glm::dot(measure(mesh, t).normal, sum) < 0;
    }
}

}  // namespace airlight
