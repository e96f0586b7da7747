// SPDX-License-Identifier: Apache-2.0
#include "sh/brdf_bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "sh/aligned.h"
#include "sh/index.h"
#include "sh/lane_fft.h"
#include "sh/legendre_stage.h"
#include "sh/quadrature.h"
#include "sh/row_spectra.h"

namespace airlight {
namespace {

// Gauss's rule over cosines in (0, 1), nearest the equator first.
struct HemisphereRule {
    std::vector<double> colatitude, cosine, sine, weight;

    explicit HemisphereRule(int rows) {
        const PolarRule rule = gauss_legendre(rows);
        for (std::size_t i = rule.angle.size(); i-- > 0;) {
            // (1 + cos t) / 2 = cos^2(t / 2), whose distance from 1 is sin^2(t / 2).
            const double s = std::sin(rule.angle[i] / 2), c = std::cos(rule.angle[i] / 2);
            cosine.push_back(c * c);
            sine.push_back(s * std::sqrt(1 + c * c));
            colatitude.push_back(std::atan2(sine.back(), cosine.back()));
            weight.push_back(rule.weight[i] / 2);
        }
    }
};

}  // namespace

struct BrdfBands::Impl {
    explicit Impl(int n)
        : order(n),
          rule(2 * n),
          columns(std::max<std::size_t>(4 * static_cast<std::size_t>(n), 8)),
          fft(columns),
          stage(rule.colatitude, n - 1) {}

    int order;
    HemisphereRule rule;
    std::size_t columns;
    LaneFft<double> fft;
    LegendreStage<double> stage;
};

BrdfBands::BrdfBands(int order) {
    if (order < 1 || order > kLargestBrdfOrder) {
        throw Error(ErrorCode::usage,
                    fmt::format("the order must be in [1, {}], got {}", kLargestBrdfOrder, order));
    }
    impl_ = std::make_unique<Impl>(order);
}

BrdfBands::~BrdfBands() = default;

void BrdfBands::coefficients(const BrdfTable& table, double theta_out, double* out) const {
    const HemisphereRule& rule = impl_->rule;
    const std::size_t rows = rule.weight.size(), columns = impl_->columns;
    const glm::dvec3 viewer(std::sin(theta_out), 0, std::cos(theta_out));
    std::vector<glm::dvec3> samples(rows * columns);
    parallel_blocks(rows, 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const double weight =
                rule.weight[i] * rule.cosine[i] * 2 * kPi / static_cast<double>(columns);
            for (std::size_t k = 0; k < columns; ++k) {
                const double phi = 2 * kPi * static_cast<double>(k) / static_cast<double>(columns);
                const glm::dvec3 in(rule.sine[i] * std::cos(phi), rule.sine[i] * std::sin(phi),
                                    rule.cosine[i]);
                samples[i * columns + k] = weight * evaluate_brdf(table, in, viewer);
            }
        }
    });
    const auto order = static_cast<std::size_t>(impl_->order);
    RowSpectra<double> spectra(rows, order, 3);
    spectra.forward(impl_->fft, 3, [&](std::size_t row, std::size_t channel) {
        return &samples[row * columns][static_cast<int>(channel)];
    });
    const LegendreStage<double>& stage = impl_->stage;
    const std::size_t padded = stage.padded_rows(), count = sh_count(impl_->order);
    parallel_blocks(order, 4, [&](std::size_t begin, std::size_t end) {
        LegendreStage<double>::Workspace work;
        AlignedVector<double> values(6 * spectra.padded_rows()), folded(6 * padded), bands;
        for (std::size_t m = begin; m < end; ++m) {
            stage.prepare(static_cast<int>(m), work);
            // The lower hemisphere is 0, so both folds are the upper one.
            spectra.read(m, 1, values.data());
            for (std::size_t c = 0; c < 6; ++c) {
                std::copy_n(values.data() + c * spectra.padded_rows(), rows,
                            folded.data() + c * padded);
                std::fill_n(folded.data() + c * padded + rows, padded - rows, 0.0);
            }
            bands.resize(6 * stage.padded_bands(static_cast<int>(m)));
            stage.analyze(6, folded.data(), folded.data(), bands.data(), work);
            for (std::size_t l = m; l < order; ++l) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const double* band = bands.data() + 6 * (l - m) + 2 * c;
                    double* channel = out + c * count;
                    const int degree = static_cast<int>(l), azimuthal = static_cast<int>(m);
                    channel[sh_index(degree, azimuthal)] = band[0];
                    if (m > 0) channel[sh_index(degree, -azimuthal)] = -band[1];
                }
            }
        }
    });
}

}  // namespace airlight
