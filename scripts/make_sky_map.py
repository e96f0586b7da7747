#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes data/sky.exr, a small lat-long map of a clear sky with its sun, for the example scenes.

Usage: make_sky_map.py OUTPUT.exr

A blue that pales towards the horizon, a glow around the sun, grey ground. The sun's disc has a
radius of 1.5 degrees, so that it covers pixels, and the irradiance of a sun a tenth as wide. Needs
nothing beyond Python's own library.
"""
import math
import sys

from exr_map import exr

WIDTH, HEIGHT = 256, 128
SAMPLES = 4  # per pixel and axis
ELEVATION, AZIMUTH = math.radians(28), math.radians(-140)
SUN_RADIUS = math.radians(1.5)
SUN = (1500.0, 1340.0, 1080.0)
ZENITH, HORIZON, GROUND = (0.16, 0.30, 0.68), (0.72, 0.80, 0.92), (0.17, 0.16, 0.14)


def pixel(row, column):
    to_sun = (math.cos(ELEVATION) * math.sin(AZIMUTH), math.sin(ELEVATION),
              math.cos(ELEVATION) * math.cos(AZIMUTH))
    total = [0.0, 0.0, 0.0]
    for i in range(SAMPLES):
        for j in range(SAMPLES):
            theta = math.pi * (row + (i + 0.5) / SAMPLES) / HEIGHT
            phi = 2 * math.pi * (0.5 - (column + (j + 0.5) / SAMPLES) / WIDTH)
            ray = (math.sin(theta) * math.sin(phi), math.cos(theta),
                   math.sin(theta) * math.cos(phi))
            angle = math.acos(max(-1.0, min(1.0, sum(a * b for a, b in zip(ray, to_sun)))))
            if ray[1] < 0:
                radiance = GROUND
            elif angle < SUN_RADIUS:
                radiance = SUN
            else:
                pale = (1 - ray[1]) ** 4
                glow = 0.9 * math.exp(-6 * angle) + 3 * math.exp(-35 * angle)
                radiance = [z + (h - z) * pale + glow * s / SUN[0]
                            for z, h, s in zip(ZENITH, HORIZON, SUN)]
            total = [t + x for t, x in zip(total, radiance)]
    return [t / SAMPLES**2 for t in total]


def main():
    rows = [[pixel(row, column) for column in range(WIDTH)] for row in range(HEIGHT)]
    with open(sys.argv[1], "wb") as file:
        file.write(exr(rows, "make_sky_map.py"))


if __name__ == "__main__":
    main()
