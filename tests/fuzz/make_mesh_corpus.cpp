// SPDX-License-Identifier: Apache-2.0
// Writes seeds of corpus/obj, ply, stl and off. Usage: make_mesh_corpus DIRECTORY, which holds
// these four.
#include <cstdio>
#include <exception>
#include <string>

#include "prt/mesh_normals.h"
#include "tests/core/scratch_directory.h"
#include "tests/prt/mesh_files.h"

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: make_mesh_corpus DIRECTORY\n");
        return 2;
    }
    try {
        const std::string directory = std::string(arguments[1]) + "/";
        airlight::Mesh mesh = airlight::make_globe(1);
        mesh.positions.emplace_back(2, 2, 2);
        for (const char* kind : {"plain", "normals"}) {
            for (const airlight::NamedMesh& file : airlight::in_all_formats(mesh)) {
                if (!mesh.normals.empty() && !file.keeps_vertices) continue;
                const std::string format = file.name.substr(0, 3);
                airlight::write_bytes(
                    directory + format + "/" + file.name + "_" + kind + "." + format, file.bytes);
            }
            airlight::MeshReport ignored;
            airlight::compute_normals(mesh, {}, ignored);
        }
        airlight::write_bytes(directory + "obj/polygons.obj",
                              "# polygons, convex and not\nv 0 0 0\nv 2 0 0\nv 2 2 0 1\n"
                              "v 1 .5 0 1 1 1\nv 0 2e0 0\nvt 0 0\nvn 0 0 1\nl 1 2\n"
                              "f 1 2 3 4 5\nf 1/1/1 2//1 \\\n -3/1\nf 1 4 5 3 2 1\ns off\n");
        airlight::write_bytes(directory + "off/coloured.off",
                              "STCNOFF # all of them\n3 2 0\n0 0 0 0 0 1 1 1 1 1 0 0\n"
                              "1 0 0 0 0 1 1 1 1 1 0 0\n0 1 0 0 0 1 1 1 1 1 0 0\n"
                              "3 0 1 2 0.5 0.5 0.5\n4 0 1 2 1\n");
        airlight::write_bytes(directory + "off/empty.off", "OFF 0 0 0\n");
        airlight::write_bytes(directory + "stl/two_solids.stl",
                              "solid a\nendsolid a\nSOLID\nFacet normal 0 0 1\nouter loop\n"
                              "vertex 0 0 0\nvertex -0 1e400 nan\nvertex 1 1 1\nendloop\n"
                              "endfacet\nendsolid\n");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_mesh_corpus: %s\n", error.what());
        return 1;
    }
    return 0;
}
