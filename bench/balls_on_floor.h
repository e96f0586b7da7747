// SPDX-License-Identifier: Apache-2.0
// The scene by which the engines of viewer/ are timed.
#pragma once

#include <cmath>
#include <fstream>
#include <string>

#include "bench/ball.h"
#include "viewer/scene.h"

namespace airlight {

/// Grey and even, scattering alone.
inline SceneMedium fog(double density) {
    SceneMedium medium;
    medium.kind = SceneUniform{glm::dvec3(density), glm::dvec3(0)};
    return medium;
}

/// A lamp over three balls of `rings` rings of triangles on a floor, in clear air. Writes the
/// meshes to `directory`.
inline Scene balls_on_floor(const std::string& directory, int rings) {
    Scene scene;
    scene.camera.position = {0, 2, 8};
    scene.lights = {{{1.5, 2.5, 0.5}, glm::dvec3(10)}};
    std::ofstream(directory + "/floor.obj")
        << "v -20 0 -20\nv -20 0 20\nv 20 0 20\nv 20 0 -20\nf 1 2 3\nf 1 3 4\n";
    SceneObject floor;
    floor.mesh.path = floor.mesh.name = directory + "/floor.obj";
    scene.objects.push_back(floor);
    SceneObject ball;
    ball.mesh.path = ball.mesh.name = directory + "/ball" + std::to_string(rings) + ".obj";
    write_ball(ball.mesh.path, rings);
    for (const double x : {-2.0, 0.0, 2.0}) {
        ball.transform = glm::dmat4(0.8);
        ball.transform[3] = {x, 0.8, -std::abs(x), 1};
        scene.objects.push_back(ball);
    }
    return scene;
}

}  // namespace airlight
