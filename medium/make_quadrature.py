#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes medium/quadrature.cpp: Gauss-Legendre and truncated Gauss-Laguerre rules as literals.

Usage: python3 medium/make_quadrature.py | clang-format > medium/quadrature.cpp (needs mpmath).
"""
import mpmath as mp

LEGENDRE = (6, 8, 12, 16, 24, 32)
# (number of nodes of the full rule, least weight that is kept)
LAGUERRE = ((24, mp.mpf("1e-19")), (80, mp.mpf("1e-19")))


def eigenvalues(diagonal, off_diagonal):
    n = len(diagonal)
    matrix = mp.matrix(n, n)
    for i in range(n):
        matrix[i, i] = diagonal[i]
        if i + 1 < n:
            matrix[i, i + 1] = matrix[i + 1, i] = off_diagonal[i]
    return sorted(mp.eigsy(matrix, eigvals_only=True))


def legendre(n):
    def pair(x):
        previous, current = mp.mpf(1), x
        for k in range(1, n):
            previous, current = current, ((2 * k + 1) * x * current - k * previous) / (k + 1)
        return current, n * (x * current - previous) / (x * x - 1)

    with mp.workdps(20):
        guess = eigenvalues([0] * n, [i / mp.sqrt(4 * i * i - 1) for i in range(1, n)])
    rule = []
    for x in guess:
        for _ in range(6):
            value, slope = pair(x)
            x -= value / slope
        rule.append((x, 2 / ((1 - x * x) * pair(x)[1] ** 2)))
    return rule


def laguerre(n, least):
    def pair(x, last):
        previous, current = mp.mpf(1), 1 - x
        for k in range(1, last):
            previous, current = current, ((2 * k + 1 - x) * current - k * previous) / (k + 1)
        return previous, current

    with mp.workdps(20):
        guess = eigenvalues([2 * i + 1 for i in range(n)], list(range(1, n)))
    rule = []
    for x in guess:
        for _ in range(6):
            previous, current = pair(x, n)
            x -= current * x / (n * (current - previous))
        weight = x / ((n + 1) * pair(x, n + 1)[1]) ** 2
        if weight > least:
            rule.append((x, weight))
    return rule


def table(name, rule):
    print(f"const QuadratureNode {name}[{len(rule)}] = {{")
    for x, w in rule:
        print(f"    {{{mp.nstr(x, 20)}, {mp.nstr(w, 20)}}},")
    print("};\n")


mp.mp.dps = 60
print("// SPDX-License-Identifier: Apache-2.0")
print("// Written by medium/make_quadrature.py.")
print('#include "medium/quadrature.h"\n')
print("namespace airlight {\nnamespace detail {\nnamespace {\n")
for n in LEGENDRE:
    table(f"kLegendre{n}", [p for p in legendre(n) if p[0] > 0])
sizes = []
for n, least in LAGUERRE:
    rule = laguerre(n, least)
    sizes.append((n, len(rule)))
    table(f"kLaguerre{n}", rule)
print("}  // namespace\n")
print("QuadratureRule gauss_legendre(int nodes) {\n    switch (nodes) {")
for n in LEGENDRE:
    print(f"        case {n}: return {{kLegendre{n}, {n // 2}}};")
print("        default: return {nullptr, 0};\n    }\n}\n")
for n, kept in sizes:
    print(f"QuadratureRule gauss_laguerre_{n}() {{ return {{kLaguerre{n}, {kept}}}; }}\n")
print("}  // namespace detail\n}  // namespace airlight")
