#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes medium/ray_integral_fit.h: a rational fit of H(y, theta, inf) for float arithmetic.

    H = r (A(s, c) - s ln(s) B(s, c)) / C(s, c),   r = 1 / (y + 2),  s = y r,  c = cos(theta)

with A, B, C polynomials in u = 2 s - 1 and v = 2 c - 1. H has a term y ln(y) at y = 0, which B
takes, and no other singularity for c > -1 but an essential one at y = inf. Linearised least squares
on the relative error, reweighted towards the largest errors (Lawson) and by the last denominator
(Sanathanan-Koerner); a small penalty on the coefficients keeps A and B from cancelling in float.

Usage: python3 medium/make_ray_integral_fit.py | clang-format > medium/ray_integral_fit.h
(needs numpy and scipy).
"""
import sys

import numpy as np
from numpy.polynomial import chebyshev
from scipy.special import exp1

OFFSET = 2.0
# Highest powers of (u, v); terms (i, j) with i / i_max + j / j_max <= CUT are kept.
SMOOTH, LOGARITHMIC, DENOMINATOR = (6, 3), (4, 3), (4, 3)
CUT = 1.35
PENALTY = 5e-9
ROUNDS = 90


def infinite_ray_integral(y, c):
    """H = -Im(e^z E1(z)) / sin(theta), z = y e^{i theta}."""
    s = np.sqrt((1 - c) * (1 + c))
    z = y * (c + 1j * s)
    near = np.abs(z) < 600
    g = np.exp(np.where(near, z, 1)) * exp1(np.where(near, z, 1))
    far, term = 0, 1 / np.where(near, 1e3, z)
    for k in range(1, 13):
        far = far + term
        term = term * (-k) / np.where(near, 1e3, z)
    return -np.where(near, g, far).imag / s


def terms(degrees):
    return [(i, j) for i in range(degrees[0] + 1) for j in range(degrees[1] + 1)
            if i / degrees[0] + j / degrees[1] <= CUT]


def columns(degrees, s, c):
    def t(n, x):
        return np.cos(n * np.arccos(np.clip(2 * x - 1, -1, 1)))
    return np.array([t(i, s) * t(j, c) for i, j in terms(degrees)]).T


def fit():
    y = np.concatenate([np.logspace(-9, -3, 60), np.logspace(-3, 3, 420), np.logspace(3, 8, 50)])
    c = (1 - np.cos(np.arange(25) * np.pi / 24)) / 2
    c[-1] = 1 - 1e-7
    y, c = (a.ravel() for a in np.meshgrid(y, c, indexing="ij"))
    s = y / (y + OFFSET)
    scaled = infinite_ray_integral(y, c) * (y + OFFSET)
    numerator = np.hstack([columns(SMOOTH, s, c),
                           -(s * np.log(s))[:, None] * columns(LOGARITHMIC, s, c)])
    denominator = columns(DENOMINATOR, s, c)[:, 1:]
    matrix = np.hstack([numerator / scaled[:, None], -denominator])
    split = numerator.shape[1]
    weight, last = np.ones(len(y)), np.ones(len(y))
    best, least = None, np.inf
    for _ in range(ROUNDS):
        w = weight / last
        penalty = PENALTY * np.sqrt(len(y)) * np.eye(matrix.shape[1])
        x = np.linalg.lstsq(np.vstack([matrix * w[:, None], penalty]),
                            np.r_[w, np.zeros(matrix.shape[1])], rcond=1e-16)[0]
        q = 1 + denominator @ x[split:]
        error = np.abs(numerator @ x[:split] / q / scaled - 1)
        if q.min() > 0.02 and error.max() < least:
            best, least = x, error.max()
        weight = weight * (error / error.max() + 0.02) ** 0.3
        weight /= weight.max()
        last = np.abs(q) + 1e-3
    print(f"largest relative error of the fit: {least:.2e}", file=sys.stderr)
    a = len(terms(SMOOTH))
    return best[:a], best[a:split], np.r_[1, best[split:]]


def powers(coefficients, degrees):
    """Rows are powers of v, columns powers of u."""
    m = np.zeros((degrees[1] + 1, degrees[0] + 1))
    for value, (i, j) in zip(coefficients, terms(degrees)):
        u = chebyshev.cheb2poly([0] * i + [1])
        v = chebyshev.cheb2poly([0] * j + [1])
        m[:len(v), :len(u)] += value * np.outer(v, u)
    return m


def write(name, coefficients, degrees):
    m = powers(coefficients, degrees)
    lengths = [1 + max(i for i, j in terms(degrees) if j >= row) for row in range(len(m))]
    print(f"struct {name} {{")
    print(f"static constexpr int kRows = {len(m)};")
    print(f"static constexpr int kLengths[kRows] = {{{', '.join(map(str, lengths))}}};")
    print(f"static constexpr float kPowers[kRows][{m.shape[1]}] = {{")
    for row in m:
        print("{" + ", ".join(f"{np.float32(x):.9e}f" for x in row) + "},")
    print("};\n};")


def main():
    print("""// SPDX-License-Identifier: Apache-2.0
// Written by medium/make_ray_integral_fit.py: coefficients of
//     H(y, theta, inf) = r (A - s ln(s) B) / C,   r = 1 / (y + 2),  s = y r,
// A (smooth), B (logarithmic), C (denominator) polynomials in u = 2 s - 1 (columns) and
// v = 2 cos(theta) - 1 (rows); row j holds no power of u from its length on.
#pragma once

namespace airlight {
namespace detail {
""")
    for name, part, degrees in zip(("FitSmooth", "FitLogarithmic", "FitDenominator"), fit(),
                                   (SMOOTH, LOGARITHMIC, DENOMINATOR)):
        write(name, part, degrees)
        print()
    print("}  // namespace detail\n}  // namespace airlight")


if __name__ == "__main__":
    main()
