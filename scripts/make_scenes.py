#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the example scenes and their meshes.

Usage: make_scenes.py FOLDER [PROGRAM]

Writes FOLDER/*.json and FOLDER/meshes/*.obj and, with the path of airlight, bakes FOLDER/meshes/*.prt;
data/scenes holds the result. Everything is made of
spheres, boxes, quads, discs and one height field. +Y up, metres. Needs nothing beyond Python's own
library, and writes the same bytes wherever it runs.
"""
import json
import math
import os
import subprocess
import sys


def faces_of_rings(count, columns, closed=True):
    """Between rings of vertices, of which the first, and the last of closed ones, is one point."""
    faces = []
    for i in range(count - 1):
        for j in range(columns):
            a, b = i * columns + j, i * columns + (j + 1) % columns
            if i == 0:
                faces.append([a, a + columns, b + columns])
            elif closed and i == count - 2:
                faces.append([a, a + columns, b])
            else:
                faces.append([a, a + columns, b + columns, b])
    return faces


class Mesh:
    def __init__(self):
        self.vertices, self.faces = [], []

    def add(self, vertices, faces):
        base = len(self.vertices) + 1
        self.vertices += vertices
        self.faces += [[base + i for i in face] for face in faces]
        return self

    def quad(self, a, b, c, d):
        return self.add([a, b, c, d], [[0, 1, 2, 3]])

    def box(self, low, high):
        x, y, z = zip(low, high)
        corners = [(x[i & 1], y[i >> 1 & 1], z[i >> 2]) for i in range(8)]
        return self.add(corners, [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3],
                                  [0, 4, 6, 2], [1, 3, 7, 5]])

    def prism(self, centre, radius, height, sides):
        x, y, z = centre
        ring = [(x + radius * math.sin(2 * math.pi * i / sides),
                 z + radius * math.cos(2 * math.pi * i / sides)) for i in range(sides)]
        low, high = [(a, y, b) for a, b in ring], [(a, y + height, b) for a, b in ring]
        sides_of = [[i, (i + 1) % sides, sides + (i + 1) % sides, sides + i] for i in range(sides)]
        return self.add(low + high, sides_of + [list(range(sides, 2 * sides)),
                                                list(range(sides - 1, -1, -1))])

    def sphere(self, centre, radius, rings):
        columns = 2 * rings
        vertices = []
        for i in range(rings + 1):
            for j in range(columns):
                theta, phi = math.pi * i / rings, 2 * math.pi * j / columns
                vertices.append((centre[0] + radius * math.sin(theta) * math.sin(phi),
                                 centre[1] + radius * math.cos(theta),
                                 centre[2] + radius * math.sin(theta) * math.cos(phi)))
        return self.add(vertices, faces_of_rings(rings + 1, columns))

    def write(self, path):
        with open(path, "w", newline="\n") as out:
            for v in self.vertices:
                out.write("v " + " ".join("%.5g" % (x + 0.0) for x in v) + "\n")
            for face in self.faces:
                out.write("f " + " ".join(map(str, face)) + "\n")


def height(x, z):
    """Of the terrain: hills that rise away from a valley along Z."""
    ridge = 0.02 * x * x
    return (ridge + 2.2 * math.sin(0.31 * x + 0.7) * math.cos(0.23 * z) +
            0.9 * math.sin(0.83 * x - 0.4 * z) + 0.5 * math.cos(1.3 * z + 0.5 * x))


def terrain():
    steps, half = 56, 28.0
    mesh = Mesh()
    place = [-half + 2 * half * i / steps for i in range(steps + 1)]
    vertices = [(x, height(x, z), z) for z in place for x in place]
    row = steps + 1
    faces = [[i * row + j, (i + 1) * row + j, (i + 1) * row + j + 1, i * row + j + 1]
             for i in range(steps) for j in range(steps)]
    return mesh.add(vertices, faces)


def city():
    mesh = Mesh()
    for i in range(-5, 6):
        for j in range(-9, 4):
            if i == 0:
                continue
            # A hash decides how high a house is.
            tall = (i * 7919 + j * 104729) % 97 / 97.0
            x, z = 9.0 * i, 9.0 * j
            mesh.box((x - 3, 0, z - 3), (x + 3, 4 + 22 * tall * tall, z + 3))
    return mesh.quad((-80, 0, 60), (80, 0, 60), (80, 0, -120), (-80, 0, -120))


def courtyard():
    mesh = Mesh().quad((-14, 0, 14), (14, 0, 14), (14, 0, -14), (-14, 0, -14))
    for i in range(-2, 3):
        for side in (-1, 1):
            mesh.prism((5.0 * side, 0, 4.0 * i), 0.45, 5, 16)
        mesh.prism((0, 0, 0), 1.6, 0.6, 24) if i == 0 else None
    mesh.box((-6.2, 5, -9), (-3.8, 5.8, 9)).box((3.8, 5, -9), (6.2, 5.8, 9))
    return mesh.box((-14, 0, -14.5), (14, 8, -14)).sphere((0, 1.5, 0), 0.9, 20)


def window():
    """A closed room with a barred window."""
    mesh = Mesh().quad((-4, 0, 6), (4, 0, 6), (4, 0, -4), (-4, 0, -4))
    mesh.quad((-4, 0, -4), (4, 0, -4), (4, 5, -4), (-4, 5, -4))
    mesh.quad((-4.2, 5, -4), (4, 5, -4), (4, 5, 6), (-4.2, 5, 6))
    mesh.quad((4, 0, -4), (4, 0, 6), (4, 5, 6), (4, 5, -4))
    mesh.quad((4, 0, 6), (-4.2, 0, 6), (-4.2, 5, 6), (4, 5, 6))
    thick = (-4.2, -4.0)
    for y, z in (((0, 1.6), (-4, 6)), ((3.6, 5), (-4, 6)), ((1.6, 3.6), (-4, -1)),
                 ((1.6, 3.6), (2, 6)), ((1.6, 3.6), (0.4, 0.6)), ((2.5, 2.7), (-1, 2))):
        mesh.box((thick[0], y[0], z[0]), (thick[1], y[1], z[1]))
    return mesh


def lamps():
    mesh = Mesh()
    for x, z in STREET:
        mesh.prism((x, 0, z), 0.08, 3.85, 8)
    return mesh.quad((-40, 0, 20), (40, 0, 20), (40, 0, -80), (-40, 0, -80))


EARTH = 6371000
# Where air-space looks from, off the planet's centre.
SPACE = (0, 2200000 + EARTH, -3000000)


def planet():
    """A unit sphere, finest where the camera in space sees it."""
    near, columns = math.acos(EARTH / math.hypot(*SPACE)), 180
    angles = [near * 1.03 * i / 44 for i in range(45)]
    angles += [angles[-1] + (math.pi - angles[-1]) * (i / 16) ** 1.3 for i in range(1, 17)]
    tilt = math.atan2(SPACE[2], SPACE[1])
    vertices = []
    for theta in angles:
        for j in range(columns):
            phi = 2 * math.pi * j / columns
            x, y, z = math.sin(theta) * math.sin(phi), math.cos(theta), math.sin(theta) * math.cos(phi)
            vertices.append((x, y * math.cos(tilt) - z * math.sin(tilt),
                             y * math.sin(tilt) + z * math.cos(tilt)))
    return Mesh().add(vertices, faces_of_rings(len(angles), columns))


def ground():
    """What is seen of the planet from the ground, 60 km of it."""
    columns, radii = 96, [0.0] + [60000 * 1.35 ** (i - 26) for i in range(27)]
    vertices = [(r * math.sin(2 * math.pi * j / columns), -r * r / (2 * EARTH),
                 r * math.cos(2 * math.pi * j / columns)) for r in radii for j in range(columns)]
    return Mesh().add(vertices, faces_of_rings(len(radii), columns, closed=False))


STREET = [(-2.2, 0), (0.3, -10), (3.6, -24)]


def point(position, intensity):
    return {"type": "point", "position": position, "intensity": intensity}


def uniform(scattering, absorption=0):
    medium = {"type": "uniform", "scattering": scattering}
    if absorption:
        medium["absorption"] = absorption
    return medium


def lambert(diffuse):
    return {"type": "lambert", "diffuse": diffuse}


def phong(diffuse, specular, exponent):
    return {"type": "phong", "diffuse": diffuse, "specular": specular, "exponent": exponent}


def thing(mesh, material, position=None, scale=1, prt=None):
    entry = {"mesh": mesh if "/" in mesh else "meshes/" + mesh + ".obj"}
    if position:
        entry["transform"] = [scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, *position, 1]
    entry["material"] = material
    if prt:
        entry["prt"] = "meshes/" + prt + ".prt"
    return entry


def camera(position, look_at, degrees, size=(640, 360)):
    return {"position": position, "look_at": look_at, "vertical_fov_degrees": degrees,
            "size": list(size)}


def blobs(places):
    return {"type": "gaussians", "blobs": [
        {"center": [round(c, 4) for c in centre], "scale": scale, "amplitude": amplitude}
        for centre, scale, amplitude in places]}


def patches(count, span, low, high, scale, amplitude):
    """Blobs on a spiral of golden angles, larger and smaller in turn."""
    places = []
    for i in range(count):
        r, a = span * math.sqrt((i + 0.5) / count), 2.399963229728653 * i
        y = low + (high - low) * (i * 0.618033988749895 % 1)
        size = scale * (0.7 + 0.6 * (i * 0.754877666246693 % 1))
        places.append(([r * math.cos(a), y, r * math.sin(a)], round(size, 4), amplitude))
    return blobs(places)


ROOM, SKY = "../lamps.exr", "../sky.exr"
GLOW = [16, 13, 9]


def scenes():
    street = [thing("street", lambert([0.25, 0.25, 0.27]))]
    glow = [point([x + 0.7, 3.9, z], GLOW) for x, z in STREET]
    view = camera([0, 1.7, 12], [0.6, 2.1, 0], 35)
    for name, beta in (("street-clear", 0), ("street-mist", 0.01), ("street-fog", 0.04)):
        yield name, {"camera": view, "lights": glow,
                     **({"media": [uniform(beta)]} if beta else {}), "objects": street}

    for name, materials in (
            ("spheres-clear", None), ("spheres-fog", 0.12)):
        row = [thing("sphere", material, [x, 1, 0]) for x, material in (
            (-2.4, lambert([0.6, 0.45, 0.3])), (0, phong([0.3, 0.2, 0.15], 0.4, 10)),
            (2.4, phong([0.3, 0.2, 0.15], 0.4, 20)))]
        yield name, {"camera": camera([0, 2.2, 14], [0, 1, 0], 18),
                     "lights": [point([3.5, 4, 4], [60, 55, 50])],
                     **({"media": [uniform(materials)]} if materials else {}),
                     "objects": [thing("floor", lambert(0.35))] + row}

    yield "courtyard", {
        "camera": camera([1.5, 2.2, 13], [0, 2.2, 0], 45),
        "lights": [point([x, 3.6, z], colour) for x, z, colour in (
            (-2.6, 5, [22, 17, 11]), (2.6, 1, [22, 17, 11]), (-2.6, -6, [14, 17, 24]),
            (2.6, -9, [22, 17, 11]))],
        "media": [uniform(0.035, 0.003)],
        "objects": [thing("courtyard", phong([0.35, 0.33, 0.3], 0.08, 12))]}

    for name, distance, beta in (("statue-near", 1, 0), ("statue-fog", 8, 0.12),
                                 ("statue-far", 25, 0.12)):
        away = 6.5 if beta == 0 else 8.5
        yield name, {"camera": camera([0.8, 1.5, away], [0, 1.15, 0], 38),
                     "environment": {"file": ROOM, "rotation_degrees": 168,
                                     "distance": distance},
                     **({"media": [uniform(beta)]} if beta else {}),
                     "objects": [thing("../knot.ply", phong(0.5, 0.15, 16), prt="knot")]}

    steam = [([0.25 * math.sin(1.9 * i) * (0.2 + 0.1 * i), 0.9 + 0.16 * i,
               0.25 * math.cos(1.3 * i) * (0.2 + 0.1 * i)], round(3.2 / (1 + 0.12 * i), 3),
              round(2.4 / (1 + 0.25 * i), 3)) for i in range(18)]
    yield "steam", {"camera": camera([0, 1.8, 6.5], [0, 1.7, 0], 38),
                    "lights": [point([-1.7, 3.3, 1.2], [14, 12, 10])],
                    "media": [blobs(steam)],
                    "objects": [thing("room", lambert([0.5, 0.45, 0.4])),
                                thing("sphere", phong([0.3, 0.3, 0.35], 0.3, 20), [0, 0.45, 0],
                                      0.45)]}

    yield "terrain", {"camera": camera([2, 9, 27], [0, 2.5, 0], 42),
                      "environment": {"file": SKY, "distance": 40},
                      "media": [patches(26, 25, -0.5, 2.5, 0.3, 0.22)],
                      "objects": [thing("terrain", lambert([0.3, 0.33, 0.22]))]}
    yield "city", {"camera": camera([2, 5, 34], [0, 7, -20], 45),
                   "environment": {"file": SKY, "distance": 120},
                   "media": [patches(70, 60, 1, 9, 0.14, 0.012),
                             {"type": "height", "profile": "exponential", "density": 0.012,
                              "scale_height": 9}],
                   "objects": [thing("city", lambert([0.4, 0.38, 0.36]))]}

    # Where approximations of Gaussian airlight fail: a small blob beside the light, and light that
    # leaves a dense cloud through a hole.
    yield "failure-halo", {"camera": camera([0, 0, 5], [0, 0, 0], 40, (480, 480)),
                           "lights": [point([0.1, 0.05, 0], [6, 6, 6])],
                           "media": [blobs([([0.55, 0.1, 0.1], 4, 1.6), ([-0.6, 0.3, -0.4], 1, 0.4),
                                            ([0.2, -0.8, 0.5], 1.2, 0.3)])]}
    ring = [([0.95 * math.sin(a), y, 0.95 * math.cos(a)], 2.4, 2.8)
            for y in (-0.9, -0.3, 0.3, 0.9)
            for a in (2 * math.pi * i / 8 for i in range(8)) if not (abs(y) < 0.5 and 1.5 < a < 1.6)]
    yield "failure-shaft", {"camera": camera([0, 0.4, 6], [0.6, 0, 0], 40, (480, 480)),
                            "lights": [point([0, 0, 0], [30, 28, 24])],
                            "media": [blobs(ring), uniform(0.03)]}

    air = {"type": "atmosphere", "radius": EARTH, "density": [5.8e-6, 1.35e-5, 3.31e-5],
           "scale_height": 8000, "phase": {"type": "rayleigh"}}
    yield "air-ground", {"camera": camera([0, 100, 0], [0, 1600, 10000], 60),
                         "lights": [point([6e9, 5e9, 9e9], [3e20, 3e20, 3e20])],
                         "media": [air],
                         "objects": [thing("ground", lambert([0.16, 0.14, 0.1]))]}
    yield "air-space", {"camera": camera([SPACE[0], SPACE[1] - EARTH, SPACE[2]], [0, -1200000, 0], 50, (480, 480)),
                        "lights": [point([9e9, 6e9, -9e9], [3e20, 3e20, 3e20])],
                        "media": [air],
                        "objects": [thing("planet", lambert([0.05, 0.09, 0.16]),
                                          [0, -EARTH, 0], EARTH)]}

    yield "slab", {"camera": camera([1.2, 2.2, 5], [0, 0.6, 0], 32),
                   "lights": [point([-1.5, 3, -2], [30, 30, 30])],
                   "media": [{"type": "slab", "min": [-1.1, 0.001, -0.5], "max": [1.1, 1.6, 0.5],
                              "ior": 1.3, "scattering": [1.2, 0.9, 0.6],
                              "absorption": [0.05, 0.12, 0.3]}],
                   "objects": [thing("floor", lambert([0.4, 0.4, 0.42]))]}
    yield "shafts", {"camera": camera([3.4, 1.9, 5.6], [-2.2, 1.7, -0.5], 48),
                     "lights": [point([-9, 6.5, 1.5], [900, 820, 640]),
                                point([2.6, 4.2, 5], [5, 6, 7.5])],
                     "media": [uniform(0.035)],
                     "objects": [thing("window", lambert([0.5, 0.47, 0.42]))],
                     "shafts": {"shadow_map": 1024, "particles": {"mu": -2, "sigma": 0.3}}}
    yield "clear-day", {"camera": camera([0.8, 1.5, 7], [0, 1.15, 0], 38),
                        "environment": {"file": SKY},
                        "objects": [thing("../knot.ply", phong(0.5, 0.15, 16), prt="knot-plaza"),
                                    thing("plaza", lambert(0.4), prt="plaza")]}


def plaza():
    """A floor of 60 m with vertices where the knot's shadow falls."""
    count = 48
    at = [math.copysign(30 * abs(u) ** 2.2, u)
          for u in (2 * i / count - 1 for i in range(count + 1))]
    row = count + 1
    faces = [[k, k + 1, k + row + 1, k + row]
             for k in (i * row + j for i in range(count) for j in range(count))]
    return Mesh().add([(x, -0.3, z) for x in at for z in at], faces)


def bake(program, folder):
    """What objects see; without bounces, as the reference has it."""
    meshes = os.path.join(folder, "meshes")
    knot, floor = os.path.join(folder, "..", "knot.ply"), os.path.join(meshes, "plaza.obj")
    for mesh, name, flags in (
            (knot, "knot", ["--order", "5"]),
            (knot, "knot-plaza", ["--order", "4", "--occluder", floor]),
            (floor, "plaza", ["--order", "5", "--occluder", knot, "--kind", "transfer"])):
        output = os.path.join(meshes, name + ".prt")
        subprocess.run([program, "bake", mesh, "-o", output, "--rays", "1024", "--type", "float16",
                        "--force", "-q"] + flags, check=True)


def dump(value, indent=0):
    flat = json.dumps(value)
    if len(flat) + indent < 100 or not isinstance(value, (dict, list)):
        return flat
    pad = " " * (indent + 2)
    if isinstance(value, dict):
        inner = [pad + json.dumps(k) + ": " + dump(v, indent + 2) for k, v in value.items()]
        return "{\n" + ",\n".join(inner) + "\n" + " " * indent + "}"
    inner = [pad + dump(v, indent + 2) for v in value]
    return "[\n" + ",\n".join(inner) + "\n" + " " * indent + "]"


def main():
    folder = sys.argv[1]
    meshes = os.path.join(folder, "meshes")
    os.makedirs(meshes, exist_ok=True)
    floor = Mesh().quad((-30, 0, 30), (30, 0, 30), (30, 0, -30), (-30, 0, -30))
    room = Mesh().quad((-2.5, 0, 2.5), (2.5, 0, 2.5), (2.5, 0, -2.5), (-2.5, 0, -2.5))
    room.quad((-2.5, 0, -2.5), (2.5, 0, -2.5), (2.5, 4, -2.5), (-2.5, 4, -2.5))
    room.quad((-2.5, 0, 2.5), (-2.5, 0, -2.5), (-2.5, 4, -2.5), (-2.5, 4, 2.5))
    room.quad((2.5, 0, -2.5), (2.5, 0, 2.5), (2.5, 4, 2.5), (2.5, 4, -2.5))
    room.box((-0.6, 0, -0.6), (0.6, 0.02, 0.6))
    for name, mesh in (("floor", floor), ("room", room), ("sphere", Mesh().sphere((0, 0, 0), 1, 24)),
                       ("planet", planet()), ("ground", ground()), ("street", lamps()),
                       ("courtyard", courtyard()), ("terrain", terrain()), ("city", city()),
                       ("window", window()), ("plaza", plaza())):
        mesh.write(os.path.join(meshes, name + ".obj"))
    for name, scene in scenes():
        with open(os.path.join(folder, name + ".json"), "w", newline="\n") as out:
            out.write(dump({"airlight_scene": 1, **scene}) + "\n")
    if len(sys.argv) > 2:
        bake(sys.argv[2], folder)


if __name__ == "__main__":
    main()
