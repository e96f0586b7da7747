// SPDX-License-Identifier: Apache-2.0
// Single scattering in a slab: a medium behind a plane, the light outside, the viewer outside.
#pragma once

namespace airlight {

/// The ray inside the slab is -w x for x in [0, s], measured from the point where it leaves the
/// plane towards the viewer. All functions here are the integrals of [Slab] with the prefactor
/// sigma_s p (times the radiant intensity I_0 or the radiance L of the light) left to the caller;
/// medium/slab_radiance.h puts surfaces and prefactors around them.
///
/// sigma_t    extinction coefficient [1/m], in [0, inf]
/// s          length of the ray in the medium [m], in [0, inf]
/// l          distance from the exit point to the light [m], in [0, inf]
/// w_dot_n    cosine between outward normal n and direction w of the ray to the viewer, in [0, 1]
/// wl_dot_n   the same for the direction w_l from the exit point to the light, in [0, 1]
/// w_dot_wl   cosine between w and w_l, in [-1, 1]
///
/// Where the surface refracts, w_dot_n is that of the direction inside, and for the distant light
/// wl_dot_n too (surface_crossing() in medium/refraction.h). The three cosines are not checked
/// against each other: the integrals exist for all.
///
/// NaN or an argument outside its domain gives NaN; a cosine that rounding put beyond 1 by up to
/// 1e-6 stands for 1. Float overloads compute in double and round once.

/// A distant light, [Slab] eq. 5: int_0^s e^{-sigma_t (1 + c) x} dx
///     = (1 - e^{-sigma_t (1 + c) s}) / (sigma_t (1 + c)),  c = w_dot_n / wl_dot_n   [m].
///
/// s for sigma_t = 0, whatever the cosines; else 0 for wl_dot_n = 0, the light along the surface.
/// Relative accuracy 4e-16. 22 ns.
double slab_distant(double sigma_t, double s, double w_dot_n, double wl_dot_n);
float slab_distant(float sigma_t, float s, float w_dot_n, float wl_dot_n);

/// A point light, [Slab] eq. 7 with the falloff of section 3.3 over I_0:
///
///     int_0^s e^{-sigma_t (x + k)} / h^2 dx   [1/m],
///     h^2 = x^2 + l^2 + 2 x l w_dot_wl,   k = x w_dot_n h / (l wl_dot_n + x w_dot_n).
///
/// h is the distance to the light and k the part of it inside the medium; light does not bend on
/// its way in. For wl_dot_n = 0 the light lies in the surface, k = h, and this is the airlight
/// integral: sigma_t 4 pi airlight(gamma, sigma_t l, sigma_t s) with cos gamma = -w_dot_wl. That
/// holds for w_dot_n = 0 too, where k has no limit.
///
/// Corners: 0 for s = 0, sigma_t = inf or l = inf; +inf for l = 0 and for a ray through the light
/// (w_dot_wl = -1, s >= l). sigma_t = 0 gives slab_falloff(). Results under and overflow as they
/// must.
/// Accuracy: relative 1e-14 plus 1e-16 times the exponent (measured against 34 digits on 589 rows,
/// cosines down to 1e-300, 1 - |w_dot_wl| down to 1e-16, l from 1e-8 to 1e8). Float: one rounding.
/// .4 us where one panel will do, 1.5 us on average over lengths of all scales.
///
/// Deviates: [Slab] has gamma = arccos(w . w_l) for the airlight, which is pi less the angle.
double slab_near(double sigma_t, double s, double l, double w_dot_n, double wl_dot_n,
                 double w_dot_wl);
float slab_near(float sigma_t, float s, float l, float w_dot_n, float wl_dot_n, float w_dot_wl);

/// The same for a light without falloff, [Slab] eq. 7 with L(x) = 1 and section 4:
/// int_0^s e^{-sigma_t (x + k)} dx [m]. It tends to slab_distant() for l -> inf and equals it where
/// all three cosines are 1. Corners: s for sigma_t = 0, +inf among them; slab_distant() for l =
/// inf; for l = 0, k = x.
double slab_near_flat(double sigma_t, double s, double l, double w_dot_n, double wl_dot_n,
                      double w_dot_wl);
float slab_near_flat(float sigma_t, float s, float l, float w_dot_n, float wl_dot_n,
                     float w_dot_wl);

/// int_0^s dx / h^2 [1/m], the angle under which the light sees the ray over its distance from it:
/// atan2(s q, l + s w_dot_wl) / (l q), q = sqrt(1 - w_dot_wl^2). Corners as slab_near().
///
/// Deviates: the paper's difference of two arctans cancels for short rays; this is one.
double slab_falloff(double s, double l, double w_dot_wl);
float slab_falloff(float s, float l, float w_dot_wl);

/// The paper's approximation of slab_near() for thin media, slab_distant() / s slab_falloff().
///
/// Error on seed001.csv against the exact integral: s = .5, sigma_t = .1, 1, 10: up to 4.3 %, 33 %,
/// 86 %, largest for the nearest light (l = .01), .1 %, .8 %, 3 % at l = 10. Unlike the abstract
/// says it is the close light for which it fails. 0 where wl_dot_n = 0. For s = inf: 0.
double slab_thin(double sigma_t, double s, double l, double w_dot_n, double wl_dot_n,
                 double w_dot_wl);
float slab_thin(float sigma_t, float s, float l, float w_dot_n, float wl_dot_n, float w_dot_wl);

}  // namespace airlight
