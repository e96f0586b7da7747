// SPDX-License-Identifier: Apache-2.0
// The effective BRDF of a surface whose light comes through fog.
//
// A source at the direction s and optical thickness T from the surface lights it directly, by
// e^-T, and by the airlight about s, whose radiance from the direction i is PSF_T(angle(s, i))
// times the source's intensity over its squared distance. Over that intensity the surface sends on
//     e^-T f(s, o) cos theta_s + E(s, o),
//     E(s, o) = int_{i above the horizon} PSF_T(angle(s, i)) f(i, o) cos theta_i d omega_i,
// the convolution of rho(i) = f(i, o) max(0, cos theta_i) with PSF_T: multiplied band by band,
//     E_lm(theta_o) = sqrt(4 pi / (2l+1)) PSF_l rho_lm(theta_o)          ([Sun05] eq. 24).
// E is there for sources below the horizon, too. A renderer multiplies by cos theta_s, so what is
// tabulated is
//     f_eff(s, o) = e^-T f(s, o) + albedo E(s, o) / cos theta_s.
// It grows like 1 / cos theta_s towards the horizon, where E does not vanish, and it is not
// reciprocal: the fog lies between surface and source alone. Over all sources of the sphere,
// int E(s, o) d omega_s = lambda_0 int f cos theta d omega, lambda_0 the energy of the PSF.
//
// Deviates: eq. 24 as printed convolves the BRDF without its cosine; sh/brdf_bands.h says why not.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "medium/phase_function.h"
#include "medium/psf.h"
#include "sh/brdf.h"

namespace airlight {

enum class BrdfComponent {
    total,      ///< e^-T f + albedo E / cos
    direct,     ///< e^-T f
    scattered,  ///< albedo E / cos
};

struct BrdfFogOptions {
    std::vector<double> optical_thickness;  ///< one value, or R, G, B, each in [0, inf)
    std::vector<double> albedo = {1.0};     ///< likewise, in [0, 1]
    PhaseFunction phase;
    PsfForm psf = PsfForm::exact;
    BrdfComponent component = BrdfComponent::total;
    int order = 128;        ///< bands of rho, 1 ... 512
    int outgoing = 91;      ///< outgoing angles with bands of their own, 4 ... 1024
    bool directed = false;  ///< tabulate over phi_d in [0, 2 pi) even if the input does not
};

struct BrdfFogReport {
    /// Norm of the upper half of the bands of E over that of all, the largest of all channels and
    /// outgoing angles: what is left out beyond `order` is less where bands fall.
    double tail = 0;
    /// Cells where E undershot 0 and became 0, and the deepest one over the largest E.
    std::size_t undershoots = 0;
    double deepest = 0;
    /// How far the result is from reciprocal: sum |f(s,o) - f(o,s)| w / sum (f(s,o) + f(o,s)) w
    /// over all cells, w = cos theta_s cos theta_o; all channels together. A table that is not
    /// directed holds the mean of both.
    double asymmetry = 0;
};

/// Bytes that foggy_brdf() takes at most, the result included.
std::size_t foggy_brdf_memory(const BrdfSize& size, const BrdfFogOptions& options);

/// The effective BRDF at the cells of `table`, on twice as many azimuths if `directed` asks for it.
///
/// Without scattered light (T = 0, albedo 0, direct) the values are those of the table times
/// e^-T, the same bits for T = 0. With it, cells that look below the horizon, and for the total
/// those without a value in `table`, carry none.
///
/// E is synthesised on 4 order rows for each of `outgoing` angles theta_o, and interpolated by
/// four-point Lagrange in direction and, between equal half vectors, in theta_o, in which even
/// narrow highlights move slowly. A table that is not directed keeps the mean of both directions,
/// which conserves int int f_eff cos theta_s cos theta_o, and loses what `asymmetry` says.
///
/// Largest error of E over its largest value against quadrature of the function tabulated, metals
/// at T = 1, the published size, theta_s and theta_o up to 80 degrees (bench/brdf_bench.cpp):
///     roughness 0.2    order 32  0.022;  64  0.0014;  128  0.0014;  256  0.0014
///     order 128        roughness 0.05  0.018;  0.1  0.0029;  0.5  0.0003
/// The floor is the table's own (linear, sh/brdf.h); a roughness r wants an order of about 10 / r.
/// For a Lambertian surface order 64 and 96 angles err by 1.2e-4 beside the horizon, where E bends:
/// bands are missing; 24 angles err by 7e-4.
///
/// Cost, one thread: 2, 3, 6.5, 19 s for order 32, 64, 128, 256. Same bits for any number of
/// threads.
/// `tick`, if there is one, is called `outgoing` times. Throws Error: usage for options outside
/// their ranges, data when values overflow.
BrdfTable foggy_brdf(const BrdfTable& table, const BrdfFogOptions& options,
                     BrdfFogReport* report = nullptr, const std::function<void()>& tick = {});

}  // namespace airlight
