#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes data/lamps.exr, a small lat-long map of a lamp-lit room, for the demo and the tests.

Usage: make_lamp_map.py OUTPUT.exr

The viewer stands in a box of painted walls with a chequered floor, a window onto the evening sky
and five lamps of radiance 200 to 3000. Walls are Lambertian and lit by the lamps alone, plus a
constant for what bounces. Needs nothing beyond Python's own library. Pixels are halves rounded to
7 bits, so that they compress, in ZIP.
"""
import math
import sys

from exr_map import exr

WIDTH, HEIGHT = 512, 256
SAMPLES = 3  # per pixel and axis
ROOM = ((-3.0, 0.0, -2.5), (3.0, 2.8, 3.5))
EYE = (0.2, 1.5, -0.4)
# Centre, radius, radiance (R, G, B).
LAMPS = [
    ((-1.6, 2.2, 1.8), 0.10, (3000.0, 2100.0, 1150.0)),
    ((1.7, 2.2, 2.1), 0.07, (2400.0, 1900.0, 1250.0)),
    ((2.4, 1.1, -1.7), 0.13, (420.0, 260.0, 110.0)),
    ((-2.5, 0.9, -1.2), 0.06, (260.0, 620.0, 900.0)),
    ((0.4, 2.5, -2.0), 0.16, (210.0, 190.0, 160.0)),
]
BOUNCE = 0.06
SKY = (0.35, 0.55, 1.10)


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def direction(u, v):
    theta, phi = math.pi * v, 2 * math.pi * (0.5 - u)
    return (math.sin(theta) * math.sin(phi), math.cos(theta), math.sin(theta) * math.cos(phi))


def hit_lamp(ray):
    for centre, radius, radiance in LAMPS:
        to_centre = subtract(centre, EYE)
        along = dot(to_centre, ray)
        if along > 0 and dot(to_centre, to_centre) - along * along < radius * radius:
            return radiance
    return None


def hit_wall(ray):
    """The point, axis and side where the ray leaves the room."""
    best = (math.inf, 0, 0)
    for axis in range(3):
        if ray[axis] == 0:
            continue
        side = 1 if ray[axis] > 0 else 0
        best = min(best, ((ROOM[side][axis] - EYE[axis]) / ray[axis], axis, side))
    distance, axis, side = best
    return tuple(e + distance * r for e, r in zip(EYE, ray)), axis, side


def is_window(point, axis, side):
    if axis != 2 or side != 1 or not 0.9 < point[1] < 2.1 or not -0.9 < point[0] < 0.9:
        return False
    return min(abs(point[0]), abs(abs(point[0]) - 0.9), abs(point[1] - 1.5)) > 0.04


def albedo(point, axis, side):
    if axis == 1 and side == 0:
        odd = (math.floor(point[0] / 0.5) + math.floor(point[2] / 0.5)) % 2
        return (0.50, 0.42, 0.33) if odd else (0.16, 0.12, 0.10)
    if axis == 1:
        return (0.75, 0.73, 0.70)
    if axis == 0:
        return (0.58, 0.30, 0.22) if side else (0.25, 0.38, 0.44)
    return (0.60, 0.56, 0.48)


def irradiance(point, axis, side):
    normal = -1.0 if side else 1.0
    total = [0.0, 0.0, 0.0]
    for centre, radius, radiance in LAMPS:
        to_lamp = subtract(centre, point)
        squared = dot(to_lamp, to_lamp)
        cosine = max(0.0, normal * to_lamp[axis]) / math.sqrt(squared)
        solid_angle = math.pi * radius * radius / squared
        for c in range(3):
            total[c] += radiance[c] * solid_angle * cosine
    return total


def radiance_of(ray):
    lamp = hit_lamp(ray)
    if lamp:
        return lamp
    point, axis, side = hit_wall(ray)
    if is_window(point, axis, side):
        return SKY
    lit = irradiance(point, axis, side)
    return tuple(a * (BOUNCE + e / math.pi) for a, e in zip(albedo(point, axis, side), lit))


def pixel(row, column):
    total = [0.0, 0.0, 0.0]
    for i in range(SAMPLES):
        for j in range(SAMPLES):
            ray = direction((column + (j + 0.5) / SAMPLES) / WIDTH,
                            (row + (i + 0.5) / SAMPLES) / HEIGHT)
            total = [t + x for t, x in zip(total, radiance_of(ray))]
    return [t / SAMPLES**2 for t in total]


def main():
    rows = [[pixel(row, column) for column in range(WIDTH)] for row in range(HEIGHT)]
    with open(sys.argv[1], "wb") as file:
        file.write(exr(rows, "make_lamp_map.py"))


if __name__ == "__main__":
    main()
