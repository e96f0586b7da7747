#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden values of the surface radiance G_n(T, theta) e^T in its corners, by mpmath.

Usage: python3 make_surface_corners.py [COUNT] [SEED] > surface_Gn_corners.csv

Draws COUNT rows (default: the number in the shipped file) and evaluates them at the exact doubles
that are printed, at 25 digits. The point spread function comes from E1 of a complex argument, the
integral of the lobe over a circle from 2F1, the integral over the angle from tanh-sinh rules on
decades of the angle to its kinks. Every tenth row is computed a second time from nothing but the
definitions, the circle by quadrature of max(0, cos)^n; the script fails if they differ by 1e-15.
"""
import random
import sys

import mpmath as mp

mp.mp.dps = 25


def psf_sine(t, gamma):
    """2 pi PSF_T e^T / T sin(gamma) = H cos(gamma / 2)."""
    theta = (mp.pi - gamma) / 2
    y = 2 * t * mp.sin(gamma / 2)
    if y == 0:
        return theta
    with mp.workdps(50):
        z = y * mp.expj(theta)
        if y > mp.mpf("1e5"):
            value = mp.mpf(0)
            term = 1 / z
            for k in range(1, 14):
                value += term
                term *= -k / z
        else:
            value = mp.exp(z) * mp.e1(z)
        return -mp.im(value)


def circle(gamma, theta, n):
    """int max(0, a + b cos phi)^n d phi"""
    p, m = mp.cos(gamma - theta), mp.cos(gamma + theta)
    if p <= 0:
        return mp.mpf(0)
    if m >= 0:
        return 2 * mp.pi * p**n * mp.hyp2f1(-n, 0.5, 1, (p - m) / p)
    k2 = p / (p - m)
    return p**n * 2 * mp.sqrt(k2) * mp.beta(n + 1, 0.5) * mp.hyp2f1(0.5, 0.5, n + 1.5, k2)


def plain_circle(gamma, theta, n):
    a, b = mp.cos(gamma) * mp.cos(theta), mp.sin(gamma) * mp.sin(theta)
    if a + b <= 0:
        return mp.mpf(0)
    end = mp.acos(-a / b) if b > abs(a) else mp.pi
    width = min(end / 2, 4 / mp.sqrt(n))
    cuts = [mp.mpf(0), width / 2, width, end] if n > 10 else [mp.mpf(0), end / 2, end]
    return 2 * mp.quad(lambda phi: max(0, a + b * mp.cos(phi)) ** n, cuts)


def surface(t, theta, n, ring):
    t, theta, n = mp.mpf(t), mp.mpf(theta), mp.mpf(n)
    delta = abs(mp.pi / 2 - theta)
    lo, hi = (mp.mpf(0), mp.pi - delta) if theta <= mp.pi / 2 else (delta, mp.pi)
    cuts = {lo, hi, delta, mp.pi - delta}
    smallest = min(mp.mpf("1e-3"), 1 / (100 * t)) if t > 0 else mp.mpf("1e-3")
    g = smallest
    while g < 1:
        cuts.add(g)
        g *= 10
    for side in (-1, 1):
        for edge in (delta, mp.pi - delta):
            for k in range(1, 5):
                cuts.add(edge + side * mp.mpf(10) ** (-3 * k))
        for k in (0, 1, 2, 4, 8, 12):
            cuts.add(theta + side * k / mp.sqrt(n))
    cuts = sorted(c for c in cuts if lo <= c <= hi)
    thin = [cuts[0]]
    for c in cuts[1:]:
        if c - thin[-1] > mp.mpf("1e-21"):
            thin.append(c)

    # In units near 1: the tolerance of quad is absolute.
    def part(a, b):
        def integrand(x):
            gamma = a + (b - a) * x
            return (1 + t) * psf_sine(t, gamma) * ring(gamma, theta, n)

        return (b - a) * mp.quad(integrand, [0, 1])

    return mp.fsum(part(a, b) for a, b in zip(thin, thin[1:])) / (1 + t)


def draw(rng):
    n = rng.choice([1.0, 1.0, 1.0, 1.001, 1.5, 2.0, 2.7, 3.0, 4.5, 7.25, 15.5, 16.0, 19.0, 20.0,
                    23.5, 24.0, 24.5, 60.0, 250.0, 999.5, 1000.0])
    half = mp.pi / 2
    theta = rng.choice([0.0, 1e-300, 1e-8, 1e-3, 0.03, 0.2, 0.29, 0.31, 0.6, 1.0, 1.47,
                        float(half) - 1e-3, float(half) - 1e-12, float(half), float(half) + 1e-12,
                        float(half) + 1e-5, 1.67, 2.0, 2.6, 2.84, 2.86, 3.14, float(mp.pi) - 1e-9,
                        float(mp.pi), rng.uniform(0, 3.14159)])
    t = rng.choice([0.0, 5e-324, 1e-300, 1e-8, 1e-3, 0.02, 0.5, 1.0, 2.0, 5.0, 12.0, 20.0, 49.0,
                    50.0, 300.0, 700.0, 1e4, 1e7, 1e12, 10 ** rng.uniform(-3, 3)])
    return t, theta, n


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 160
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    rng = random.Random(seed)
    print(f"# Written by make_surface_corners.py {count} {seed}: mpmath, 25 digits, at these doubles.")
    print("Tsp,theta_s,n,Gn_scaled", flush=True)
    for i in range(count):
        t, theta, n = draw(rng)
        value = surface(t, theta, n, circle)
        if i % 10 == 0:
            again = surface(t, theta, n, plain_circle)
            assert abs(again / value - 1) < 1e-15, (t, theta, n, value, again)
        print(f"{t!r},{theta!r},{n!r},{mp.nstr(value, 18)}", flush=True)


main()
