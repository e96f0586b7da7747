# SPDX-License-Identifier: Apache-2.0
"""Writes psf_sh_extreme.csv: eigenvalues of PSF_T e^T / T where psf_sh.csv has none (mpmath).

Columns T, l, lambda = 2 pi int PSF_T(gamma) e^T / T P_l(cos gamma) sin(gamma) d gamma, taken as
int_0^inf exp(-T (e^t - 1)) Q_l(cosh t) dt at 30 digits.
"""
import os

import mpmath as mp

mp.mp.dps = 30


def legendre_q(l, t):
    if t < 1e-12:
        return -mp.log(t / 2) - mp.euler - mp.psi(0, l + 1)
    half = mp.mpf(1) / 2
    scale = mp.sqrt(mp.pi) * mp.gamma(l + 1) / mp.gamma(l + 3 * half)
    return scale * mp.exp(-(l + 1) * t) * mp.hyp2f1(half, l + 1, l + 3 * half, mp.exp(-2 * t))


def eigenvalue(thickness, l):
    end = mp.mpf(120) / (l + 1)
    first = 1 / (l + 1 + thickness)
    points = [first * mp.mpf(2) ** k for k in range(-8, 80)]
    points = [mp.mpf(0)] + [p for p in points if p < end] + [end]
    return mp.quad(lambda t: mp.exp(-thickness * mp.expm1(t)) * legendre_q(l, t), points)


def main():
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "psf_sh_extreme.csv")
    with open(path, "w") as out:
        out.write("T,l,lambda\n")
        for thickness in (0.0, 1e-8, 1.0, 50.0, 200.0, 1e4):
            for l in (0, 1, 63, 511, 4095):
                value = mp.nstr(eigenvalue(mp.mpf(thickness), l), 18)
                out.write(f"{thickness!r},{l},{value}\n")


main()
