#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes medium/scaled_erfc_table.h: erfcx(x) / t by polynomials in t = 4 / (4 + x).

Usage: python3 medium/make_scaled_erfc.py | clang-format > medium/scaled_erfc_table.h (needs mpmath).

The range (0, 1] of t is cut into equal pieces; on each the polynomial in u = 2 PIECES t - 2 k - 1,
in [-1, 1], interpolates at Chebyshev points.
"""
import mpmath as mp

PIECES = 16
DEGREE = 10

mp.mp.dps = 50


def ratio(t):
    """erfcx(x) / t, continued to t = 0."""
    if t < mp.mpf("1e-12"):
        return 1 / (4 * mp.sqrt(mp.pi)) / (1 - t)
    x = 4 / t - 4
    if x > 60:
        total, term = mp.mpf(0), mp.mpf(1)
        for n in range(60):
            total += term
            term *= -(2 * n + 1) / (2 * x * x)
        return total / (x * mp.sqrt(mp.pi)) / t
    return mp.exp(x * x) * mp.erfc(x) / t


def polynomial(k):
    n = DEGREE + 1
    angles = [mp.pi * (2 * i + 1) / (2 * n) for i in range(n)]
    values = [ratio((2 * k + 1 + mp.cos(a)) / (2 * PIECES)) for a in angles]
    chebyshev = [
        (2 if j else 1) * sum(v * mp.cos(j * a) for v, a in zip(values, angles)) / n
        for j in range(n)
    ]
    # From Chebyshev polynomials to powers.
    powers = [mp.mpf(0)] * n
    previous, current = [mp.mpf(1)], [mp.mpf(0), mp.mpf(1)]
    for j, c in enumerate(chebyshev):
        basis = previous if j == 0 else current
        for i, b in enumerate(basis):
            powers[i] += c * b
        if j > 0:
            following = [mp.mpf(0)] + [2 * b for b in current]
            for i, b in enumerate(previous):
                following[i] -= b
            previous, current = current, following
    worst = 0
    for i in range(41):
        u = -1 + mp.mpf(i) / 20
        exact = ratio((2 * k + 1 + u) / (2 * PIECES))
        worst = max(worst, abs(mp.polyval(powers[::-1], u) / exact - 1))
    assert worst < 3e-17, (k, worst)
    return powers


print("// SPDX-License-Identifier: Apache-2.0")
print("// Written by medium/make_scaled_erfc.py.")
print("#pragma once\n")
print("namespace airlight {\nnamespace detail {\n")
print(f"inline constexpr int kErfcxPieces = {PIECES};")
print(f"inline constexpr int kErfcxDegree = {DEGREE};\n")
print("// (piece of t, power of u)")
print("inline constexpr double kErfcxTable[kErfcxPieces][kErfcxDegree + 1] = {")
for k in range(PIECES):
    print("    {" + ", ".join(mp.nstr(c, 20) for c in polynomial(k)) + "},")
print("};\n")
print("}  // namespace detail\n}  // namespace airlight")
