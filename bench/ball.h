// SPDX-License-Identifier: Apache-2.0
// A ball for scenes of tests and benchmarks.
#pragma once

#include <cmath>
#include <fstream>
#include <string>

#include "core/constants.h"

namespace airlight {

/// Writes a sphere of radius 1 with `rings` rings of triangles, as OBJ.
inline void write_ball(const std::string& path, int rings) {
    std::ofstream out(path);
    const int sides = 2 * rings;
    for (int i = 0; i <= rings; ++i) {
        for (int j = 0; j < sides; ++j) {
            const double theta = kPi * i / rings, phi = 2 * kPi * j / sides;
            out << "v " << std::sin(theta) * std::cos(phi) << " " << std::cos(theta) << " "
                << std::sin(theta) * std::sin(phi) << "\n";
        }
    }
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < sides; ++j) {
            const int a = i * sides + j + 1, b = i * sides + (j + 1) % sides + 1;
            if (i > 0) out << "f " << a << " " << b << " " << b + sides << "\n";
            if (i + 1 < rings) out << "f " << a << " " << b + sides << " " << a + sides << "\n";
        }
    }
}

}  // namespace airlight
