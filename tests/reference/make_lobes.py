# SPDX-License-Identifier: Apache-2.0
"""Writes lobes_corners.csv: eigenvalues of lobes scaled to their peak (mpmath, 60 digits and more).

Columns lobe, parameter, l, lambda = 2 pi int f P_l(cos gamma) sin(gamma) d gamma, at the exact
double `parameter`. Lobes: 0 clamped cosine to a power (Phong), 1 cone of a half angle, 2 spherical
Gaussian. None uses the recurrences of sh/lobes.cpp: Phong by the beta function of the terms of
P_l or the Gamma functions of a closed form, the cone by P_{l-1} - P_{l+1}, the Gaussian by the
modified Bessel function.
"""
import os

import mpmath as mp

mp.mp.dps = 60


def phong(n, l):
    # int_0^1 x^n P_l dx = sqrt(pi) Gamma(n+1) / (2^{n+1} Gamma((n-l)/2+1) Gamma((n+l+3)/2))
    n = mp.mpf(n)
    if n > 1e15:
        return 2 * mp.pi / (n + 1) * mp.exp(-mp.mpf(l) * (l + 1) / (2 * n))
    return (2 * mp.pi * mp.sqrt(mp.pi) * mp.gamma(n + 1) * mp.mpf(2) ** -(n + 1)
            * mp.rgamma((n - l) / 2 + 1) * mp.rgamma((n + l + 3) / 2))


def cone(a, l):
    a = mp.mpf(a)
    if l == 0:
        return 4 * mp.pi * mp.sin(a / 2) ** 2
    with mp.workdps(900 if a < 1e-30 else 120):
        x = mp.cos(a)
        p = [mp.mpf(1), x]
        for k in range(1, l + 1):
            p.append(((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1))
        return 2 * mp.pi * (p[l - 1] - p[l + 1]) / (2 * l + 1)


def gaussian(k, l):
    k = mp.mpf(k)
    if k == 0:
        return 4 * mp.pi if l == 0 else mp.mpf(0)
    if k > 1e12:
        # The first terms of the finite sum; the next are under 1e-30 of them.
        s, t = mp.mpf(0), mp.mpf(1)
        for j in range(0, min(l, 12) + 1):
            s += t * (-1) ** j
            t *= mp.mpf(l + j + 1) * (l - j) / ((j + 1) * 2 * k)
        return 2 * mp.pi / k * s
    return 4 * mp.pi * mp.exp(-k) * mp.sqrt(mp.pi / (2 * k)) * mp.besseli(l + mp.mpf(1) / 2, k)


def main():
    rows = []
    for n in (0.0, 5e-324, 1e-9, 0.5, 1.0, 1 + 2.0 ** -52, 2.0, 2.999999999999, 20.0, 61.5, 1000.0,
              1e6, 1e12, 1e300):
        rows += [(0, n, l, phong(n, l)) for l in (0, 1, 2, 3, 4, 5, 16, 17, 62, 63, 255, 1023)]
    for a in (1e-300, 1e-160, 1e-120, 1e-90, 1e-8, 1e-4, 0.004652439059837008, 0.1, 1.0,
              1.5707963267948966, 2.0, 3.0, 3.14159, 3.1415926535897927, 3.141592653589793):
        rows += [(1, a, l, cone(a, l)) for l in (0, 1, 2, 3, 8, 63, 255, 1023)]
    for k in (0.0, 5e-324, 1e-300, 1e-12, 1e-3, 0.7, 5.0, 19.999, 20.0, 100.0, 1e3, 5000.0, 65535.0,
              65537.0, 1e6, 1.1e6, 1e9, 1e15, 1e300):
        rows += [(2, k, l, gaussian(k, l)) for l in (0, 1, 2, 3, 8, 63, 255, 1023)]
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "lobes_corners.csv")
    with open(path, "w") as out:
        out.write("lobe,parameter,l,lambda\n")
        for lobe, parameter, l, value in rows:
            out.write(f"{lobe},{parameter!r},{l},{mp.nstr(value, 18)}\n")


main()
