// SPDX-License-Identifier: Apache-2.0
#include "prt/adaptive_hemisphere.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/constants.h"
#include "sh/index.h"
#include "sh/lobes.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

constexpr double kLowest = 3e-5;
constexpr int kLevels = 5;
constexpr double kWidth = 0.125;
// Of the estimate (prt/adaptive_hemisphere.h), fitted to meshes and thickets.
constexpr double kBend = 0.35, kHidden = 0.3, kBias = 2, kPrior = 0.02, kCounted = 0.5;
constexpr double kMargin = 1.15;
// Error at 16 cells along a side.
constexpr double kAtSixteen = 1.8e-3;

// Cells of level 0 along a side; level 1 is the first lattice.
int coarse_cells(const AdaptiveOptions& options) {
    const double along = std::min(1e3, 16 * std::sqrt(kAtSixteen / options.tolerance));
    const int fitting = static_cast<int>(std::sqrt(0.5 * options.most_rays) - 1) / 2;
    const int wanted = std::clamp(static_cast<int>(std::lround(along / 2)), 7, 24);
    return std::max(1, std::min(wanted, fitting));
}

// Sums of areas as they weigh in visibility (0) and in transfer (1).
class Sum {
  public:
    explicit Sum(const std::vector<BorderGrid::Area>& areas) {
        for (const BorderGrid::Area& each : areas) {
            const glm::dvec3 d = adaptive_direction(double(each.u), double(each.v));
            const double angle = double(each.area) * adaptive_density(d.z);
            const double weights[] = {angle, angle * d.z / kPi};
            for (int k = 0; k < 2; ++k) {
                mean_[k] += weights[k];
                first_[k] += weights[k] * d;
                square_[k] += weights[k] * weights[k];
            }
        }
    }

    /// The squared norm of the degrees 0 and 1 of the sum of w Y.
    double low(int k) const {
        return (mean_[k] * mean_[k] + 3 * glm::dot(first_[k], first_[k])) / (4 * kPi);
    }
    /// The mean square of one of its coefficients if every w had a random sign.
    double random(int k) const { return square_[k] / (4 * kPi); }

  private:
    double mean_[2] = {}, square_[2] = {};
    glm::dvec3 first_[2] = {glm::dvec3(0.0), glm::dvec3(0.0)};
};

}  // namespace

glm::dvec3 adaptive_direction(double u, double v) {
    const double a = 2 * u - 1, b = 2 * v - 1;
    const bool along_a = std::abs(a) > std::abs(b);
    const double r = along_a ? a : b, other = along_a ? b : a;
    // At most pi/4: the terms that are left out are below 2e-9.
    const double q = r != 0 ? kPi / 4 * (other / r) : 0, q2 = q * q;
    const double cosine =
        1 - q2 / 2 * (1 - q2 / 12 * (1 - q2 / 30 * (1 - q2 / 56 * (1 - q2 / 90))));
    const double sine = q * (1 - q2 / 6 * (1 - q2 / 20 * (1 - q2 / 42 * (1 - q2 / 72))));
    const double t = (1 - r) * (1 + r), z = std::max(kLowest, 0.5 * t * (1 + t));
    const double s = std::sqrt((1 - z) * (1 + z)) * (r < 0 ? -1 : 1);
    return along_a ? glm::dvec3(s * cosine, s * sine, z) : glm::dvec3(s * sine, s * cosine, z);
}

double adaptive_density(double z) {
    return kPi * std::sqrt(1 + 8 * z);
}

void BlockedPoints::clear() {
    for (auto* values : {&x, &y, &z, &weight}) values->clear();
}

void BlockedPoints::add(double u, double v, double area) {
    const glm::dvec3 d = adaptive_direction(u, v);
    x.push_back(static_cast<float>(d.x));
    y.push_back(static_cast<float>(d.y));
    z.push_back(static_cast<float>(d.z));
    weight.push_back(static_cast<float>(area * adaptive_density(d.z)));
}

AdaptiveHemisphere::AdaptiveHemisphere(const AdaptiveOptions& options)
    : options_(options), grid_(coarse_cells(options), kLevels) {
    const auto norm = [&](double exponent) {
        double square = 0;
        for (const double c : zonal_coefficients(phong_eigenvalues(exponent, options.order))) {
            square += c * c;
        }
        return std::sqrt(square);
    };
    norm_[0] = norm(0);
    norm_[1] = norm(1) / kPi;
}

double AdaptiveHemisphere::worst(const AdaptiveEstimate& estimate) const {
    return std::max(options_.visibility ? estimate.visibility : 0,
                    options_.transfer ? estimate.transfer : 0);
}

// Also the square of the largest hidden part among those that have to meet the tolerance.
AdaptiveEstimate AdaptiveHemisphere::estimate_borders(int finished, double* hidden) {
    grid_.collect(finished, borders_);
    const Sum places(borders_.doubts), bends(borders_.bends), hides(borders_.hidden);
    const auto functions = static_cast<double>(sh_count(options_.order));
    const double along = grid_.cells_along(finished);
    // Near the horizon, where the cosine is small.
    const double prior = kPrior * adaptive_density(0) / (along * along), cosine = 0.3 / kPi;
    double all[2];
    *hidden = 0;
    for (int k = 0; k < 2; ++k) {
        // With random signs the four functions of degrees 0 and 1 have 4 of these; four times as
        // much is no surprise.
        const double bias = std::max(0.0, hides.low(k) - 16 * hides.random(k));
        const double part = kBias * kBias * bias + kHidden * kHidden * functions * hides.random(k);
        const double square =
            functions * places.random(k) +
            kBend * kBend * (bends.low(k) + functions * bends.random(k)) + part +
            functions / (4 * kPi) * prior * prior * (k == 1 ? cosine * cosine : 1);
        all[k] = kMargin * std::sqrt(square) / norm_[k];
        if (k == 0 ? options_.visibility : options_.transfer) {
            *hidden = std::max(*hidden, part / (norm_[k] * norm_[k]));
        }
    }
    return {all[0], all[1]};
}

AdaptiveEstimate AdaptiveHemisphere::estimate_counted(int level) {
    grid_.count_nodes(level, counted_);
    const Sum doubts(counted_.doubts);
    const auto functions = static_cast<double>(sh_count(options_.order));
    return {kCounted * std::sqrt(functions * doubts.random(0)) / norm_[0],
            kCounted * std::sqrt(functions * doubts.random(1)) / norm_[1]};
}

void AdaptiveHemisphere::write_whole(double u, double v, double edge) {
    // Where the concentric map has a kink, triangles end on it.
    const bool kinked = std::abs(u - v) < 0.25 * edge || std::abs(u + v - 1) < 0.25 * edge;
    const int steps =
        static_cast<int>(std::ceil(3.5 * edge * std::max(6, options_.order))) * (kinked ? 2 : 1);
    const double size = edge / steps, area = size * size, root = 0.5 * std::sqrt(1.0 / 3);
    for (int j = 0; j < steps; ++j) {
        for (int i = 0; i < steps; ++i) {
            const double cu = u - 0.5 * edge + (i + 0.5) * size;
            const double cv = v - 0.5 * edge + (j + 0.5) * size;
            const bool rising = std::abs(cu - cv) < 0.25 * size;
            if (!rising && std::abs(cu + cv - 1) >= 0.25 * size) {
                for (int k = 0; k < 4; ++k) {
                    points_.add(cu + (k % 2 ? root : -root) * size,
                                cv + (k / 2 ? root : -root) * size, area / 4);
                }
                continue;
            }
            for (int k = 0; k < 3; ++k) {
                const double a = k == 0 ? 2.0 / 3 : 1.0 / 6, b = k == 1 ? 2.0 / 3 : 1.0 / 6;
                const double x = (a + b - 0.5) * size * (rising ? 1 : -1), y = (b - 0.5) * size;
                points_.add(cu + x, cv + y, area / 6);
                points_.add(cu + (rising ? y : -y), cv + (rising ? x : -x), area / 6);
            }
        }
    }
}

void AdaptiveHemisphere::write_points(const BorderGrid::Result& result) {
    points_.clear();
    for (const BorderGrid::Piece& piece : result.pieces) {
        const double u = double(piece.u), v = double(piece.v);
        if (piece.whole) {
            write_whole(u, v, 1.0 / grid_.cells_along(piece.level));
        } else {
            points_.add(u, v, double(piece.area));
        }
    }
}

// Ends with the number of levels that are complete, and whether to count from there.
AdaptiveEstimate AdaptiveHemisphere::sample_borders(const BorderGrid::Ask& ask, int* finished,
                                                    bool* count) {
    const auto most = static_cast<std::size_t>(options_.most_rays);
    const double share = 0.5 * options_.tolerance * options_.tolerance;
    AdaptiveEstimate estimate;
    for (int depth = 2;;) {
        grid_.cut_mixed(depth, ask);
        grid_.place(kWidth, ask);
        double hidden = 0;
        estimate = estimate_borders(*finished, &hidden);
        if (worst(estimate) <= options_.tolerance) return estimate;
        if (hidden > share && worst(estimate_counted(*finished)) < worst(estimate)) {
            *count = true;
            return estimate;
        }
        // A border costs about as many rays as it has places, times what halving and cutting take.
        const std::size_t rays = grid_.asked() + 8 * borders_.doubts.size();
        const bool finer = *finished + 1 < kLevels && rays + grid_.missing(*finished + 1) <= most;
        const bool deeper = depth < kLevels && rays <= most;
        if (finer && (hidden > share || depth == *finished + 3)) {
            grid_.cut_all(++*finished, ask);
            depth = std::max(depth, *finished + 1);
        } else if (deeper && hidden <= share) {
            ++depth;
        } else {
            return estimate;
        }
    }
}

AdaptiveEstimate AdaptiveHemisphere::sample(const FindBlocked& find_blocked) {
    const BorderGrid::Ask ask = [&](std::size_t count, const float* u, const float* v,
                                    std::uint32_t* hits) {
        for (auto* values : {&x_, &y_, &z_}) values->resize(count);
        for (std::size_t k = 0; k < count; ++k) {
            const glm::dvec3 d = adaptive_direction(double(u[k]), double(v[k]));
            x_[k] = static_cast<float>(d.x);
            y_[k] = static_cast<float>(d.y);
            z_[k] = static_cast<float>(d.z);
        }
        return find_blocked(count, x_.data(), y_.data(), z_.data(), hits);
    };
    const auto most = static_cast<std::size_t>(options_.most_rays);
    int finished = 1;
    grid_.start(ask);
    bool count = grid_.asked() + 14 * grid_.count_mixed(2) > most;
    if (!count) {
        const AdaptiveEstimate estimate = sample_borders(ask, &finished, &count);
        if (!count) {
            write_points(borders_);
            return estimate;
        }
    }
    AdaptiveEstimate estimate = estimate_counted(finished);
    while (worst(estimate) > options_.tolerance && finished < kLevels &&
           grid_.asked() + grid_.missing(finished + 1) <= most) {
        grid_.cut_all(++finished, ask);
        estimate = estimate_counted(finished);
    }
    write_points(counted_);
    return estimate;
}

}  // namespace airlight
