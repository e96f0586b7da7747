// SPDX-License-Identifier: Apache-2.0
// Written by medium/make_ray_integral_fit.py: coefficients of
//     H(y, theta, inf) = r (A - s ln(s) B) / C,   r = 1 / (y + 2),  s = y r,
// A (smooth), B (logarithmic), C (denominator) polynomials in u = 2 s - 1 (columns) and
// v = 2 cos(theta) - 1 (rows); row j holds no power of u from its length on.
#pragma once

namespace airlight {
namespace detail {

struct FitSmooth {
    static constexpr int kRows = 4;
    static constexpr int kLengths[kRows] = {7, 7, 5, 3};
    static constexpr float kPowers[kRows][7] = {
        {4.254846573e+00f, -1.723507285e+00f, -1.424718738e+00f, -1.163030148e+00f,
         2.682811916e-01f, 1.808198243e-01f, 5.341314245e-03f},
        {3.478505850e+00f, -8.496311307e-01f, -4.147414684e+00f, -3.306295574e-01f,
         1.369901299e+00f, 4.836784303e-01f, 1.733692177e-02f},
        {1.184629917e+00f, 8.241346478e-01f, -1.116392255e+00f, -8.401266932e-01f,
         -5.713228136e-02f, 0.000000000e+00f, 0.000000000e+00f},
        {-5.152883939e-03f, -2.436225986e-05f, 4.841427319e-03f, 0.000000000e+00f, 0.000000000e+00f,
         0.000000000e+00f, 0.000000000e+00f},
    };
};

struct FitLogarithmic {
    static constexpr int kRows = 4;
    static constexpr int kLengths[kRows] = {5, 5, 3, 2};
    static constexpr float kPowers[kRows][5] = {
        {-1.004624367e+01f, -1.906556249e+00f, -7.509722710e-01f, 8.936389089e-01f,
         1.718773842e-01f},
        {-9.339382172e+00f, -2.643525362e+00f, 4.768023491e+00f, 2.946154356e+00f,
         4.377974570e-01f},
        {-3.394693375e+00f, -3.926269531e+00f, -9.760606885e-01f, 0.000000000e+00f,
         0.000000000e+00f},
        {1.402303111e-02f, 8.296709508e-03f, 0.000000000e+00f, 0.000000000e+00f, 0.000000000e+00f},
    };
};

struct FitDenominator {
    static constexpr int kRows = 4;
    static constexpr int kLengths[kRows] = {5, 5, 3, 2};
    static constexpr float kPowers[kRows][5] = {
        {5.972636342e-01f, -4.687195122e-01f, 6.383771896e-01f, -5.333610177e-01f,
         1.644720733e-01f},
        {2.918304205e-01f, -3.500246704e-01f, 2.380782515e-01f, -1.934635788e-01f,
         3.532673046e-02f},
        {3.273588419e-02f, -5.963353068e-02f, 2.201133408e-02f, 0.000000000e+00f, 0.000000000e+00f},
        {-1.696136314e-05f, -3.183736990e-04f, 0.000000000e+00f, 0.000000000e+00f,
         0.000000000e+00f},
    };
};

}  // namespace detail
}  // namespace airlight
