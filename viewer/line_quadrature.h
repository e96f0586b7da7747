// SPDX-License-Identifier: Apache-2.0
// Adaptive quadrature of colours along a line.
#pragma once

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <glm/vec3.hpp>
#include <vector>

namespace airlight {

struct LineIntegral {
    glm::dvec3 value{0};
    double error = 0;  ///< estimate, of the channel where it is largest
    int evaluations = 0;
};

struct LineQuadratureOptions {
    double relative = 1e-3;  ///< of the largest channel
    double absolute = 0;
    int most_panels = 200;  ///< it ends there, and `error` says how far it came
};

inline constexpr std::size_t kPanelPoints = 15;

struct LinePanel {
    double begin = 0, end = 0;
};

/// int f over panels; f(count, x, values) sets values[i] = f(x[i]), kPanelPoints at a time.
/// Gauss-Kronrod rules of 7 and 15 nodes; the panel with the largest error is halved until the sum
/// of all is within the larger of the two tolerances. f is not evaluated at the ends of panels, so
/// it may jump there.
template <class F>
LineIntegral integrate_panels(const F& f, const std::vector<LinePanel>& parts,
                              const LineQuadratureOptions& options = {}) {
    struct Panel {
        double a, b, error;
        glm::dvec3 value;
        bool operator<(const Panel& other) const { return error < other.error; }
    };
    const auto largest = [](const glm::dvec3& v) {
        return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    };
    LineIntegral result;
    const auto panel_of = [&](double a, double b) {
        using Kronrod = boost::math::quadrature::gauss_kronrod<double, 15>;
        using Gauss = boost::math::quadrature::gauss<double, 7>;
        const auto& nodes = Kronrod::abscissa();
        const auto& weights = Kronrod::weights();
        const auto& coarse_weights = Gauss::weights();
        const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
        double places[kPanelPoints] = {middle};
        for (std::size_t i = 1; i < nodes.size(); ++i) {
            places[2 * i - 1] = middle - half * nodes[i];
            places[2 * i] = middle + half * nodes[i];
        }
        glm::dvec3 values[kPanelPoints];
        f(kPanelPoints, places, values);
        glm::dvec3 fine = weights[0] * values[0], coarse = coarse_weights[0] * values[0];
        for (std::size_t i = 1; i < nodes.size(); ++i) {
            const glm::dvec3 pair = values[2 * i - 1] + values[2 * i];
            fine += weights[i] * pair;
            if (i % 2 == 0) coarse += coarse_weights[i / 2] * pair;
        }
        result.evaluations += kPanelPoints;
        // The difference is the error of the coarse rule. That of the fine one follows from how
        // small it is beside the spread of f, as QUADPACK has it, whose estimate comes out up to
        // ten times too small along rays that go far from a lamp.
        double spread = 0;
        for (std::size_t i = 0; i < kPanelPoints; ++i) {
            spread += weights[(i + 1) / 2] * largest(values[i] - 0.5 * fine);
        }
        const double difference = largest(fine - coarse);
        const double ratio = spread > 0 ? 200 * difference / spread : 0;
        const double error = ratio < 1 ? 10 * spread * ratio * std::sqrt(ratio) : difference;
        return Panel{a, b, half * std::min(error, difference), half * fine};
    };
    std::vector<Panel> panels;
    panels.reserve(parts.size() + 4);
    for (const LinePanel& part : parts) {
        if (part.begin < part.end) panels.push_back(panel_of(part.begin, part.end));
    }
    const auto sum = [&] {
        result.value = glm::dvec3(0);
        result.error = 0;
        for (const Panel& panel : panels) {
            result.value += panel.value;
            result.error += panel.error;
        }
        return result.error > std::max(options.absolute, options.relative * largest(result.value));
    };
    std::make_heap(panels.begin(), panels.end());
    while (sum() && panels.size() < static_cast<std::size_t>(options.most_panels)) {
        std::pop_heap(panels.begin(), panels.end());
        const Panel worst = panels.back();
        const double middle = 0.5 * (worst.a + worst.b);
        if (!(worst.a < middle && middle < worst.b)) {
            std::push_heap(panels.begin(), panels.end());
            break;
        }
        panels.back() = panel_of(worst.a, middle);
        std::push_heap(panels.begin(), panels.end());
        panels.push_back(panel_of(middle, worst.b));
        std::push_heap(panels.begin(), panels.end());
    }
    return result;
}

/// The same over the panels between ascending `breaks`, f: double -> glm::dvec3.
template <class F>
LineIntegral integrate_line(const F& f, const std::vector<double>& breaks,
                            const LineQuadratureOptions& options = {}) {
    std::vector<LinePanel> panels;
    for (std::size_t i = 1; i < breaks.size(); ++i) panels.push_back({breaks[i - 1], breaks[i]});
    const auto each = [&](std::size_t count, const double* x, glm::dvec3* values) {
        for (std::size_t i = 0; i < count; ++i) values[i] = f(x[i]);
    };
    return integrate_panels(each, panels, options);
}

}  // namespace airlight
