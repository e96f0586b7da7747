// SPDX-License-Identifier: Apache-2.0
#include "medium/point_glow.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/exp_sinh.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "medium/airlight.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(PointGlow, WhatTheMediumAbsorbsIsTheLightsPower) {
    boost::math::quadrature::exp_sinh<double> rule;
    for (const double albedo : {0.3, 0.5, 0.8, 0.9, 0.99, 0.999}) {
        const PointGlow glow(albedo);
        const double absorbed = (1 - albedo) * rule.integrate([&](double t) {
            return t > 0 && t < 1e4 ? 4 * kPi * t * t * glow.collided_fluence(t) : 0;
        });
        EXPECT_NEAR(absorbed, albedo, 1e-9) << albedo;
    }
}

TEST(PointGlow, LightScatteredOnceIsTheFirstOrderInTheAlbedo) {
    // The overlap of two e^{-d} / (4 pi d^2) about points at a distance T, in spheroidal
    // coordinates: int_1^inf e^{-u T} ln((u + 1) / (u - 1)) / u du / (4 pi T).
    boost::math::quadrature::exp_sinh<double> rule;
    for (const double t : {0.1, 1.0, 5.0}) {
        const double overlap = rule.integrate([&](double p) {
            if (!(p > 0 && p * t < 700)) return 0.0;
            return std::exp(-(1 + p) * t) * std::log1p(2 / p) / (1 + p);
        });
        const double a = PointGlow(0.01).collided_fluence(t) / 0.01;
        const double b = PointGlow(0.02).collided_fluence(t) / 0.02;
        const double expected = overlap / (4 * kPi * t);
        // The third order is left.
        EXPECT_NEAR(2 * a - b, expected, 1e-3 * expected) << t;
    }
}

TEST(PointGlow, TheRayGathersWhatComesOfItsParts) {
    // Independent panels along the ray, by the fluence.
    boost::math::quadrature::tanh_sinh<double> rule;
    const PointGlow glow(0.9);
    for (const double gamma : {0.02, 0.6, 2.5}) {
        for (const double t_sv : {0.25, 5.0}) {
            for (const double t_vp : {0.5, 10.0, kInfinite}) {
                const double foot = t_sv * std::cos(gamma), height = t_sv * std::sin(gamma);
                const auto along = [&](double t) {
                    return std::exp(-t) * glow.collided_fluence(std::hypot(t - foot, height));
                };
                const double end = std::min(t_vp, 60.0);
                double sum = 0;
                if (foot > 0 && foot < end) {
                    sum = rule.integrate(along, 0.0, foot) + rule.integrate(along, foot, end);
                } else {
                    sum = rule.integrate(along, 0.0, end);
                }
                const double expected = 0.9 * (airlight(gamma, t_sv, t_vp) + sum);
                EXPECT_NEAR(glow.radiance(gamma, t_sv, t_vp), expected, 1e-8 * expected);
            }
        }
    }
}

TEST(PointGlow, FarFromTheLightItIsDiffusion) {
    const PointGlow glow(1);
    for (const double t : {40.0, 100.0}) {
        EXPECT_NEAR(4 * kPi * t * glow.collided_fluence(t), 3, 1e-12);
    }
}

}  // namespace
}  // namespace airlight
