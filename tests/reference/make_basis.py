# SPDX-License-Identifier: Apache-2.0
"""Writes basis.csv: golden values of the real spherical harmonics (mpmath, 60 digits).

Columns x, y, z (exact doubles, not normalised), l, m, Y_lm of the direction (x, y, z).
"""
import math
import os

import mpmath as mp

mp.mp.dps = 60


def column(order, direction, m):
    """Y_lm and Y_l,-m for l = m ... order-1 by the normalised three-term recurrence."""
    x, y, z = map(mp.mpf, direction)
    rho = mp.hypot(x, y)
    r = mp.hypot(rho, z)
    cos_theta, sin_theta = z / r, rho / r
    turn = mp.mpc(x, y) / rho if rho else mp.mpc(1)
    phase = turn**m * (mp.sqrt(2) if m else 1)
    ratio = mp.gamma(m + mp.mpf(3) / 2) / (mp.gamma(mp.mpf(3) / 2) * mp.factorial(m))
    p, previous, scale = mp.sqrt(ratio / (4 * mp.pi)) * sin_theta**m, mp.mpf(0), mp.mpf(1)
    for l in range(m, order):
        yield l, p * phase.real, p * phase.imag
        a = mp.sqrt(mp.mpf((2 * l + 1) * (2 * l + 3)) / ((l + 1 - m) * (l + 1 + m)))
        p, previous, scale = a * (cos_theta * p - previous / scale), p, a


DIRECTIONS = [
    (0.0, 0.0, 1.0),
    (0.0, 0.0, -1.0),
    (0.0, 1.0, 0.0),
    (1e-12, -2e-12, 1.0),
    (3e-4, 1e-4, -1.0),
    (5e-324, -5e-324, 1e-323),
    (-1.5e308, 1e308, 0.25e308),
    (0.479425538604203, 0.0, 0.8775825618903728),
    (-0.25, 0.75, 0.5),
    (0.6, 0.3, -1.7),
    (0.9, -0.4, 1e-3),
]
DEGREES = [0, 1, 2, 7, 15, 16, 63, 511, 4095]


def main():
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "basis.csv")
    with open(path, "w") as out:
        out.write("x,y,z,l,m,Y\n")
        for direction in DIRECTIONS:
            for m in (0, 1, 2, 7, 15, 60, 510, 1600, 2000, 4095):
                for l, even, odd in column(4096, direction, m):
                    if l not in DEGREES:
                        continue
                    for order, value in ((m, even), (-m, odd)):
                        if order == 0 and value is odd:
                            continue
                        if abs(value) < 1e-270:
                            continue
                        row = [*map(repr, direction), str(l), str(order), mp.nstr(value, 18)]
                        out.write(",".join(row) + "\n")


main()
