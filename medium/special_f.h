// SPDX-License-Identifier: Apache-2.0
// Sun's special function, the integral that an airlight table holds.
#pragma once

namespace airlight {

/// F(u, v) = int_0^v exp(-u tan x) dx, [Sun05] eq. 10.
///
/// Domain: u in [0, inf], v in [0, pi/2]; a v that rounding put above pi/2, up to the float next
/// above it, 1.57079637, stands for pi/2. Anything else, NaN included, gives NaN. F(0, v) = v;
/// F(inf, v) = 0; F(u, v) -> v (1 - u v / 2) for small v, down to denormals. Accuracy: relative
/// 1e-13 in double, one rounding more in float.
double special_f(double u, double v);
float special_f(float u, float v);

/// F(u, v_hi) - F(u, v_lo) = int_{v_lo}^{v_hi} exp(-u tan x) dx without their cancellation;
/// negative when v_hi < v_lo. Same domain and accuracy, but for the condition of the problem
/// itself: a rounding of v_lo changes the result by u / cos^2(v_lo) as much.
double special_f_difference(double u, double v_lo, double v_hi);
float special_f_difference(float u, float v_lo, float v_hi);

}  // namespace airlight
