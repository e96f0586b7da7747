// SPDX-License-Identifier: Apache-2.0
// A program of somebody else's: every library of the package does something here.
#include <cmath>
#include <cstdio>

#include "airlight/envmap/fog.h"
#include "airlight/envmap/io.h"
#include "airlight/medium/psf.h"
#include "airlight/prt/mesh_io.h"
#include "airlight/prt/mesh_topology.h"
#include "airlight/sh/npsf.h"
#include "core/error.h"

int main() {
    airlight::Image map(64, 32, 3);
    for (float& value : map.pixels) value = 1;
    airlight::FogOptions options;
    options.optical_thickness = {1.0};
    const airlight::FogPlan plan = airlight::plan_fog(map.height, map.width, 3, options);
    const airlight::Image scattered = airlight::scattered_light(map, plan);
    // A constant map scatters the point spread function's integral, sqrt(4 pi) g_0.
    const double g0 = airlight::psf_zonal(1.0, 1)[0];
    const double expected = std::sqrt(4 * 3.14159265358979323846) * g0;
    if (!(std::abs(scattered.at(16, 32, 0) / expected - 1) < 1e-3)) return 1;
    if (!(airlight::psf(1.0, 0.5) > 0)) return 2;
    const airlight::Mesh mesh =
        airlight::parse_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "triangle.obj");
    if (airlight::mesh_topology(mesh).boundary_edges != 3) return 4;
    try {
        airlight::read_image("missing.exr");
        return 3;
    } catch (const airlight::Error& error) {
        std::printf("%s\n", error.describe().c_str());
    }
    return 0;
}
