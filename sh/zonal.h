// SPDX-License-Identifier: Apache-2.0
// Zonal functions, those of the angle to one axis alone, and convolution with them.
//
// A zonal function f(gamma) has the coefficients g_l = 2 pi int_0^pi f Y_l0 sin(gamma) d gamma
// about its axis, the others vanish. Convolution with it multiplies every coefficient of degree l
// by its eigenvalue lambda_l = sqrt(4 pi / (2l+1)) g_l = 2 pi int f P_l(cos gamma) sin(gamma)
// d gamma (Funk and Hecke), in any frame. gamma is in radians, and order n means l = 0 ... n-1.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "sh/quadrature.h"

namespace airlight {

/// lambda_l = sqrt(4 pi / (2l+1)) g_l.
double zonal_eigenvalue(int l, double g);

/// g_l = sqrt((2l+1) / (4 pi)) lambda_l, the inverse of zonal_eigenvalue.
double zonal_coefficient(int l, double lambda);

/// All g_l of the eigenvalues lambda_l.
std::vector<double> zonal_coefficients(std::vector<double> lambda);

/// Eigenvalues lambda_l, l < order, of the zonal function with the given values at the rule's
/// angles: lambda_l = 2 pi sum_i weight_i values_i P_l(cosine_i). With an n-point Gauss-Legendre
/// rule it is exact for f of degree d in cos(gamma) as long as d + order <= 2n.
///
/// P_l comes from the difference form of its recurrence, which keeps its accuracy beside both
/// poles: the error is under 1e-15 sqrt(order) times 2 pi sum_i weight_i |values_i|.
/// Cost 1.4 ns per node and order, one thread; the sum runs in a fixed sequence.
std::vector<double> zonal_eigenvalues(const PolarRule& rule, const std::vector<double>& values,
                                      int order);

/// The same for a function, sampled on the Gauss-Legendre rule of `nodes` points.
std::vector<double> zonal_eigenvalues(const std::function<double(double)>& f, int order, int nodes);

/// The zonal function with the eigenvalues lambda at each angle of gamma, in [0, pi]:
/// f(gamma) = sum_l (2l+1) / (4 pi) lambda_l P_l(cos gamma), its accuracy as above with
/// sum_l (2l+1) / (4 pi) |lambda_l| in place of the integral.
std::vector<double> zonal_evaluate(const std::vector<double>& lambda,
                                   const std::vector<double>& gamma);
double zonal_evaluate(const std::vector<double>& lambda, double gamma);

/// Convolves in place: coefficients, of shape (channels, order^2) with slots as in sh/index.h and
/// order = lambda.size(), has its degree l multiplied by lambda_l. Float coefficients are
/// multiplied in double and rounded once.
void zonal_convolve(const std::vector<double>& lambda, std::size_t channels, double* coefficients);
void zonal_convolve(const std::vector<double>& lambda, std::size_t channels, float* coefficients);

}  // namespace airlight
