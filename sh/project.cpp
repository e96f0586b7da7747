// SPDX-License-Identifier: Apache-2.0
#include "sh/project.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/quadrature.h"
#include "sh/rotation.h"
#include "sh/row_moments.h"

namespace airlight {
namespace {

// Pairs of rows whose sums go together.
constexpr std::size_t kPairBlock = 16;

template <class T>
struct Map {
    const T* values;
    std::size_t rows, columns, channels;

    std::size_t row_size() const { return columns * channels; }
    const T* row(std::size_t j) const { return values + j * row_size(); }
    std::size_t readable(std::size_t j) const { return (rows - j) * row_size(); }
};

void check(int rows, int columns, int channels, int order, MapRule rule) {
    if (order < 1 || order > kLargestProjectionOrder) {
        throw Error(ErrorCode::usage, "order " + std::to_string(order) +
                                          " of a projection is not in [1, " +
                                          std::to_string(kLargestProjectionOrder) + "]");
    }
    const std::string size = std::to_string(columns) + " x " + std::to_string(rows) +
                             " pixels and " + std::to_string(channels) + " channels";
    if (rows < 1 || columns < 1 || channels < 1) {
        throw Error(ErrorCode::usage, "a map of " + size + " cannot be projected");
    }
    if (rule == MapRule::centre_samples && (order > rows || 2LL * (order - 1) >= columns)) {
        throw Error(ErrorCode::data,
                    "order " + std::to_string(order) + " does not fit samples of " + size +
                        ": it must not exceed the rows, nor its degree half the columns");
    }
}

// Called for a map in which a sum is not finite.
template <class T>
[[noreturn]] void refuse_nonfinite(const Map<T>& map) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = map.rows * map.row_size(); i-- > 0;) {
        if (std::isfinite(map.values[i])) continue;
        ++count;
        first = i;
    }
    if (count == 0) throw Error(ErrorCode::data, "the values of a row add up beyond 1.8e308");
    throw Error(ErrorCode::data, "the map holds " + std::to_string(count) +
                                     " non-finite values, the first in row " +
                                     std::to_string(first / map.row_size()) + ", column " +
                                     std::to_string(first % map.row_size() / map.channels) +
                                     ", channel " + std::to_string(first % map.channels));
}

// Nodes enough that the rule integrates e^{i order theta} over a row to 1e-17 of its length: the
// remainder of Gauss-Legendre quadrature [DLMF] 3.5(v) with the derivative z^{2k}.
int nodes_per_row(int order, std::size_t rows) {
    const double z = order * kPi / (2.0 * static_cast<double>(rows));
    double remainder = z * z / 3;  // 2^{2k+1} (k!)^4 z^{2k} / ((2k+1) ((2k)!)^3)
    int k = 1;
    for (; remainder > 1e-17;
         remainder *= z * z * k / (2.0 * (2 * k + 1)) / (2 * k - 1) / (2 * k - 1)) {
        ++k;
    }
    return k;
}

// The weights of one row: sum over the rule's nodes in it of weight P_lm, by order m, then degree.
class RowWeights {
  public:
    RowWeights(std::size_t rows, int order, MapRule rule)
        : rows_(rows), order_(order), means_(rule == MapRule::pixel_means) {
        rule_ = means_ ? gauss_legendre(nodes_per_row(order, rows))
                       : fejer_rows(static_cast<int>(rows));
    }

    std::size_t count() const { return static_cast<std::size_t>(order_) * (order_ + 1) / 2; }

    void of_row(std::size_t row, double* out) const {
        std::fill(out, out + count(), 0.0);
        const double step = kPi / static_cast<double>(rows_);
        const double centre = step * (static_cast<double>(row) + 0.5);
        if (!means_) return add(centre, rule_.weight[row], out);
        for (std::size_t i = 0; i < rule_.cosine.size(); ++i) {
            const double theta = centre + step / 2 * rule_.cosine[i];
            add(theta, step / 2 * rule_.weight[i] * std::sin(theta), out);
        }
    }

  private:
    void add(double theta, double weight, double* out) const {
        double legendre[kLargestProjectionOrder];
        const double c = std::cos(theta), s = std::sin(theta);
        for (int m = 0; m < order_; ++m) {
            normalized_legendre(order_, c, s, m, legendre);
            for (int l = m; l < order_; ++l) *out++ += weight * legendre[l - m];
        }
    }

    std::size_t rows_;
    int order_;
    bool means_;
    PolarRule rule_;
};

// The integral over a column of cos(m phi), over its value at the centre, with the sqrt(2) of
// Y_lm; negative where phi = pi - psi turns the sign of the cosine.
std::vector<double> column_weights(std::size_t columns, int order, MapRule rule) {
    const auto width = static_cast<double>(columns);
    std::vector<double> weights = {2 * kPi / width};
    for (int m = 1; m < order; ++m) {
        const double w =
            rule == MapRule::pixel_means ? 2.0 / m * std::sin(m * kPi / width) : 2 * kPi / width;
        weights.push_back((m % 2 == 0 ? 1 : -1) * std::sqrt(2.0) * w);
    }
    return weights;
}

// Coefficients in the map frame, (channels, order^2), without the weights of columns.
template <class T>
std::vector<double> map_frame_sums(const Map<T>& map, int order, const RowWeights& weights) {
    const RowMoments moments(map.columns, static_cast<std::size_t>(order));
    const std::size_t slots = sh_count(order), size = map.channels * order * 2;
    const std::size_t pairs = (map.rows + 1) / 2;
    // Large orders have sums too large to keep many of them.
    const std::size_t grain = order <= 32 ? kPairBlock : std::max(kPairBlock, (pairs + 7) / 8);
    const auto sum_block = [&](std::size_t begin, std::size_t end) {
        std::vector<double> sums(map.channels * slots), north(size), south(size);
        std::vector<double> weight(weights.count());
        for (std::size_t j = begin; j < end; ++j) {
            const std::size_t mirrored = map.rows - 1 - j;
            moments(map.row(j), map.channels, map.readable(j), north.data());
            if (mirrored != j) {
                moments(map.row(mirrored), map.channels, map.readable(mirrored), south.data());
            } else {
                std::fill(south.begin(), south.end(), 0.0);
            }
            weights.of_row(j, weight.data());
            for (std::size_t channel = 0; channel < map.channels; ++channel) {
                const double* n = north.data() + channel * order * 2;
                const double* s = south.data() + channel * order * 2;
                if (!std::isfinite(n[0]) || !std::isfinite(s[0])) refuse_nonfinite(map);
                const double* w = weight.data();
                for (int m = 0; m < order; ++m, n += 2, s += 2) {
                    const double cosine[2] = {n[0] + s[0], n[0] - s[0]};
                    const double sine[2] = {n[1] + s[1], n[1] - s[1]};
                    for (int l = m; l < order; ++l, ++w) {
                        double* const band =
                            sums.data() + channel * slots + static_cast<std::size_t>(l) * (l + 1);
                        band[m] += *w * cosine[(l - m) % 2];
                        if (m > 0) *(band - m) += *w * sine[(l - m) % 2];
                    }
                }
            }
        }
        return sums;
    };
    return ordered_reduce(pairs, grain, std::vector<double>(), sum_block,
                          [](std::vector<double>& total, const std::vector<double>& part) {
                              if (total.empty()) total.resize(part.size());
                              for (std::size_t i = 0; i < part.size(); ++i) total[i] += part[i];
                          });
}

template <class T>
std::vector<double> project(const T* values, int rows, int columns, int channels, int order,
                            MapRule rule) {
    check(rows, columns, channels, order, rule);
    const Map<T> map = {values, static_cast<std::size_t>(rows), static_cast<std::size_t>(columns),
                        static_cast<std::size_t>(channels)};
    std::vector<double> sums = map_frame_sums(map, order, RowWeights(map.rows, order, rule));
    const std::vector<double> weights = column_weights(map.columns, order, rule);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const int m = sh_degree(i % sh_count(order)).m;
        // sin(m phi) = -(-1)^m sin(m psi).
        sums[i] *= m >= 0 ? weights[m] : -weights[-m];
    }
    // The basis direction of the map frame is (Z, X, Y); the turn takes it to (X, Y, Z).
    const ShRotation to_world(order, glm::dmat3(0, 0, 1, 1, 0, 0, 0, 1, 0));
    to_world.rotate(map.channels, sums.data(), sums.data());
    return sums;
}

}  // namespace

std::vector<double> project_latlong(const float* map, int rows, int columns, int channels,
                                    int order, MapRule rule) {
    return project(map, rows, columns, channels, order, rule);
}

std::vector<double> project_latlong(const double* map, int rows, int columns, int channels,
                                    int order, MapRule rule) {
    return project(map, rows, columns, channels, order, rule);
}

}  // namespace airlight
