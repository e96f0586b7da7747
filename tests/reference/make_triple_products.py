#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes triple_products.csv: i, j, k, int Y_i Y_j Y_k over the sphere, exact to the last digit.

The integrand over cos(theta) is a polynomial with rational coefficients up to the square root of the
norms, and the one over phi is expanded in exponentials; nothing here is quadrature.
"""
import itertools
import random
from fractions import Fraction
from math import comb, factorial

import mpmath

mpmath.mp.dps = 40


def degree(index):
    l = 0
    while (l + 1) ** 2 <= index:
        l += 1
    return l, index - l * (l + 1)


def legendre_derivative(l, m):
    """Coefficients of d^m P_l / dx^m, lowest power first."""
    c = [Fraction(0)] * (l + 1)
    for k in range(l // 2 + 1):
        c[l - 2 * k] = Fraction((-1) ** k * comb(l, k) * comb(2 * l - 2 * k, l), 2**l)
    for _ in range(m):
        c = [n * c[n] for n in range(1, len(c))]
    return c


def multiply(a, b):
    out = [Fraction(0)] * (len(a) + len(b) - 1)
    for (i, x), (j, y) in itertools.product(enumerate(a), enumerate(b)):
        out[i + j] += x * y
    return out


def azimuthal(orders):
    """int over phi of cos(m phi) for m >= 0 and sin(|m| phi) for m < 0, in units of pi."""
    # cos = (e + e*) / 2, sin = -i (e - e*) / 2: sum over the signs that cancel.
    total = 0
    for signs in itertools.product((1, -1), repeat=3):
        if sum(s * abs(m) for s, m in zip(signs, orders)) != 0:
            continue
        term = 1
        for s, m in zip(signs, orders):
            term *= (-1j * s if m < 0 else 1) / 2
        total += term
    return Fraction(2 * total.real).limit_denominator(8)


def gamma(i, j, k):
    slots = [degree(n) for n in (i, j, k)]
    around = azimuthal([m for _, m in slots])
    if around == 0:
        return mpmath.mpf(0)
    polynomial, square = [Fraction(1)], Fraction(1)
    for l, m in slots:
        a = abs(m)
        polynomial = multiply(polynomial, legendre_derivative(l, a))
        # The square of the norm, without 1 / (4 pi); 2 where cosines and sines are.
        square *= Fraction((2 * l + 1) * factorial(l - a), factorial(l + a)) * (2 if a else 1)
    for _ in range(sum(abs(m) for _, m in slots) // 2):
        polynomial = multiply(polynomial, [Fraction(1), Fraction(0), Fraction(-1)])
    integral = sum(c * Fraction(2, n + 1) for n, c in enumerate(polynomial) if n % 2 == 0)
    value = integral * around
    root = mpmath.sqrt(mpmath.mpf(square.numerator) / square.denominator)
    return (mpmath.mpf(value.numerator) / value.denominator * root * mpmath.pi
            / (4 * mpmath.pi) ** mpmath.mpf("1.5"))


rows = [triple for triple in itertools.combinations_with_replacement(range(9), 3)]
random.seed(4)
for size in (25, 36, 64, 256):
    found = 0
    while found < 150:
        triple = tuple(random.randrange(size) for _ in range(3))
        (l1, m1), (l2, m2), (l3, m3) = (degree(n) for n in triple)
        if (l1 + l2 + l3) % 2 or not abs(l1 - l2) <= l3 <= l1 + l2:
            continue
        if azimuthal([m1, m2, m3]) == 0:
            continue
        rows.append(triple)
        found += 1
with open("triple_products.csv", "w", encoding="ascii") as out:
    out.write("i,j,k,gamma\n")
    for triple in rows:
        out.write(",".join(map(str, triple)) + "," + mpmath.nstr(gamma(*triple), 18) + "\n")
