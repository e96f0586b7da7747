#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden values of the density fields in their corners, by mpmath.

Usage: python3 make_density_corners.py TABLE [COUNT] [SEED] > TABLE_corners.csv

TABLE is one of chapman, exp2erfc, linear, optdepth_sphere, rectexp. Draws COUNT rows (default: the number in the shipped file) and evaluates
them at the exact doubles that are printed. Formulas are the plain ones of the definition, at
thousands of digits where they cancel.
"""
import math
import random
import sys
from fractions import Fraction

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


def size(rng):
    """Positive, of all sizes."""
    return rng.choice([
        lambda: 10 ** rng.uniform(-3, 3),
        lambda: 10 ** rng.uniform(-12, 12),
        lambda: 10 ** rng.uniform(-300, 300),
        lambda: rng.choice([5e-324, 1e-310, 1.0, 2.2250738585072014e-308, 1.7e308]),
    ])()


def sign(rng):
    return rng.choice([-1, 1])


def upward(rng):
    return rng.choice([
        lambda: rng.uniform(-1, 1),
        lambda: sign(rng) * 10 ** rng.uniform(-17, 0),
        lambda: sign(rng) * 10 ** rng.uniform(-310, 0),
        lambda: rng.choice([-1.0, 1.0, 0.0, -0.0]),
    ])()


def rational(x):
    """A rational number for mpmath, at the precision of the moment."""
    return mp.mpf(x.numerator) / x.denominator


def exponential_column(height, up, dist, n):
    """int_0^dist e^{-n (height + s up)} ds; exact rationals up to the exponentials."""
    with mp.workdps(DIGITS):
        rate = Fraction(n) * Fraction(up)
        base = rational(Fraction(n) * Fraction(height))
        if math.isinf(dist):
            return mp.exp(-base) / rational(rate)
        if rate == 0:
            return mp.exp(-base) * mp.mpf(dist)
        y = rational(rate * Fraction(dist))
        end = rational(Fraction(n) * (Fraction(height) + Fraction(up) * Fraction(dist)))
        if y > 0:
            return -mp.exp(-base) * mp.expm1(-y) / rational(rate)
        return mp.exp(-end) * mp.expm1(y) / rational(rate)


def exponential_ray(rng):
    """height, up, dist, n with exponents within reach of a double, most of the time."""
    n = sign(rng) * size(rng) if rng.random() < 0.95 else 0.0
    height = rng.choice([
        lambda: rng.uniform(-700, 700) / n if n else 1.0,
        lambda: rng.uniform(-5, 5) / n if n else 1.0,
        lambda: sign(rng) * size(rng),
        lambda: 0.0,
    ])()
    up = upward(rng)
    dist = rng.choice([
        lambda: size(rng),
        lambda: 10 ** rng.uniform(-3, 3) / abs(n * up) if n * up else 1.0,
        lambda: abs(height / up) * (1 + rng.uniform(-1, 1) * 10 ** rng.uniform(-16, -1))
        if up else 1.0,
        lambda: math.inf,
    ])()
    return height, up, dist, n


def rectexp_rows(rng, count):
    print("height,dirZ,dist,n,tau_over_seaLvlAtt")
    done = 0
    while done < count:
        try:
            height, up, dist, n = exponential_ray(rng)
        except (OverflowError, ZeroDivisionError):
            continue
        if not all(map(math.isfinite, (height, n))) or math.isnan(dist):
            continue
        if math.isinf(dist) and n * up <= 0:
            continue
        if abs(Fraction(n) * Fraction(height)) > 10 ** 7:
            continue
        if math.isfinite(dist) and abs(Fraction(n) * Fraction(up) * Fraction(dist)) > 10 ** 7:
            continue
        value = exponential_column(height, up, dist, n)
        if in_range(value):
            print(f"{height!r},{up!r},{dist!r},{n!r},{show(value)}")
            done += 1


def linear_column(a, k, height, up, dist):
    """int_0^dist max(0, a (height + s up) + k) ds, exactly."""
    a, k, height, up, dist = map(Fraction, (a, k, height, up, dist))
    first, gradient = a * height + k, a * up
    last = first + gradient * dist
    if first >= 0 and last >= 0:
        return dist * (first + last) / 2
    if first <= 0 and last <= 0:
        return Fraction(0)
    return (first if first > 0 else last) ** 2 / (2 * abs(gradient))


def linear_ray(rng):
    a = sign(rng) * size(rng) if rng.random() < 0.95 else 0.0
    height = sign(rng) * size(rng)
    k = rng.choice([
        lambda: sign(rng) * size(rng),
        lambda: -a * height * (1 + sign(rng) * 10 ** rng.uniform(-17, 0)),
        lambda: -a * height,
    ])()
    up = upward(rng)
    end = abs((a * height + k) / (a * up)) if a * up else 1.0
    dist = rng.choice([
        lambda: size(rng),
        lambda: end * (1 + sign(rng) * 10 ** rng.uniform(-17, 0)),
        lambda: end * rng.uniform(0, 3),
    ])()
    return a, k, height, up, dist


def linear_rows(rng, count):
    print("a,k,height,dirZ,dist,tau_over_sigma_clamped")
    done = 0
    while done < count:
        row = linear_ray(rng)
        if not all(map(math.isfinite, row)):
            continue
        with mp.workdps(DIGITS):
            value = rational(linear_column(*row))
        if value == 0 and rng.random() < 0.9:
            continue
        if value == 0 or in_range(value):
            print(",".join(map(repr, row)) + "," + show(value))
            done += 1


def legendre_nodes(n):
    """Gauss-Legendre on [0, 1]."""
    nodes = []
    for i in range(n):
        x = mp.cos(mp.pi * (i + mp.mpf(3) / 4) / (n + mp.mpf(1) / 2))
        for _ in range(8):
            previous, current = mp.mpf(1), x
            for k in range(1, n):
                previous, current = current, ((2 * k + 1) * x * current - k * previous) / (k + 1)
            slope = n * (x * current - previous) / (x * x - 1)
            x -= current / slope
        nodes.append(((1 + x) / 2, 1 / ((1 - x * x) * slope * slope)))
    return nodes


def rising_column(periapsis, start, end, scale):
    """int_start^end e^{-(sqrt(periapsis^2 + u^2) - lowest) / scale} du, 0 <= start <= end, lowest
    the root at the start; by u = periapsis sinh(w) on short panels."""
    lowest = mp.sqrt(periapsis ** 2 + start ** 2)
    reach = mp.sqrt((lowest + 110 * scale) ** 2 - periapsis ** 2)
    end = min(end, reach)
    if end <= start:
        return mp.mpf(0)
    if periapsis == 0:
        return -scale * mp.expm1(-(end - start) / scale)
    w0, w1 = mp.asinh(start / periapsis), mp.asinh(end / periapsis)
    panels = 8 + int(2 * (w1 - w0))
    total = mp.mpf(0)
    for k in range(panels):
        for x, weight in NODES:
            distance = periapsis * mp.cosh(w0 + (w1 - w0) * (k + x) / panels)
            total += weight * mp.exp(-(distance - lowest) / scale) * distance
    return total * (w1 - w0) / panels


def spherical_column(radius, scale, r, cosine, dist):
    """(ln of the density at the densest point, the column over that density)"""
    radius, scale, r, cosine = map(mp.mpf, (radius, scale, r, cosine))
    dist = mp.mpf(dist)
    start, periapsis = r * cosine, r * mp.sqrt(1 - cosine ** 2)
    end = start + dist
    if start < 0 < end:
        low = periapsis
        value = rising_column(periapsis, mp.mpf(0), -start, scale)
        value += rising_column(periapsis, mp.mpf(0), end, scale)
    else:
        near, far = sorted((abs(start), abs(end)))
        low = mp.sqrt(periapsis ** 2 + near ** 2)
        value = rising_column(periapsis, near, far, scale)
    return (radius - low) / scale, value


def cosines(rng):
    return rng.choice([
        lambda: rng.uniform(-1, 1),
        lambda: sign(rng) * 10 ** rng.uniform(-16, 0),
        lambda: sign(rng) * (1 - 10 ** rng.uniform(-16, 0)),
        lambda: rng.choice([-1.0, 1.0, 0.0]),
    ])()


def chapman_rows(rng, count):
    print("z,cosTheta,lnC")
    for _ in range(count):
        z = rng.choice([
            lambda: 10 ** rng.uniform(-3, 8),
            lambda: 10 ** rng.uniform(-12, 20),
            lambda: rng.uniform(0, 10),
        ])()
        cosine = cosines(rng)
        with mp.workdps(DIGITS + 20):
            exponent, value = spherical_column(z, 1, z, cosine, mp.inf)
            logarithm = exponent + mp.log(value)
            # e^{-110} is left out.
            print(f"{z!r},{cosine!r},{show(logarithm) if logarithm > 1e-40 else 0}")


def optdepth_sphere_rows(rng, count):
    print("R,H,r,cosTheta,dist,tau_over_seaLvlAtt")
    done = 0
    while done < count:
        scale = 10 ** rng.uniform(-2, 5)
        radius = rng.choice([lambda: 6371000.0, lambda: scale * 10 ** rng.uniform(-3, 9)])()
        r = rng.choice([
            lambda: abs(radius + rng.uniform(-30, 30) * scale),
            lambda: radius,
            lambda: radius * rng.uniform(0, 3),
            lambda: radius + 10 ** rng.uniform(-6, 0),
        ])()
        cosine = cosines(rng)
        middle = abs(r * cosine)
        dist = rng.choice([
            lambda: scale * 10 ** rng.uniform(-9, 3),
            lambda: middle * (1 + sign(rng) * 10 ** rng.uniform(-16, 0)),
            lambda: middle * rng.uniform(0, 4),
            lambda: rng.uniform(0, 1),
            lambda: math.inf,
        ])()
        with mp.workdps(DIGITS + 20):
            exponent, value = spherical_column(radius, scale, r, cosine, dist)
            value *= mp.exp(exponent)
            if in_range(value):
                print(f"{radius!r},{scale!r},{r!r},{cosine!r},{dist!r},{show(value)}")
                done += 1


with mp.workdps(DIGITS + 20):
    NODES = legendre_nodes(40)

# Makers of rows, and how many the shipped file has.
TABLES = {
    "chapman": (chapman_rows, 200),
    "exp2erfc": (exp2erfc_rows, 120),
    "linear": (linear_rows, 300),
    "optdepth_sphere": (optdepth_sphere_rows, 300),
    "rectexp": (rectexp_rows, 300),
}


def main():
    rows, count = TABLES[sys.argv[1]]
    if len(sys.argv) > 2:
        count = int(sys.argv[2])
    rows(random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1), count)


if __name__ == "__main__":
    main()
