#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden values of the slab's near-light integrals in their corners, by mpmath.

Usage: python3 make_slab_corners.py [COUNT] [SEED] > slab_corners.csv

Draws COUNT rows from the corners of the domain and evaluates

    int_0^s e^{-sigma_t (x + k)} dx  and the same over h^2,
    h^2 = x^2 + l^2 + 2 x l (w.wl),  k = x (w.n) h / (l (wl.n) + x (w.n)),

at the exact doubles that are printed. The integrand is taken as it stands, at 400 digits, with no
change of variable; Gauss-Legendre panels of 30 nodes on a mesh graded towards x = 0 and towards
the point next to the light are halved until halving changes no panel by 1e-24 of the sum.
"""
import math
import random
import sys

import mpmath as mp

DIGITS = 34
NODES = 30


def legendre(n):
    rule = []
    with mp.workdps(60):
        for i in range(n):
            x = mp.cos(mp.pi * (i + mp.mpf(3) / 4) / (n + mp.mpf(1) / 2))
            for _ in range(8):
                p0, p1 = mp.mpf(1), x
                for k in range(2, n + 1):
                    p0, p1 = p1, ((2 * k - 1) * x * p1 - (k - 1) * p0) / k
                slope = n * (x * p1 - p0) / (x * x - 1)
                x -= p1 / slope
            rule.append((x, 2 / ((1 - x * x) * slope * slope)))
    return rule


RULE = legendre(NODES)


def integrals(row):
    sigma, s, l, a, b, g = (mp.mpf(v) for v in row)

    def depth_and_square(x):
        with mp.workdps(400):
            square = x * x + l * l + 2 * x * l * g
        h = mp.sqrt(+square)
        inside = x * a / (l * b + x * a) if b > 0 else mp.mpf(1)
        return sigma * (x + inside * h), +square

    start = depth_and_square(mp.mpf(0))[0]
    end = s if sigma == 0 else min(s, 300 / sigma)
    near = -l * g
    with mp.workdps(400):
        width = l * mp.sqrt((1 - g) * (1 + g))
    scales = [l, end]
    if sigma > 0:
        scales.append(1 / sigma)
    if a > 0 and b > 0:
        scales.append(l * b / a)
        if sigma > 0:
            scales.append(1 / (sigma * (1 + a / b)))
    mesh, x = {mp.mpf(0), end}, min(scales) / 100
    while x < end:
        mesh.add(x)
        x *= 3
    if 0 < near:
        x = max(width / 3, near * mp.mpf(10) ** -25)
        mesh.add(near)
        while x < near:
            mesh |= {near - x, near + x}
            x *= 3
    mesh = sorted(x for x in mesh if 0 <= x <= end)

    def panel(lo, hi):
        mid, half = (lo + hi) / 2, (hi - lo) / 2
        flat = square = mp.mpf(0)
        for node, weight in RULE:
            depth, h2 = depth_and_square(mid + half * node)
            value = weight * mp.exp(start - depth)
            flat += value
            square += value / h2
        return flat * half, square * half

    work = [(lo, hi, panel(lo, hi)) for lo, hi in zip(mesh, mesh[1:])]
    totals = [sum(w[2][i] for w in work) for i in range(2)]
    done = [mp.mpf(0)] * 2
    while work:
        lo, hi, whole = work.pop()
        mid = (lo + hi) / 2
        parts = panel(lo, mid), panel(mid, hi)
        sums = [parts[0][i] + parts[1][i] for i in range(2)]
        if all(abs(sums[i] - whole[i]) <= mp.mpf("1e-24") * totals[i] for i in range(2)):
            done = [done[i] + sums[i] for i in range(2)]
        else:
            work += [(lo, mid, parts[0]), (mid, hi, parts[1])]
    return [mp.exp(-start) * value for value in done]


def draw(rng):
    uniform = rng.uniform
    sigma = rng.choice([
        lambda: 10 ** uniform(-2, 2),
        lambda: 10 ** uniform(-8, 4),
        lambda: 10 ** uniform(-100, 0),
    ])()
    l = rng.choice([lambda: 10 ** uniform(-2, 2), lambda: 10 ** uniform(-8, 8)])()
    s = rng.choice([
        lambda: l * 10 ** uniform(-3, 3),
        lambda: 10 ** uniform(-8, 8),
        lambda: l * (1 + rng.choice([-1, 1]) * 10 ** uniform(-15, -1)),
    ])()
    a, b = (rng.choice([
        lambda: uniform(0, 1),
        lambda: 10 ** uniform(-16, 0),
        lambda: 10 ** uniform(-300, 0),
        lambda: rng.choice([1.0, 1e-12, 0.0, 1 - 2**-53]),
    ])() for _ in range(2))
    # The angle between two directions of given heights over the surface.
    turn = rng.choice([lambda: uniform(0, math.pi), lambda: math.pi - 10 ** uniform(-9, 0)])()
    g = a * b + math.sqrt((1 - a * a) * (1 - b * b)) * math.cos(turn)
    if rng.random() < 0.15:
        g = rng.choice([-1, 1]) * (1 - 10 ** uniform(-16, -1))
    return sigma, s, l, a, b, max(-1.0, min(1.0, g))


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    mp.mp.dps = DIGITS
    rng = random.Random(seed)
    print(f"# Written by make_slab_corners.py {count} {seed}: mpmath, 34 digits, at these doubles.")
    print("sigma_t,s,l,w_dot_n,wl_dot_n,w_dot_wl,exp_only,with_h2")
    done = 0
    while done < count:
        row = draw(rng)
        if row[5] == -1 and row[1] >= row[2] or row[3] == row[4] == 0:
            continue
        flat, square = integrals(row)
        if min(flat, square) < mp.mpf("1e-290") or square > mp.mpf("1e290"):
            continue
        print(",".join([*map(repr, row), mp.nstr(flat, 18), mp.nstr(square, 18)]), flush=True)
        done += 1


main()
