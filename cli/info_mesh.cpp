// SPDX-License-Identifier: Apache-2.0
#include "cli/info_mesh.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "core/error.h"

namespace airlight {
namespace {

struct Figure {
    const char* key;   ///< in JSON
    const char* text;  ///< behind its number
    std::uint64_t value;
};

std::vector<Figure> normal_figures(const MeshFigures& mesh) {
    const MeshReport& r = mesh.report;
    return {{"file", "from the file", r.normals_from_file},
            {"angles", "from faces, by angle", r.normals_from_angles},
            {"one_face", "of the largest face", r.normals_from_one_face},
            {"up", "without a face: +Y", r.normals_up}};
}

std::vector<Figure> repair_figures(const MeshFigures& mesh) {
    const MeshReport& r = mesh.report;
    return {{"polygons", "polygons cut into triangles", r.polygons},
            {"uncut_polygons", "polygons whose ears could not be cut, made fans", r.concave_fans},
            {"short_faces", "faces of fewer than three corners dropped", r.short_faces},
            {"degenerate", "triangles that named a vertex twice dropped", r.degenerate},
            {"duplicate", "duplicate triangles dropped", r.duplicate},
            {"back_to_back", "triangles that are another's back kept", r.back_to_back},
            {"zero_area", "triangles without area kept", r.zero_area},
            {"merged", "corners merged with others", r.merged},
            {"nonfinite", "non-finite coordinates, taken as 0", r.nonfinite},
            {"unusable_normals", "unusable normals in the file", r.unusable_normals},
            {"against_winding", "triangles that face away from their normals", r.against_winding}};
}

std::vector<Figure> topology_figures(const MeshFigures& mesh) {
    const MeshTopology& t = mesh.topology;
    return {{"isolated_vertices", "isolated vertices", mesh.report.isolated},
            {"edges", "edges", t.edges},
            {"boundary_edges", "boundary edges", t.boundary_edges},
            {"boundary_loops", "boundary loops", t.boundary_loops},
            {"nonmanifold_edges", "non-manifold edges", t.nonmanifold_edges},
            {"flipped_edges", "edges between opposite windings", t.flipped_edges},
            {"nonmanifold_vertices", "non-manifold vertices", t.nonmanifold_vertices},
            {"duplicated_vertices", "copies of vertices in the half-edges", t.duplicated_vertices},
            {"components", "components", t.components}};
}

std::string to_text(const glm::dvec3& p) {
    return fmt::format("({:g}, {:g}, {:g})", p.x, p.y, p.z);
}

nlohmann::ordered_json to_array(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

}  // namespace

MeshFigures look_into_mesh(const std::string& path, std::size_t max_memory) {
    MeshReadOptions options;
    options.max_memory = max_memory;
    options.nonfinite = NonfiniteVertex::zero;
    MeshFigures figures;
    const Mesh mesh = read_mesh(path, options, &figures.report);
    try {
        figures.topology = mesh_topology(mesh, max_memory);
    } catch (const Error& error) {
        throw Error(error.code(), error.what(), path);
    }
    figures.bounds = mesh_bounds(mesh);
    figures.vertices = mesh.positions.size();
    figures.triangles = mesh.triangles.size();
    return figures;
}

std::string to_lines(const std::string& path, const MeshFigures& mesh) {
    const MeshReport& r = mesh.report;
    std::string text =
        fmt::format("{}\n  mesh, {}, {} vertices, {} faces, {} triangles, {}\n", path, r.format,
                    mesh.vertices, r.file_faces, mesh.triangles, format_bytes(r.file_bytes));
    text += fmt::format("  {:<26} {} to {}\n", "bounds", to_text(mesh.bounds.minimum),
                        to_text(mesh.bounds.maximum));
    const auto lines = [&](const char* name, const std::vector<Figure>& figures, bool all) {
        for (const Figure& figure : figures) {
            if (figure.value == 0 && !all) continue;
            text += fmt::format("  {:<26} {} {}\n", name, figure.value, figure.text);
            name = "";
        }
    };
    lines("normals", normal_figures(mesh), false);
    lines("topology", topology_figures(mesh), true);
    lines("repaired or odd", repair_figures(mesh), false);
    for (const std::string& note : r.notes) text += "  note: " + note + "\n";
    return text;
}

nlohmann::ordered_json to_json(const std::string& path, const MeshFigures& mesh) {
    const MeshReport& r = mesh.report;
    nlohmann::ordered_json json = {{"file", path},
                                   {"format", "mesh"},
                                   {"mesh_format", r.format},
                                   {"file_bytes", r.file_bytes},
                                   {"vertices", mesh.vertices},
                                   {"faces", r.file_faces},
                                   {"triangles", mesh.triangles},
                                   {"minimum", to_array(mesh.bounds.minimum)},
                                   {"maximum", to_array(mesh.bounds.maximum)}};
    for (const Figure& each : normal_figures(mesh)) json["normals"][each.key] = each.value;
    for (const Figure& each : topology_figures(mesh)) json[each.key] = each.value;
    for (const Figure& each : repair_figures(mesh)) json[each.key] = each.value;
    json["notes"] = r.notes;
    return json;
}

}  // namespace airlight
