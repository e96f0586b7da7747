// SPDX-License-Identifier: Apache-2.0
#include "sh/rotation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/checked.h"
#include "core/constants.h"
#include "core/error.h"
#include "sh/basis.h"
#include "sh/index.h"

namespace airlight {
namespace {

using Matrix = std::array<std::array<long double, 3>, 3>;  // [row][column]

constexpr double kOrthonormal = 1e-5;

[[noreturn]] void refuse(const std::string& what, double value, const std::string& limit) {
    throw Error(ErrorCode::usage, fmt::format("rotation: {} is {:.6g}, {}", what, value, limit));
}

Matrix rows_of(const glm::dmat3& rotation) {
    Matrix m;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) m[row][column] = rotation[column][row];
    }
    return m;
}

// R R^T - 1, the gauge of what is left to mend.
Matrix excess(const Matrix& r) {
    Matrix e;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            e[i][j] = r[i][0] * r[j][0] + r[i][1] * r[j][1] + r[i][2] * r[j][2] - (i == j);
        }
    }
    return e;
}

// The nearest rotation, by Newton's iteration R <- R - (R R^T - 1) R / 2, which squares the excess.
Matrix orthonormalized(Matrix r) {
    for (int pass = 0; pass < 3; ++pass) {
        const Matrix e = excess(r), before = r;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                for (int k = 0; k < 3; ++k) r[i][j] -= e[i][k] * before[k][j] / 2;
            }
        }
    }
    return r;
}

Matrix checked(const glm::dmat3& rotation) {
    const Matrix r = rows_of(rotation);
    const Matrix e = excess(r);
    for (const auto& row : e) {
        for (const long double entry : row) {
            if (!(std::abs(entry) <= kOrthonormal)) {
                refuse("an entry of R R^T - 1", static_cast<double>(entry), "the limit 1e-5");
            }
        }
    }
    const long double determinant = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) -
                                    r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0]) +
                                    r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
    if (determinant < 0) {
        refuse("the determinant", static_cast<double>(determinant), "a rotation has +1");
    }
    return orthonormalized(r);
}

glm::dmat3 matrix_of(const glm::dquat& q) {
    const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    if (!(std::abs(square - 1) <= kOrthonormal)) {
        refuse("the squared length of the quaternion", square, "a rotation has 1 within 1e-5");
    }
    return glm::mat3_cast(q / std::sqrt(square));
}

// How degree l lies in the product of degrees 1 and l - 1: with the factors below, scaled by
// 1 / sqrt(l (2l-1)), Y_lm is an orthonormal combination of the products Y_1i Y_l-1,a, and so D^l
// is that of D^1 and D^(l-1). This is the recurrence of [Ivanic96] before the right side is reduced
// to one of its terms. Deviates: the paper's division by that term's factor magnifies rounding, to
// 2e-11 at order 64; all terms together magnify nothing.
class DegreeStep {
  public:
    explicit DegreeStep(int order) : root_(2 * static_cast<std::size_t>(order)) {
        for (std::size_t k = 0; k < root_.size(); ++k) root_[k] = std::sqrt(double(k));
        factors_.resize(static_cast<std::size_t>(order) + 1);
        rows_.resize(6 * root_.size());
    }

    // D^l from D^1 and D^(l-1).
    void operator()(int l, const double* one, const double* previous, double* out) {
        const int size = 2 * l - 1;
        for (int a = 0; a <= l; ++a) {
            factors_[a] = {root_[l + a] * root_[l - a], 0.5 * root_[l + a] * root_[l + a - 1],
                           a + 1 < l ? -0.5 * root_[l - a] * root_[l - a - 1] : 0};
        }
        const double scale = 1 / (l * (2.0 * l - 1));
        double* const center = rows_.data() + l - 1;
        const Rows by_row = {center, center + size, center + 2 * size};
        const Rows turned = {center + 3 * size, center + 4 * size, center + 5 * size};
        for (int m = -l; m <= l; ++m) {
            combine_rows(l, m, previous, by_row);
            for (int n = 1 - l; n < l; ++n) {
                for (int j = 0; j < 3; ++j) {
                    turned[j][n] = scale * (one[j] * by_row[0][n] + one[3 + j] * by_row[1][n] +
                                            one[6 + j] * by_row[2][n]);
                }
            }
            double* const to = out + (m + l) * (size + 2) + l;
            combine_columns(l, turned[0], turned[1], turned[2], to);
        }
    }

  private:
    struct Factors {
        double u, v, w;
    };
    using Rows = std::array<double*, 3>;  // for i = -1, 0, 1; entry n = 0

    void combine_rows(int l, int m, const double* previous, const Rows& rows) const {
        const int size = 2 * l - 1, a = std::abs(m);
        const auto [u, v, w] = factors_[a];
        for (double* row : rows) std::fill_n(row + 1 - l, size, 0.0);
        const auto add = [&](int i, double factor, int from) {
            double* const to = rows[i + 1];
            const double* const source = previous + (from + l - 1) * size + l - 1;
            for (int n = 1 - l; n < l; ++n) to[n] += factor * source[n];
        };
        const int inner = m > 0 ? m - 1 : m + 1, outer = m > 0 ? m + 1 : m - 1;
        const double sign = m > 0 ? 1 : -1;
        if (a < l) add(0, u, m);
        if (m == 0) {
            add(1, -root_[2] * v, 1);
            add(-1, -root_[2] * v, -1);
        } else if (a == 1) {
            add(m, root_[2] * v, 0);
        } else {
            add(1, v, inner);
            add(-1, -sign * v, -inner);
        }
        if (m != 0 && a + 1 < l) {
            add(1, w, outer);
            add(-1, sign * w, -outer);
        }
    }

    // The same pattern, of columns.
    void combine_columns(int l, const double* below, const double* zero, const double* above,
                         double* to) const {
        to[0] = factors_[0].u * zero[0] - root_[2] * factors_[0].v * (above[1] + below[-1]);
        to[1] = root_[2] * factors_[1].v * above[0];
        to[-1] = root_[2] * factors_[1].v * below[0];
        for (int n = 2; n <= l; ++n) {
            to[n] = factors_[n].v * (above[n - 1] - below[1 - n]);
            to[-n] = factors_[n].v * (above[1 - n] + below[n - 1]);
        }
        for (int n = 1; n < l; ++n) {
            to[n] += factors_[n].u * zero[n];
            to[-n] += factors_[n].u * zero[-n];
        }
        for (int n = 1; n + 1 < l; ++n) {
            to[n] += factors_[n].w * (above[n + 1] + below[-n - 1]);
            to[-n] += factors_[n].w * (above[-n - 1] - below[n + 1]);
        }
    }

    std::vector<double> root_;  // sqrt(k)
    std::vector<Factors> factors_;
    std::vector<double> rows_;
};

template <class Real>
void rotate_zonal_to(int order, const double* g, const glm::dvec3& axis, Real* out) {
    std::vector<double> basis(sh_count(order));
    evaluate_basis(order, axis.x, axis.y, axis.z, basis.data());
    for (int l = 0; l < order; ++l) {
        const double scale = std::sqrt(4 * kPi / (2.0 * l + 1)) * g[l];
        for (std::size_t i = sh_index(l, -l); i <= sh_index(l, l); ++i) {
            out[i] = static_cast<Real>(scale * basis[i]);
        }
    }
}

}  // namespace

ShRotation::ShRotation(int order) : order_(order) {
    if (order < 1) refuse("the order", order, "the least is 1");
    const std::size_t n = static_cast<std::size_t>(order);
    const std::size_t cube = checked_product({n, n, n}, "a rotation of coefficients");
    require_memory(checked_multiply(cube, 16, "a rotation of coefficients"), kDefaultMaxMemory,
                   "a rotation of order " + std::to_string(order));
    double_.assign(offset(order), 0.0);
}

ShRotation::ShRotation(int order, const glm::dmat3& rotation) : ShRotation(order) {
    const Matrix r = checked(rotation);
    double_[0] = 1;
    if (order > 1) {
        // Y_1 is proportional to (y, z, x).
        constexpr int kComponent[] = {1, 2, 0};
        for (int m = 0; m < 3; ++m) {
            for (int k = 0; k < 3; ++k) {
                double_[1 + m * 3 + k] = static_cast<double>(r[kComponent[m]][kComponent[k]]);
            }
        }
    }
    DegreeStep step(order);
    for (int l = 2; l < order; ++l) {
        step(l, block(1), block(l - 1), double_.data() + offset(l));
    }
    round_to_float();
}

ShRotation::ShRotation(int order, const glm::dquat& rotation)
    : ShRotation(order, matrix_of(rotation)) {}

ShRotation ShRotation::identity(int order) {
    ShRotation result(order);
    for (int l = 0; l < order; ++l) {
        const auto size = static_cast<std::size_t>(2 * l + 1);
        for (std::size_t i = 0; i < size; ++i) result.double_[offset(l) + i * (size + 1)] = 1;
    }
    result.round_to_float();
    return result;
}

ShRotation ShRotation::inverse() const {
    ShRotation result(order_);
    for (int l = 0; l < order_; ++l) {
        const auto size = static_cast<std::size_t>(2 * l + 1);
        const double* from = block(l);
        double* to = result.double_.data() + offset(l);
        for (std::size_t m = 0; m < size; ++m) {
            for (std::size_t k = 0; k < size; ++k) to[m * size + k] = from[k * size + m];
        }
    }
    result.round_to_float();
    return result;
}

ShRotation operator*(const ShRotation& second, const ShRotation& first) {
    if (first.order_ != second.order_) {
        refuse("the second order", second.order_, "the first one " + std::to_string(first.order_));
    }
    ShRotation result(first.order_);
    for (int l = 0; l < first.order_; ++l) {
        const auto size = static_cast<std::size_t>(2 * l + 1);
        const double* a = second.block(l);
        const double* b = first.block(l);
        double* to = result.double_.data() + ShRotation::offset(l);
        for (std::size_t m = 0; m < size; ++m) {
            for (std::size_t j = 0; j < size; ++j) {
                for (std::size_t k = 0; k < size; ++k) {
                    to[m * size + k] += a[m * size + j] * b[j * size + k];
                }
            }
        }
    }
    result.round_to_float();
    return result;
}

void ShRotation::round_to_float() {
    float_.resize(double_.size());
    std::transform(double_.begin(), double_.end(), float_.begin(),
                   [](double value) { return static_cast<float>(value); });
}

void rotate_zonal(int order, const double* g, const glm::dvec3& axis, double* out) {
    rotate_zonal_to(order, g, axis, out);
}

void rotate_zonal(int order, const double* g, const glm::dvec3& axis, float* out) {
    rotate_zonal_to(order, g, axis, out);
}

}  // namespace airlight
