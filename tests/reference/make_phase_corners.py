#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden values of phase functions and of airlight with them, in their corners, by mpmath.

Usage: python3 make_phase_corners.py KIND [COUNT] [SEED] > FILE
KIND is phase_hg, phase_rayleigh, airlight_hg, airlight_rayleigh, psf_hg or psf_rayleigh, of which
phase_hg and the airlight ones also come with _corners: without that, arguments keep to sizes whose
results a float holds.

The geometry and the phase functions are written naively, at 2200 digits, with cosines. The airlight
integral runs over u = tan(alpha/2), alpha the scattering angle, on panels that grow with u, at 40
digits. Rows of moderate size are checked against mp.quad along the ray, in t itself, to 1e-18; the
script fails where they differ.
"""
import math
import random
import sys

import mpmath as mp

GEOMETRY_DIGITS = 2200
DIGITS = 40


def rule(n):
    with mp.workdps(DIGITS + 10):
        nodes = []
        for i in range(n):
            x = mp.cos(mp.pi * (i + mp.mpf("0.75")) / (n + mp.mpf("0.5")))
            for _ in range(8):
                p, q = mp.mpf(1), x
                for k in range(1, n):
                    p, q = q, ((2 * k + 1) * x * q - k * p) / (k + 1)
                slope = n * (x * q - p) / (x * x - 1)
                x -= q / slope
            nodes.append((x, 2 / ((1 - x * x) * slope * slope)))
        return nodes


RULE = rule(26)


def hg(cosine, g):
    return (1 - g * g) / (4 * mp.pi * (1 + g * g - 2 * g * cosine) ** mp.mpf(1.5))


def rayleigh(cosine):
    return 3 / (16 * mp.pi) * (1 + cosine * cosine)


def weight(u, g):
    """p(alpha) 2 / (1 + u^2) at u = tan(alpha/2); the cosine cancels, so with digits to spare."""
    with mp.workdps(DIGITS + 60):
        cosine = (1 - u * u) / (1 + u * u)
        return (rayleigh(cosine) if g is None else hg(cosine, g)) * 2 / (1 + u * u)


def airlight_scaled(gamma, t_sv, t_vp, g):
    """e^{t_sv} int p e^{-t-d} / d^2 dt at the given doubles; g None is Rayleigh."""
    with mp.workdps(GEOMETRY_DIGITS):
        a, s = mp.mpf(gamma), mp.mpf(t_sv)
        asymmetry = None if g is None else mp.mpf(g)
        if gamma == 0:
            v = mp.mpf(t_vp)
            return v / (s * (s - v)) * (rayleigh(1) if g is None else hg(1, asymmetry))
        height = s * mp.sin(a)
        u_begin = mp.tan(a / 2)
        if math.isinf(t_vp):
            u_end = mp.inf
        else:
            along = mp.mpf(t_vp) - s * mp.cos(a)
            u_end = height / (mp.sqrt(along * along + height * height) - along)
        scale = mp.mpf(1)
        if g is not None:
            ratio = (1 - asymmetry) / (1 + asymmetry)
            scale = min(mp.mpf(1), ratio)
            far = max(mp.mpf(1), ratio)
        else:
            far = mp.mpf(1)
    with mp.workdps(DIGITS + 20):
        h = +height
        path = lambda length: mp.exp(-h * length)
        u0, total = +u_begin, mp.mpf(0)
        whole = u_end - u_begin
        done = mp.mpf(0)  # u - u_begin, so that short segments keep their digits
        while done < whole:
            u = u0 + done
            step = min(max(u, scale) / 3, 8 / h)
            if done + step > whole:
                step = +(whole - done)
            part = mp.mpf(0)
            for x, w in RULE:
                beyond = done + step * (1 + x) / 2
                part += w * weight(u0 + beyond, asymmetry) * path(beyond)
            total += part * step / 2
            done += step
            if h * done > 115 or u0 + done > mp.mpf("1e45") * far:
                break
        value = total / h
    if 1e-2 < gamma < 3.1 and 1e-2 < t_sv < 30 and t_vp > 1e-2 and (g is None or abs(g) < 0.99):
        check(gamma, t_sv, t_vp, g, value)
    return value


def check(gamma, t_sv, t_vp, g, value):
    with mp.workdps(30):
        a, s = mp.mpf(gamma), mp.mpf(t_sv)
        end = min(mp.mpf(t_vp), s + 60)

        def integrand(t):
            d2 = t * t + s * s - 2 * t * s * mp.cos(a)
            d = mp.sqrt(d2)
            # Light goes from the source to the point, then to the viewer.
            cosine = -(t - s * mp.cos(a)) / d
            p = rayleigh(cosine) if g is None else hg(cosine, mp.mpf(g))
            return p * mp.exp(s - t - d) / d2

        closest, height = s * mp.cos(a), s * mp.sin(a)
        points = {mp.mpf(0), end}
        for k in range(-40, 41):
            points.add(closest + height * mp.sinh(mp.mpf(k) / 4))
        points = sorted(p for p in points if 0 <= p <= end)
        error = mp.quad(integrand, points) / value - 1
        assert abs(error) < 1e-18, (gamma, t_sv, t_vp, g, error)


def gammas(rng, corners):
    return rng.choice([
        lambda: math.pi * rng.random(),
        lambda: math.pi * rng.random(),
        lambda: 10 ** rng.uniform(-12, 0) if corners else 10 ** rng.uniform(-4, 0),
        lambda: 10 ** rng.uniform(-300, -12) if corners else 10 ** rng.uniform(-8, -4),
        lambda: math.pi - 10 ** rng.uniform(-15 if corners else -6, 0),
        lambda: rng.choice([math.pi, math.nextafter(math.pi, 0), math.pi / 2, 1e-8,
                            3e-162 if corners else 0.01, 0.0]),
    ])()


def thicknesses(rng, corners):
    return rng.choice([
        lambda: 10 ** rng.uniform(-8 if corners else -5, 2.3 if corners else 1.5),
        lambda: 10 ** rng.uniform(-1.5, 1),
        lambda: 10 ** (rng.uniform(-250, 250) if corners else rng.uniform(-6, -1)),
        lambda: rng.uniform(600, 760) if corners else rng.uniform(20, 60),
    ])()


def asymmetries(rng, corners):
    return rng.choice([
        lambda: rng.uniform(-1, 1),
        lambda: rng.uniform(0.6, 1),
        lambda: rng.choice([-1, 1]) * (1 - 10 ** rng.uniform(-15 if corners else -4, -1)),
        lambda: rng.choice([-1, 1]) * 10 ** rng.uniform(-20, -1),
        lambda: rng.choice([0.75, 0.85, 0.999, -0.999, math.nextafter(1, 0) if corners else 0.0,
                            math.nextafter(-1, 0) if corners else 0.5,
                            5e-324 if corners else -0.25]),
    ])()


def airlight_rows(rng, count, with_g, corners):
    scaled_too = ",La_scaled" if corners else ""
    print("gamma,Tsv,Tvp," + ("g," if with_g else "") + "La_over_beta2_I0" + scaled_too)
    done = 0
    while done < count:
        gamma, t_sv = gammas(rng, corners), thicknesses(rng, corners)
        t_vp = rng.choice([
            lambda: math.inf,
            lambda: t_sv * 3 * rng.random(),
            lambda: t_sv * 10 ** rng.uniform(-16 if corners else -4, 4),
            lambda: t_sv * (1 + rng.choice([-1, 1]) * 10 ** rng.uniform(-15, 0)),
            lambda: thicknesses(rng, corners),
        ])()
        g = asymmetries(rng, corners) if with_g else None
        if t_vp == 0 or (gamma == 0 and t_vp >= t_sv):
            continue
        scaled = airlight_scaled(gamma, t_sv, t_vp, g)
        if not mp.mpf("1e-290") < scaled < mp.mpf("1e300"):
            continue
        with mp.workdps(DIGITS):
            value = scaled * mp.exp(-mp.mpf(t_sv))
            if not corners and not mp.mpf("1e-35") < value < mp.mpf("1e35"):
                continue
            value = mp.nstr(value, 18) if value > mp.mpf("1e-330") else "0"
        columns = [repr(gamma), repr(t_sv), repr(t_vp)] + ([repr(g)] if with_g else []) + [value]
        print(",".join(columns + ([mp.nstr(scaled, 18)] if corners else [])), flush=True)
        done += 1


def psf_rows(rng, count, with_g):
    print("T,gamma," + ("g," if with_g else "") + "PSF")
    done = 0
    while done < count:
        gamma, t = gammas(rng, False), thicknesses(rng, False)
        g = asymmetries(rng, False) if with_g else None
        if gamma == 0:
            continue
        with mp.workdps(DIGITS):
            value = airlight_scaled(gamma, t, math.inf, g) * mp.mpf(t) ** 2 * mp.exp(-mp.mpf(t))
        if not mp.mpf("1e-35") < value < mp.mpf("1e35"):
            continue
        columns = [repr(t), repr(gamma)] + ([repr(g)] if with_g else [])
        print(",".join(columns + [mp.nstr(value, 18)]), flush=True)
        done += 1


def phase_rows(rng, count, with_g, corners):
    print("cos_theta," + ("g," if with_g else "") + "p")
    for _ in range(count):
        cosine = rng.choice([
            lambda: rng.uniform(-1, 1),
            lambda: rng.choice([-1, 1]) * (1 - 10 ** rng.uniform(-16, 0)),
            lambda: rng.choice([-1.0, 1.0, 0.0, math.nextafter(1, 0), 5e-324]),
        ])()
        with mp.workdps(120):
            if with_g:
                g = asymmetries(rng, corners)
                print(f"{cosine!r},{g!r},{mp.nstr(hg(mp.mpf(cosine), mp.mpf(g)), 18)}")
            else:
                print(f"{cosine!r},{mp.nstr(rayleigh(mp.mpf(cosine)), 18)}")


def main():
    kind = sys.argv[1]
    shipped = {"airlight_hg_corners": 500, "airlight_rayleigh_corners": 150}
    count = int(sys.argv[2]) if len(sys.argv) > 2 else shipped.get(kind, 200)
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    rng = random.Random(seed)
    print(f"# Written by make_phase_corners.py {kind} {count} {seed}: "
          "mpmath, 40 digits, at these doubles.")
    with_g, corners = "_hg" in kind, kind.endswith("_corners")
    if kind.startswith("phase"):
        phase_rows(rng, count, with_g, corners)
    elif kind.startswith("psf"):
        psf_rows(rng, count, with_g)
    else:
        airlight_rows(rng, count, with_g, corners)


main()
