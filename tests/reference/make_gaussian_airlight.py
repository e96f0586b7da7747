#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden values of the airlight of Gaussian media in hard scenes, by mpmath.

Usage: python3 make_gaussian_airlight.py SCENES.csv BLOBS.csv [COUNT] [SEED]

Viewer at the origin, I_0 = 1. The integral is Gauss-Legendre of 24 nodes at 30 digits on panels
that grow geometrically from every point where something happens: the viewer, the end, the foot of
the light, every blob's center; it is done a second time with every panel halved, and the script
fails where the two differ by 1e-15 of the value.
"""
import math
import random
import sys

import mpmath as mp

mp.mp.dps = 30
NODES = None


def rule():
    global NODES
    if NODES is None:
        n = 24
        nodes = []
        for i in range(n):
            x = mp.cos(mp.pi * (i + mp.mpf(3) / 4) / (n + mp.mpf(1) / 2))
            for _ in range(8):
                p0, p1 = mp.mpf(1), x
                for k in range(1, n):
                    p0, p1 = p1, ((2 * k + 1) * x * p1 - k * p0) / (k + 1)
                slope = n * (x * p1 - p0) / (x * x - 1)
                x -= p1 / slope
            nodes.append((x, 2 / ((1 - x * x) * slope * slope)))
        NODES = nodes
    return NODES


def line(a, c, rho2, m, dist):
    lo, hi = -a * m, a * (dist - m)
    if lo > 0:
        part = mp.erfc(lo) - mp.erfc(hi)
    elif hi < 0:
        part = mp.erfc(-hi) - mp.erfc(-lo)
    else:
        part = mp.erf(hi) - mp.erf(lo)
    return c * mp.exp(-a * a * rho2) * mp.sqrt(mp.pi) / (2 * a) * part


def dot(p, q):
    return sum(x * y for x, y in zip(p, q))


def airlight(beta0, light, direction, dist, blobs, halvings):
    s, w = [mp.mpf(x) for x in light], [mp.mpf(x) for x in direction]
    norm = mp.sqrt(dot(w, w))
    w = [x / norm for x in w]
    beta0, dist = mp.mpf(beta0), mp.mpf(dist)
    blobs = [(mp.mpf(a), mp.mpf(c), [mp.mpf(x) for x in b]) for a, c, b in blobs]
    foot = dot(s, w)
    height2 = dot(s, s) - foot * foot
    views = []
    for a, c, b in blobs:
        m = dot(b, w)
        views.append((a, c, dot(b, b) - m * m, m))

    def integrand(t):
        x = [t * v for v in w]
        beta, depth = beta0, beta0 * t
        for a, c, rho2, m in views:
            beta += c * mp.exp(-a * a * (rho2 + (t - m) ** 2))
            depth += line(a, c, rho2, m, t)
        d2 = height2 + (t - foot) ** 2
        d = mp.sqrt(d2)
        depth += beta0 * d
        u = [(p - q) / d for p, q in zip(x, s)]
        for a, c, b in blobs:
            to = [p - q for p, q in zip(b, s)]
            m = dot(to, u)
            depth += line(a, c, dot(to, to) - m * m, m, d)
        return beta * mp.exp(-depth) / d2

    # (place, smallest size there)
    events = [(mp.mpf(0), dist), (dist, dist), (foot, mp.sqrt(height2))]
    densest = beta0 + sum(c for _, c, _, _ in views)
    if densest > 0:
        events += [(mp.mpf(0), 1 / densest), (foot, 1 / densest)]
    for a, c, rho2, m in views:
        outside = max(-m, m - dist, 0)
        events.append((min(max(m, 0), dist), 1 / (a * max(1, 2 * a * outside))))
    points = {mp.mpf(0), dist}
    for place, size in events:
        step = size / 4
        points.add(place)
        while step < dist:
            points |= {place - step, place + step}
            step *= 1.6
    points = sorted(p for p in points if 0 <= p <= dist)
    total = mp.mpf(0)
    for lo, hi in zip(points, points[1:]):
        if hi - lo < mp.mpf("1e-22") * dist:
            continue
        parts = 2 ** halvings
        half = (hi - lo) / (2 * parts)
        for k in range(parts):
            middle = lo + (2 * k + 1) * half
            total += half * sum(wt * integrand(middle + half * x) for x, wt in rule())
    return total / (4 * mp.pi)


def scene(rng, kind):
    """beta0, light, direction, dist, blobs"""
    direction = [rng.gauss(0, 1) for _ in range(3)]
    norm = math.sqrt(sum(x * x for x in direction))
    direction = [x / norm for x in direction]
    dist = 10.0

    def at(t, off):
        side = [rng.gauss(0, 1) for _ in range(3)]
        along = sum(x * y for x, y in zip(side, direction))
        side = [x - along * y for x, y in zip(side, direction)]
        size = math.sqrt(sum(x * x for x in side))
        return [t * y + off * x / size for x, y in zip(side, direction)]

    light = at(rng.uniform(-2, 12), rng.uniform(0.2, 3))
    beta0 = rng.choice([0.0, 0.02, 0.3])
    blobs = [(rng.uniform(0.4, 3), rng.uniform(0.1, 2), at(rng.uniform(-1, 11), rng.uniform(0, 2)))
             for _ in range(2)]
    if kind == "near light":
        light = at(rng.uniform(0, 10), 10 ** rng.uniform(-6, -2))
    elif kind == "light in a blob":
        blobs[0] = (blobs[0][0], rng.uniform(1, 10), light)
    elif kind == "narrow":
        blobs = [(10 ** rng.uniform(3, 4), 10 ** rng.uniform(1, 3), at(rng.uniform(0, 10), 0.0))
                 for _ in range(2)]
        blobs[1] = (blobs[1][0], blobs[1][1], at(rng.uniform(0, 10), 2 / blobs[1][0]))
    elif kind == "dense":
        blobs = [(rng.uniform(0.3, 1), 1e3, at(rng.uniform(4, 8), rng.uniform(0, 1)))]
        light = at(-1.0, 1.0)
    elif kind == "viewer inside":
        blobs = [(0.5, rng.uniform(10, 40), at(0.5, 0.1))]
        light = at(1.0, 0.5)
    elif kind == "far tail":
        blobs = [(3.0, 1.0, at(5.0, rng.uniform(3, 7))), (2.0, 1.0, at(-4.0, 1.0))]
        beta0 = 0.0
    elif kind == "many":
        blobs = [(rng.uniform(0.5, 5), rng.uniform(0.1, 1), at(rng.uniform(-1, 11), rng.uniform(0, 3)))
                 for _ in range(12)]
    elif kind == "uniform":
        blobs, beta0 = [], 0.3
    return beta0, light, direction, dist, blobs


def main():
    kinds = ("near light", "light in a blob", "narrow", "dense", "viewer inside", "far tail",
             "many", "uniform")
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 24
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    rng = random.Random(seed)
    note = f"# Written by make_gaussian_airlight.py {count} {seed}: mpmath, at these doubles."
    with open(sys.argv[1], "w") as scenes, open(sys.argv[2], "w") as lists:
        print(note, file=scenes)
        print("scene,n,b0,light_x,light_y,light_z,dir_x,dir_y,dir_z,dr,La", file=scenes)
        print(note, file=lists)
        print("scene,i,a,c,bx,by,bz", file=lists)
        for number in range(count):
            beta0, light, direction, dist, blobs = scene(rng, kinds[number % len(kinds)])
            value = airlight(beta0, light, direction, dist, blobs, 0)
            if len(blobs) < 5:
                again = airlight(beta0, light, direction, dist, blobs, 1)
                assert abs(again / value - 1) < 1e-15, (number, kinds[number % len(kinds)])
            fields = [number, len(blobs), beta0, *light, *direction, dist]
            print(",".join(map(repr, fields)) + "," + mp.nstr(value, 18), file=scenes, flush=True)
            for i, (a, c, b) in enumerate(blobs):
                print(",".join(map(repr, [number, i, a, c, *b])), file=lists, flush=True)


main()
