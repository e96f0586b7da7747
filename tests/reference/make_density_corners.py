#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden values of the density fields in their corners, by mpmath.

Usage: python3 make_density_corners.py TABLE [COUNT] [SEED] > TABLE_corners.csv

TABLE is one of exp2erfc. Draws COUNT rows (default: the number in the shipped file) and evaluates
them at the exact doubles that are printed. Formulas are the plain ones of the definition, at
thousands of digits where they cancel.
"""
import math
import random
import sys

import mpmath as mp

DIGITS = 50


def show(value):
    return mp.nstr(value, 18)


def in_range(value):
    return mp.mpf("1e-290") < value < mp.mpf("1e300")


def erfcx(x):
    with mp.workdps(DIGITS + int(x * x / 2) if x < 0 else DIGITS):
        x = mp.mpf(x)
        if x < 1e4:
            return mp.exp(x * x) * mp.erfc(x)
        total, term = mp.mpf(0), mp.mpf(1)
        for n in range(12):
            total += term
            term *= -(2 * n + 1) / (2 * x * x)
        return total / (x * mp.sqrt(mp.pi))


def exp2erfc_rows(rng, count):
    print("x,erfcx")
    for _ in range(count):
        x = rng.choice([
            lambda: rng.uniform(0, 10),
            lambda: -rng.uniform(0, 26),
            lambda: rng.choice([-1, 1]) * 10 ** rng.uniform(-20, 0),
            lambda: 10 ** rng.uniform(0, 290),
            lambda: 4 / (rng.randint(1, 16) / 16) - 4 + rng.uniform(-1e-9, 1e-9),
            lambda: rng.choice([5e-324, -5e-324, 1e-310, -26.6, 26.6, 1e-16]),
        ])()
        print(f"{x!r},{show(erfcx(x))}")


# Makers of rows, and how many the shipped file has.
TABLES = {
    "exp2erfc": (exp2erfc_rows, 120),
}


def main():
    rows, count = TABLES[sys.argv[1]]
    if len(sys.argv) > 2:
        count = int(sys.argv[2])
    rows(random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1), count)


if __name__ == "__main__":
    main()
