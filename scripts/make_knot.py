#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes data/knot.ply, a ridged trefoil knot that stands on a round plinth, for the demo.

Usage: make_knot.py OUTPUT.ply

Two closed surfaces that touch. The tube's cross-section is a rounded star that turns as it goes
along, so that its grooves, the knot's crossings and the plinth under it are hidden from parts of
the sky. +Y up, metres, the plinth's top at y = 0. Needs nothing beyond Python's own library.
"""
import math
import struct
import sys

# The centre line winds around a torus of these radii, twice about its axis while three times
# around its tube; the axis is Z.
LARGE, SMALL = 1.0, 0.46
TUBE = 0.27
RIDGES, DEPTH, TURNS = 3, 0.15, 5
ALONG, AROUND = 324, 26

PLINTH_RADIUS, PLINTH_HEIGHT, BEVEL = 1.75, 0.26, 0.07
SEGMENTS = 104
SINK = 0.03  # of the knot into the plinth


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def centre_line(t):
    # A quarter turn puts one of the three lobes on top.
    angle, distance = 2 * t + math.pi / 2, LARGE + SMALL * math.cos(3 * t)
    return (distance * math.cos(angle), distance * math.sin(angle), SMALL * math.sin(3 * t))


def knot():
    vertices, triangles = [], []
    for i in range(ALONG):
        t = 2 * math.pi * i / ALONG
        h = 1e-5
        before, here, after = centre_line(t - h), centre_line(t), centre_line(t + h)
        tangent = unit(tuple(b - a for a, b in zip(before, after)))
        # The torus's own normal, less its part along the curve, closes up without a twist.
        angle = 2 * t + math.pi / 2
        outward = (math.cos(3 * t) * math.cos(angle), math.cos(3 * t) * math.sin(angle),
                   math.sin(3 * t))
        side = unit(cross(tangent, outward))
        outward = cross(side, tangent)
        for j in range(AROUND):
            phi = 2 * math.pi * j / AROUND
            radius = TUBE * (1 + DEPTH * math.cos(RIDGES * phi + TURNS * t))
            vertices.append(tuple(c + radius * (math.cos(phi) * o + math.sin(phi) * s)
                                  for c, o, s in zip(here, outward, side)))
    for i in range(ALONG):
        for j in range(AROUND):
            a, b = i * AROUND + j, (i + 1) % ALONG * AROUND + j
            c, d = i * AROUND + (j + 1) % AROUND, (i + 1) % ALONG * AROUND + (j + 1) % AROUND
            triangles += [(a, c, b), (b, c, d)]
    lowest = min(v[1] for v in vertices)
    return [(x, y - lowest - SINK, z) for x, y, z in vertices], triangles


def plinth():
    # Radius and height, from the centre of the top over the rim to that of the bottom.
    flat = PLINTH_RADIUS - BEVEL
    profile = [(flat * k / 15, 0.0) for k in range(1, 16)]
    for k in range(1, 5):
        angle = math.pi / 2 * k / 4
        profile.append((flat + BEVEL * math.sin(angle), BEVEL * (math.cos(angle) - 1)))
    profile.append((PLINTH_RADIUS, -PLINTH_HEIGHT / 2))
    for k in range(5):
        angle = math.pi / 2 * k / 4
        profile.append((flat + BEVEL * math.cos(angle),
                        BEVEL * (1 - math.sin(angle)) - PLINTH_HEIGHT))
    vertices = [(0.0, 0.0, 0.0)]
    for radius, height in profile:
        for j in range(SEGMENTS):
            phi = 2 * math.pi * j / SEGMENTS
            vertices.append((radius * math.sin(phi), height, radius * math.cos(phi)))
    vertices.append((0.0, -PLINTH_HEIGHT, 0.0))
    triangles = []
    last = len(vertices) - 1
    for j in range(SEGMENTS):
        k = (j + 1) % SEGMENTS
        triangles.append((0, 1 + j, 1 + k))
        for ring in range(len(profile) - 1):
            a, b = 1 + ring * SEGMENTS + j, 1 + ring * SEGMENTS + k
            triangles += [(a, a + SEGMENTS, b), (b, a + SEGMENTS, b + SEGMENTS)]
        triangles.append((last, last - SEGMENTS + k, last - SEGMENTS + j))
    return vertices, triangles


def main():
    vertices, triangles = knot()
    more, of_more = plinth()
    triangles += [tuple(v + len(vertices) for v in t) for t in of_more]
    vertices += more
    header = ("ply\nformat binary_little_endian 1.0\n"
              "comment A trefoil knot on a plinth, by Airlight's scripts/make_knot.py\n"
              f"element vertex {len(vertices)}\n"
              "property float x\nproperty float y\nproperty float z\n"
              f"element face {len(triangles)}\nproperty list uchar ushort vertex_indices\nend_header\n")
    with open(sys.argv[1], "wb") as out:
        out.write(header.encode())
        for vertex in vertices:
            out.write(struct.pack("<3f", *vertex))
        for triangle in triangles:
            out.write(struct.pack("<B3H", 3, *triangle))


if __name__ == "__main__":
    main()
