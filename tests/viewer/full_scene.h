// SPDX-License-Identifier: Apache-2.0
// A scene with everything in it, and the files that it names.
#pragma once

#include <algorithm>
#include <fstream>
#include <string>

#include "tests/core/scratch_directory.h"

namespace airlight {

// Everything that a scene can hold. Files are named but for their being there not looked at.
inline const std::string kFullScene = R"({
  "airlight_scene": 1,
  "camera": {"position": [1, 2, 3], "look_at": [0, 0.5, 0], "up": [0, 2, 0],
    "vertical_fov_degrees": 90, "size": [64, 48]},
  "environment": {"file": "sky.exr", "rotation_degrees": 180, "scale": 2, "distance": 50},
  "lights": [{"type": "point", "position": [1, 2, 0], "intensity": [10, 9, 8]},
    {"type": "point", "position": [0, 5, 0], "intensity": 3}],
  "media": [
    {"type": "uniform", "scattering": [0.1, 0.2, 0.3], "absorption": 0.01,
      "phase": {"type": "hg", "g": 0.7}, "bounds": {"min": [-1, 0, -1], "max": [1, 2, 1]}},
    {"type": "gaussians", "file": "blobs.ply", "albedo": 0.9,
      "blobs": [{"center": [0, 1, 0], "scale": 1.5, "amplitude": 0.6}]},
    {"type": "height", "profile": "exponential", "density": [0.05, 0.04, 0.03],
      "scale_height": 8, "phase": {"type": "rayleigh"}},
    {"type": "height", "profile": "linear", "density": 0.25, "slope": -0.125},
    {"type": "atmosphere", "radius": 6371000, "density": 1e-5, "scale_height": 8000,
      "phase": {"type": "table", "file": "mie.csv"}},
    {"type": "slab", "min": [-1, 0, -1], "max": [1, 1, 1], "ior": 1.3, "scattering": 1,
      "absorption": [1, 2, 3]}
  ],
  "objects": [
    {"mesh": "knot.ply", "transform": [1,0,0,0, 0,2,0,0, 0,0,1,0, 5,6,7,1],
      "material": {"type": "phong", "diffuse": 0.4, "specular": [0.1, 0.2, 0.3], "exponent": 9},
      "prt": "knot.prt"},
    {"mesh": "knot.ply", "material": {"type": "tabulated", "file": "paint.binary"}},
    {"mesh": "knot.ply", "material": {"type": "lambert", "diffuse": [1, 0, 1]}},
    {"mesh": "knot.ply"}
  ],
  "shafts": {"shadow_map": 512, "particles": {"mu": 0.25, "sigma": 0.75}},
  "tolerance": 0.001
}
)";

/// A PLY file of blobs from lines of x, y, z, scale and amplitude.
inline void write_blob_file(const std::string& path, const std::string& rows) {
    std::ofstream(path) << "ply\nformat ascii 1.0\nelement vertex "
                        << std::count(rows.begin(), rows.end(), '\n')
                        << "\nproperty float x\nproperty float y\nproperty float z\n"
                           "property float scale\nproperty float amplitude\nend_header\n"
                        << rows;
}

inline void make_full_scene_files(const ScratchDirectory& directory) {
    for (const char* name : {"sky.exr", "mie.csv", "knot.ply", "knot.prt", "paint.binary"}) {
        std::ofstream(directory / name) << "-";
    }
    write_blob_file(directory / "blobs.ply", "1 2 3 4 5\n-1 0 0 0 0\n");
}

}  // namespace airlight
