#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden values of airlight, F and the scaled PSF in their corners, by mpmath.

Usage: python3 make_corners.py airlight|F|psf [COUNT] [SEED] > FILE.csv

Draws COUNT rows (default: the number in the shipped file) from the corners of the domain and
evaluates them at the exact doubles that are printed. The geometry is done naively at 2200 digits,
so that no rearrangement of ours can be wrong here too; the integral is then Gauss-Legendre on
short panels at 40 digits. Rows on which the closed form with E1 of a complex argument works at
120 digits are checked against it to 1e-25, the script fails otherwise.
"""
import math
import random
import sys

import mpmath as mp

GEOMETRY_DIGITS = 2200
DIGITS = 40


def mean_h(y, c, x_end):
    """int_0^X e^{-y x} / (x^2 + 2 c x + 1) dx / X, or without the division for X = inf."""
    with mp.workdps(DIGITS):
        y, c, x_end = +y, +c, +x_end
        if x_end < mp.mpf("1e-80") and y * x_end < mp.mpf("1e-40"):
            return mp.mpf(1)
        limit = min(x_end, mp.mpf("1e90"))
        if y > 0:
            limit = min(limit, 110 / y)
        # x = sinh t + 2 c sinh^2(t / 2) has the derivative sqrt(x^2 + 2 c x + 1)
        d = mp.sqrt(limit * limit + 2 * c * limit + 1)
        t_end = mp.asinh(limit * (limit + 2 * c) / (limit + c + c * d))
        panels = max(20, int(t_end * 3) + 1)

        # In units of t_end, for mp.quad's tolerance is absolute.
        def integrand(s):
            t = t_end * s
            x = mp.sinh(t) + 2 * c * mp.sinh(t / 2) ** 2
            return mp.exp(-y * x) / (mp.cosh(t) + c * mp.sinh(t))

        points = [mp.mpf(i) / panels for i in range(panels + 1)]
        value = t_end * mp.quad(integrand, points, method="gauss-legendre")
        return value / x_end if mp.isfinite(x_end) else value


def closed_form(y, c):
    """H(y, theta, inf) by E1; c well below 1 and y neither tiny nor huge."""
    with mp.workdps(120):
        theta = mp.acos(+c)
        z = y * mp.expj(theta)
        return -mp.im(mp.exp(z) * mp.e1(z)) / mp.sin(theta)


def airlight_scaled(gamma, t_sv, t_vp):
    """J e^{T_sv} / (4 pi) at the given doubles."""
    with mp.workdps(GEOMETRY_DIGITS):
        g, s = mp.mpf(gamma), mp.mpf(t_sv)
        c = mp.sin(g / 2)
        y = 2 * s * c
        if math.isinf(t_vp):
            h = mean_h(y, c, mp.inf)
            if 1e-3 < gamma < 3.1 and 1e-3 < y < 50:
                assert abs(closed_form(y, c) / h - 1) < 1e-25, (gamma, t_sv)
            return 2 * h / y / (4 * mp.pi)
        v = mp.mpf(t_vp)
        d = mp.sqrt(v * v + s * s - 2 * v * s * mp.cos(g))
        path = v + d - s
        if gamma == 0:
            return v / (s * (s - v)) / (4 * mp.pi)
        x_end = path / y
        mean = mean_h(y, c, x_end)
        if 1e-3 < gamma < 3.1 and 1e-3 < y < 50 and x_end > 1e-3 and y * x_end < 50:
            with mp.workdps(120):
                far = mp.sqrt(x_end * x_end + 2 * c * x_end + 1)
                tail = mp.exp(-y * x_end) / far * closed_form(y * far, (x_end + c) / far)
                error = (closed_form(y, c) - tail) / (mean * x_end) - 1
                assert abs(error) < 1e-25, (gamma, t_sv, t_vp)
        return 2 * mean * path / (y * y) / (4 * mp.pi)


def f_difference(u, lo, hi):
    with mp.workdps(GEOMETRY_DIGITS):
        a, b = mp.mpf(lo), mp.mpf(hi)
        if lo == hi:
            return mp.mpf(0)
        uu = mp.mpf(u)
        y = uu / mp.cos(a)
        x_end = mp.sin(b - a) / mp.cos(b)
        return mp.exp(-uu * mp.tan(a)) * mp.cos(a) * mean_h(y, mp.sin(a), x_end) * x_end


def gammas(rng):
    return rng.choice([
        lambda: math.pi * rng.random(),
        lambda: 10 ** rng.uniform(-12, 0),
        lambda: 10 ** rng.uniform(-307, -12),
        lambda: math.pi - 10 ** rng.uniform(-15, 0),
        lambda: rng.choice([math.pi, math.nextafter(math.pi, 0), math.pi / 2, 1e-8, 3e-162, 0.0]),
    ])()


def thicknesses(rng):
    return rng.choice([
        lambda: 10 ** rng.uniform(-8, 2.3),
        lambda: 10 ** rng.uniform(-1.5, 1),
        lambda: 10 ** rng.uniform(-300, 300),
        lambda: rng.uniform(600, 760),
    ])()


def airlight_rows(rng, count):
    print("gamma,Tsv,Tvp,La_over_beta2_I0,La_scaled")
    done = 0
    while done < count:
        gamma, t_sv = gammas(rng), thicknesses(rng)
        t_vp = rng.choice([
            lambda: t_sv * rng.uniform(0, 3),
            lambda: t_sv * 10 ** rng.uniform(-16, 2),
            lambda: t_sv * 10 ** rng.uniform(-200, 0),
            lambda: t_sv * (1 + rng.choice([-1, 1]) * 10 ** rng.uniform(-16, -1)),
            lambda: t_sv * math.cos(gamma) * (1 + 10 ** rng.uniform(-16, -1)),
            lambda: rng.choice([t_sv, math.nextafter(t_sv, 0), math.nextafter(t_sv, math.inf)]),
            lambda: 10 ** rng.uniform(-300, 300),
            lambda: math.inf,
        ])()
        if not t_vp > 1e-305 or (gamma == 0 and t_vp >= t_sv):
            continue
        scaled = airlight_scaled(gamma, t_sv, t_vp)
        with mp.workdps(DIGITS):
            value = scaled * mp.exp(-mp.mpf(t_sv))
            if not mp.mpf("1e-300") < scaled < mp.mpf("1e300"):
                continue
            shown = mp.nstr(value, 18) if value > mp.mpf("1e-290") else "0"
            print(f"{gamma!r},{t_sv!r},{t_vp!r},{shown},{mp.nstr(scaled, 18)}")
        done += 1


def f_rows(rng, count):
    print("u,v_lo,v_hi,F_hi_minus_F_lo")
    done = 0
    while done < count:
        u = rng.choice([
            lambda: 10 ** rng.uniform(-3, 2),
            lambda: 10 ** rng.uniform(-300, 300),
            lambda: rng.uniform(0, 10),
        ])()
        lo = rng.choice([
            lambda: 0.0,
            lambda: rng.uniform(0, math.pi / 2),
            lambda: 10 ** rng.uniform(-300, 0),
            lambda: math.pi / 2 - 10 ** rng.uniform(-15, -1),
        ])()
        hi = rng.choice([
            lambda: rng.uniform(lo, math.pi / 2),
            lambda: min(math.pi / 2, lo + 10 ** rng.uniform(-16, 0)),
            lambda: lo + 1e-300 if lo == 0 else math.nextafter(lo, 2),
            lambda: math.pi / 2,
            lambda: math.nextafter(math.pi / 2, 0),
        ])()
        if not lo < hi <= math.pi / 2:
            continue
        # exp(-u tan v_lo) loses digits as its exponent grows, whoever computes it.
        if u * math.tan(lo) > 500:
            continue
        value = f_difference(u, lo, hi)
        if value > mp.mpf("1e-290"):
            print(f"{u!r},{lo!r},{hi!r},{mp.nstr(value, 18)}")
            done += 1


def psf_rows(rng, count):
    print("T,gamma,PSF_scaled")
    done = 0
    while done < count:
        gamma, t = gammas(rng), rng.choice([thicknesses(rng), 10 ** rng.uniform(-1, 1)])
        if gamma == 0:
            continue
        value = airlight_scaled(gamma, t, math.inf) * mp.mpf(t)
        if mp.mpf("1e-300") < value < mp.mpf("1e300"):
            print(f"{t!r},{gamma!r},{mp.nstr(value, 18)}")
            done += 1


def main():
    kind = sys.argv[1]
    shipped = {"airlight": (airlight_rows, 400), "F": (f_rows, 200), "psf": (psf_rows, 200)}
    rows, count = shipped[kind]
    count = int(sys.argv[2]) if len(sys.argv) > 2 else count
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    print(f"# Written by make_corners.py {kind} {count} {seed}: "
          "mpmath, 40 digits, at these doubles.")
    rows(random.Random(seed), count)


main()
