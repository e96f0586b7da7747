#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden values of Gaussian media in their corners, by mpmath.

Usage: python3 make_gaussian.py line|depth [COUNT] [SEED] > FILE.csv

Draws COUNT rows from the corners of the domain and evaluates them at the exact doubles that are
printed. line: the difference of two complementary error functions as it stands, with 1500 digits
to lose. depth: the series of Dawson's function with all terms positive, and where that would be
long its continued fraction by mpmath's erfi, checked against each other in between.
"""
import random
import sys

import mpmath as mp

# erfc(400) is 1e-69000 of erfc(28), the largest start of a segment below.
FAR = 400


def line(a, c, rho, m, dist):
    with mp.workdps(1500):
        a, c, rho, m, dist = map(mp.mpf, (a, c, rho, m, dist))
        lo, hi = -a * m, a * (dist - m)
        if lo > 0:
            part = mp.erfc(lo) - (0 if hi > FAR else mp.erfc(hi))
        elif hi < 0:
            part = mp.erfc(-hi) - mp.erfc(-lo)
        else:
            part = (1 if hi > FAR else mp.erf(hi)) - mp.erf(lo)
        return c * mp.exp(-(a * rho) ** 2) * mp.sqrt(mp.pi) / (2 * a) * part


def line_rows(rng, count):
    print("a,c,rho_perp,m_proj,dist,integral")
    done = 0
    while done < count:
        a = rng.choice([lambda: 10 ** rng.uniform(-3, 3), lambda: 10 ** rng.uniform(-300, 300)])()
        c = rng.choice([lambda: 10 ** rng.uniform(-3, 3), lambda: 10 ** rng.uniform(-300, 300)])()
        unit = 1 / a
        rho = rng.choice([0.0, unit * rng.random(), unit * rng.uniform(0, 30),
                          unit * 10 ** rng.uniform(-20, 1)])
        m = rng.choice([0.0, unit * rng.uniform(-3, 3), unit * rng.uniform(-28, 28),
                        unit * rng.choice([-1, 1]) * 10 ** rng.uniform(-20, 1.4)])
        dist = rng.choice([
            lambda: unit * rng.uniform(0, 5),
            lambda: unit * 10 ** rng.uniform(-20, 2),
            lambda: abs(m) * rng.uniform(0, 2),
            lambda: abs(m) * (1 + rng.choice([-1, 1]) * 10 ** rng.uniform(-16, 0)),
            lambda: 10 ** rng.uniform(-300, 300),
            lambda: abs(m),
            lambda: 5e-324 * rng.randint(1, 9),
            lambda: mp.inf,
        ])()
        dist = float(dist)
        if not dist > 0 or not all(abs(x) < 1e305 for x in (rho, m)):
            continue
        value = line(a, c, rho, m, dist)
        if mp.mpf("1e-306") < value < mp.mpf("1e306"):
            print(f"{a!r},{c!r},{rho!r},{m!r},{dist!r},{mp.nstr(value, 18)}")
            done += 1


def mean_depth(u):
    with mp.workdps(40):
        x = mp.mpf(u)
        if x == 0:
            return mp.sqrt(mp.pi) / 2
        if x > 1e6:
            s = 1 / (2 * x * x)
            return mp.sqrt(mp.pi) * s / 2 * (1 + s + 3 * s * s + 15 * s ** 3)
        if x > 100:
            s = 1 / (2 * x * x)
            total, term = mp.mpf(0), mp.mpf(1)
            for k in range(40):
                total += term
                term *= (2 * k + 1) * s
            return mp.sqrt(mp.pi) * s / 2 * total
        series, term, k = mp.mpf(0), mp.mpf(1), 0
        while term > series * mp.mpf("1e-38"):
            series += term / (2 * k + 1)
            k += 1
            term *= x * x / k
        value = mp.sqrt(mp.pi) / 2 * mp.exp(-x * x) * series
        if x > mp.mpf("1e-8"):
            other = mp.pi / (4 * x) * mp.exp(-x * x) * mp.erfi(x)
            assert abs(other / value - 1) < 1e-25, u
        return value


def depth_rows(rng, count):
    print("u,T")
    for u in (5e-324, 1e-300, 1e-160, 1e-8, 0.25, 6.5, 1e150):
        print(f"{u!r},{mp.nstr(mean_depth(u), 18)}")
    for _ in range(count - 7):
        u = rng.choice([lambda: rng.uniform(0, 12), lambda: 10 ** rng.uniform(-3, 3),
                        lambda: 10 ** rng.uniform(-300, 152)])()
        print(f"{u!r},{mp.nstr(mean_depth(u), 18)}")


def main():
    kind = sys.argv[1]
    shipped = {"line": (line_rows, 400), "depth": (depth_rows, 120)}
    rows, count = shipped[kind]
    count = int(sys.argv[2]) if len(sys.argv) > 2 else count
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    print(f"# Written by make_gaussian.py {kind} {count} {seed}: mpmath, at these doubles.")
    rows(random.Random(seed), count)


main()
