// SPDX-License-Identifier: Apache-2.0
#include "envmap/pixel_integral.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "envmap/chord.h"

namespace airlight {
namespace {

// Gauss-Legendre rules on [-1, 1] ([DLMF] 3.5(v)).
struct Rule {
    int nodes;
    int offset;  // among the nodes of all rules
    double node[8], weight[8];
};
constexpr Rule kRules[] = {
    {2, 0, {-0.57735026918962576451, 0.57735026918962576451}, {1, 1}},
    {3, 2, {-0.77459666924148337704, 0, 0.77459666924148337704}, {5.0 / 9, 8.0 / 9, 5.0 / 9}},
    {4,
     5,
     {-0.86113631159405257522, -0.33998104358485626480, 0.33998104358485626480,
      0.86113631159405257522},
     {0.34785484513745385737, 0.65214515486254614263, 0.65214515486254614263,
      0.34785484513745385737}},
    {6,
     9,
     {-0.93246951420315202781, -0.66120938646626451366, -0.23861918608319690863,
      0.23861918608319690863, 0.66120938646626451366, 0.93246951420315202781},
     {0.17132449237917034504, 0.36076157304813860757, 0.46791393457269104739,
      0.46791393457269104739, 0.36076157304813860757, 0.17132449237917034504}},
    {8,
     15,
     {-0.96028985649753623168, -0.79666647741362673959, -0.52553240991632898582,
      -0.18343464249564980494, 0.18343464249564980494, 0.52553240991632898582,
      0.79666647741362673959, 0.96028985649753623168},
     {0.10122853629037625915, 0.22238103445337447054, 0.31370664587788728734,
      0.36268378337836198297, 0.36268378337836198297, 0.31370664587788728734,
      0.22238103445337447054, 0.10122853629037625915}}};

// The integrand is about 1/(distance^2 + y^2) along an edge: a rule's error is rho^(-2n) with
// rho = 2/r + sqrt(1 + 4/r^2), r = length / distance. Each choice keeps that below 1e-9, since the
// edges of the slender pixels at a pole cancel to a hundredth.
const Rule& rule_for(double ratio_squared, double radians) {
    // The sphere's own curvature counts like a distance of three radians.
    ratio_squared = std::max(ratio_squared, radians * radians / 9);
    if (ratio_squared < 0.015 * 0.015) return kRules[0];
    if (ratio_squared < 0.1 * 0.1) return kRules[1];
    if (ratio_squared < 0.25 * 0.25) return kRules[2];
    if (ratio_squared < 0.55 * 0.55) return kRules[3];
    return kRules[4];
}

// An edge is not longer than this many radians, for the curvature of the sphere itself.
constexpr double kLongestPiece = 0.6;

// Integrates over [a, b], halving until an interval is shorter than its distance from the centre.
// `ratio(a, b)` returns the square of length over distance, `f` the integrand.
template <class Ratio, class F>
double integrate_edge(double a, double b, const Ratio& ratio, const F& f, int depth = 0) {
    const double ratio_squared = ratio(a, b);
    if ((ratio_squared > 1 || b - a > kLongestPiece) && depth < 60) {
        const double middle = 0.5 * (a + b);
        return integrate_edge(a, middle, ratio, f, depth + 1) +
               integrate_edge(middle, b, ratio, f, depth + 1);
    }
    const Rule& rule = rule_for(ratio_squared, b - a);
    const double centre = 0.5 * (a + b), half = 0.5 * (b - a);
    double sum = 0;
    for (int i = 0; i < rule.nodes; ++i) sum += rule.weight[i] * f(centre + half * rule.node[i]);
    return half * sum;
}

// The square of length over distance from a feature of that width at the antipode, for an edge
// whose nearest point to the centre is at squared chord t; 0 where there is none.
double antipode_ratio(double width, double length, double t) {
    if (!std::isfinite(width)) return 0;
    const double distance = std::max(0.0, std::sqrt(std::max(0.0, 4 - t)) - length);
    return length * length / (distance * distance + width * width);
}

double square(double x) {
    return x * x;
}

// C(t) / sin^2(gamma). C vanishes at the antipode as fast as the sine does.
double over_sine_squared(const RemainderTable& remainder, double t) {
    const double c = remainder(t);
    return c == 0 ? 0 : c / (t * std::max(1 - 0.25 * t, 1e-15));
}

}  // namespace

PixelIntegrator::PixelIntegrator(int rows, int columns)
    : rows_(rows), columns_(columns), reach_(rows, columns) {
    const double width = 2 * kPi / columns;
    for (int k = 0; k <= columns / 2; ++k) {
        edge_half_sine_.push_back(k == 0 ? 0 : square(std::sin(0.5 * (k - 0.5) * width)));
        for (const Rule& rule : kRules) {
            for (int i = 0; i < rule.nodes; ++i) {
                half_sine_.push_back(square(std::sin(0.5 * width * (k + 0.5 * rule.node[i]))));
            }
        }
    }
}

double PixelIntegrator::colatitude(int row) const {
    return kPi * (row + 0.5) / rows_;
}
double PixelIntegrator::edge(int row) const {
    return kPi * row / rows_;
}

PixelIntegrator::RowView PixelIntegrator::view_row(int row, int j) const {
    RowView view;
    view.theta_i = colatitude(row);
    view.sine_i = std::sin(view.theta_i);
    view.top = edge(j);
    view.bottom = edge(j + 1);
    const double centre = 0.5 * (view.top + view.bottom), half = 0.5 * (view.bottom - view.top);
    for (const Rule& rule : kRules) {
        for (int i = 0; i < rule.nodes; ++i) {
            const double theta = centre + half * rule.node[i];
            view.across[rule.offset + i] = squared_chord(theta - view.theta_i);
            view.sine[rule.offset + i] = std::sin(theta);
        }
    }
    const double nearest = std::clamp(view.theta_i, view.top, view.bottom);
    view.nearest_across = squared_chord(nearest - view.theta_i);
    view.smallest_sine = std::min(std::sin(view.top), std::sin(view.bottom));
    return view;
}

PixelIntegrator::ParallelView PixelIntegrator::view_parallel(int row, int j) const {
    const double theta_i = colatitude(row), theta = edge(j), sine_i = std::sin(theta_i);
    const bool pole = j == 0 || j == rows_;
    const double sine = pole ? 0 : std::sin(theta);
    return {theta,
            sine,
            squared_chord(theta - theta_i),
            4 * sine * sine_i,
            std::sin(theta - theta_i),
            2 * sine_i * std::cos(theta)};
}

// C dpsi along a parallel over column k, in the direction of growing phi.
double PixelIntegrator::parallel(const RemainderTable& remainder, const ParallelView& view,
                                 std::size_t k) const {
    if (view.sine == 0) return 0;
    const double width = 2 * kPi / columns_;
    const double peak = remainder.antipode_width();
    const double nearest_t = view.across + view.along * edge_half_sine_[k];
    const double ratio_squared = std::max(square(view.sine * width) / nearest_t,
                                          antipode_ratio(peak, view.sine * width, nearest_t));
    if (ratio_squared <= 1 && width <= kLongestPiece) {
        const Rule& rule = rule_for(ratio_squared, width);
        const double* h = half_sine_.data() + k * kRuleNodes + rule.offset;
        double sum = 0;
        for (int i = 0; i < rule.nodes; ++i) {
            sum += rule.weight[i] * (view.base + view.bend * h[i]) *
                   over_sine_squared(remainder, view.across + view.along * h[i]);
        }
        return 0.5 * width * view.sine * sum;
    }
    const auto ratio = [&](double a, double b) {
        const double nearest = a <= 0 && b >= 0 ? 0 : std::min(std::fabs(a), std::fabs(b));
        const double t = view.across + view.along * square(std::sin(0.5 * nearest));
        return std::max(square(view.sine * (b - a)) / t,
                        antipode_ratio(peak, view.sine * (b - a), t));
    };
    const auto integrand = [&](double phi) {
        const double h = square(std::sin(0.5 * phi));
        return (view.base + view.bend * h) *
               over_sine_squared(remainder, view.across + view.along * h);
    };
    return view.sine * integrate_edge((k - 0.5) * width, (k + 0.5) * width, ratio, integrand);
}

// C dpsi along the outer edge of column k, in the direction of growing theta.
double PixelIntegrator::meridian(const RemainderTable& remainder, const RowView& view,
                                 std::size_t k) const {
    const double phi = 2 * kPi * (k + 0.5) / columns_;
    const double h = 4 * view.sine_i * square(std::sin(0.5 * phi));
    const double turn = -view.sine_i * std::sin(phi);
    const double height = view.bottom - view.top;
    const double peak = remainder.antipode_width();
    const double nearest_t = view.nearest_across + h * view.smallest_sine;
    const double ratio_squared =
        std::max(square(height) / nearest_t, antipode_ratio(peak, height, nearest_t));
    if (ratio_squared <= 1 && height <= kLongestPiece) {
        const Rule& rule = rule_for(ratio_squared, height);
        double sum = 0;
        for (int i = 0; i < rule.nodes; ++i) {
            sum +=
                rule.weight[i] * over_sine_squared(remainder, view.across[rule.offset + i] +
                                                                  h * view.sine[rule.offset + i]);
        }
        return 0.5 * height * turn * sum;
    }
    const auto chord = [&](double theta) {
        return squared_chord(theta - view.theta_i) + h * std::sin(theta);
    };
    // The colatitude nearest the centre; over a pole where the centre lies beyond it.
    double foot = std::atan2(view.sine_i * std::cos(phi), std::cos(view.theta_i));
    if (foot < -0.5 * kPi) foot += 2 * kPi;
    const auto ratio = [&](double a, double b) {
        const double t = chord(std::clamp(foot, a, b));
        return std::max(square(b - a) / t, antipode_ratio(peak, b - a, t));
    };
    const auto integrand = [&](double theta) { return over_sine_squared(remainder, chord(theta)); };
    return turn * integrate_edge(view.top, view.bottom, ratio, integrand);
}

}  // namespace airlight
