// SPDX-License-Identifier: Apache-2.0
// Ladders of the basis and of rotation.
#include "cli/ladder_sh.h"

#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "cli/ladder_draws.h"
#include "sh/basis.h"
#include "sh/basis_batch.h"
#include "sh/index.h"
#include "sh/rotation.h"

namespace airlight {
namespace {

template <class Real>
struct Directions {
    std::vector<Real> x, y, z;

    explicit Directions(std::size_t count) {
        Draws draws(11);
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 d = draws.direction();
            x.push_back(static_cast<Real>(d.x));
            y.push_back(static_cast<Real>(d.y));
            z.push_back(static_cast<Real>(d.z));
        }
    }
};

// Directions whose basis functions fit the first-level cache together.
std::size_t block_of(int order) {
    return std::clamp<std::size_t>(2048 / sh_count(order) / 16 * 16, 16, 256);
}

// batch(i, count, out, stride) makes the functions of `count` directions from the i-th on.
template <class Real, class Batch>
RungResult measure_basis(int order, const Directions<Real>& d, const Batch& batch) {
    const std::size_t slots = sh_count(order), block = block_of(order), stride = block + 16;
    std::vector<Real> out(slots * stride);
    std::vector<double> exact(slots);
    LadderErrors errors;
    for (std::size_t begin = 0; begin + block <= d.x.size(); begin += block) {
        batch(begin, block, out.data(), stride);
        for (std::size_t i = 0; i < block; ++i) {
            evaluate_basis(order, static_cast<double>(d.x[begin + i]),
                           static_cast<double>(d.y[begin + i]), static_cast<double>(d.z[begin + i]),
                           exact.data());
            for (std::size_t k = 0; k < slots; ++k) {
                const double scale = std::sqrt((2 * sh_degree(k).l + 1) / (4 * kPi));
                errors.add(std::abs(static_cast<double>(out[k * stride + i]) - exact[k]) / scale);
            }
        }
    }
    const double nanoseconds = nanoseconds_each(
        static_cast<double>(block), [&] { batch(std::size_t{0}, block, out.data(), stride); });
    return {nanoseconds, errors.largest(), errors.rms()};
}

template <class Real>
RungResult measure_basis_batch(int order) {
    const Directions<Real> d(2048);
    return measure_basis(
        order, d, [&](std::size_t i, std::size_t count, Real* out, std::size_t stride) {
            evaluate_basis_batch(order, count, &d.x[i], &d.y[i], &d.z[i], out, stride);
        });
}

template <class Real>
RungResult measure_basis_single(int order) {
    const Directions<Real> d(2048);
    std::vector<Real> one(sh_count(order));
    return measure_basis(
        order, d, [&](std::size_t i, std::size_t count, Real* out, std::size_t stride) {
            for (std::size_t j = 0; j < count; ++j) {
                evaluate_basis(order, d.x[i + j], d.y[i + j], d.z[i + j], one.data());
                for (std::size_t k = 0; k < one.size(); ++k) out[k * stride + j] = one[k];
            }
        });
}

/// Functions that a rotation moves in a known way: each is a sum of lights in a few directions.
struct TurnedLights {
    glm::dquat turn = glm::normalize(glm::dquat(0.3, 0.5, -0.7, 0.2));
    std::vector<double> before, after;  ///< (kLadderVectors, order^2)

    explicit TurnedLights(int order)
        : before(kLadderVectors * sh_count(order)), after(before.size()) {
        constexpr int kLights = 6;
        const std::size_t size = sh_count(order);
        Draws draws(12);
        std::vector<double> basis(size);
        const auto add = [&](double weight, const glm::dvec3& d, double* sums) {
            evaluate_basis(order, d.x, d.y, d.z, basis.data());
            for (std::size_t k = 0; k < size; ++k) sums[k] += weight * basis[k];
        };
        for (std::size_t v = 0; v < kLadderVectors; ++v) {
            for (int i = 0; i < kLights; ++i) {
                const double weight = draws.uniform(-1, 1);
                const glm::dvec3 d = draws.direction();
                add(weight, d, &before[v * size]);
                add(weight, turn * d, &after[v * size]);
            }
        }
    }
};

template <class T>
RungResult measure_rotation(int order) {
    const TurnedLights lights(order);
    const std::vector<T> in(lights.before.begin(), lights.before.end());
    const ShRotation rotation(order, lights.turn);
    return measure_vectors<T>(lights.after, sh_count(order),
                              [&](T* out) { rotation.rotate(kLadderVectors, in.data(), out); });
}

RungResult measure_rotation_planes(int order) {
    const TurnedLights lights(order);
    const std::vector<float> in(lights.before.begin(), lights.before.end());
    const std::vector<float> planes = transposed(in, sh_count(order));
    const ShRotation rotation(order, lights.turn);
    return measure_planes<float>(lights.after, sh_count(order), [&](float* out) {
        rotation.rotate_planes(kLadderVectors, kLadderVectors, planes.data(), out);
    });
}

RungResult measure_rotation_each(int order) {
    const TurnedLights lights(order);
    const std::vector<float> in(lights.before.begin(), lights.before.end());
    const std::size_t size = sh_count(order);
    return measure_vectors<float>(lights.after, size, [&](float* out) {
        for (std::size_t v = 0; v < kLadderVectors; ++v) {
            ShRotation(order, lights.turn).rotate(1, &in[v * size], out + v * size);
        }
    });
}

RungResult measure_rotation_zonal(int order) {
    const TurnedLights lights(order);
    const std::size_t size = sh_count(order), bands = static_cast<std::size_t>(order);
    const auto g = random_numbers<double>(kLadderVectors * bands, 13);
    std::vector<double> exact(kLadderVectors * size);
    for (std::size_t v = 0; v < kLadderVectors; ++v) {
        for (int l = 0; l < order; ++l) {
            exact[v * size + sh_index(l, 0)] = g[v * bands + static_cast<std::size_t>(l)];
        }
    }
    ShRotation(order, lights.turn).rotate(kLadderVectors, exact.data(), exact.data());
    const glm::dvec3 axis = lights.turn * glm::dvec3(0, 0, 1);
    return measure_vectors<float>(exact, size, [&](float* out) {
        for (std::size_t v = 0; v < kLadderVectors; ++v) {
            rotate_zonal(order, &g[v * bands], axis, out + v * size);
        }
    });
}

// A rung of each order, its dot labelled with it.
void add_orders(RungFigure& figure, const std::string& method, std::size_t series,
                std::initializer_list<int> orders, RungResult (*measure)(int order)) {
    for (const int order : orders) {
        figure.rungs.push_back({method, order_name(order), std::to_string(order), series,
                                [=] { return measure(order); }});
    }
}

LadderWork plan_rungs(RungLadder (*ladder)()) {
    return plan_rung_ladder(ladder());
}

}  // namespace

RungLadder sh_basis_ladder() {
    RungLadder ladder;
    ladder.effect = "sh-basis";
    ladder.title = "Spherical-harmonic basis";
    ladder.text =
        "<p>All Y<sub>lm</sub>, l &lt; order, of 2048 directions uniform over the sphere, one by "
        "one and in batches. Dots are labelled with the order. The error of a value is divided by "
        "√((2l+1)/4π), the root mean square of Y<sub>lm</sub>; it is that of the difference from "
        "<code>evaluate_basis</code> in double, whose own bound is drawn, at the directions as "
        "the precision holds them. Results go to a block that fits the first-level cache.</p>";
    ladder.result = "direction";
    ladder.error = "error over √((2l+1)/4π)";
    RungFigure figure;
    figure.file = "sh-basis";
    figure.title = ladder.title;
    figure.subtitle = "all functions of an order; labels are orders";
    figure.series = {{"batch, float", kPlotColours[0], true, {}},
                     {"batch, double", kPlotColours[1], true, {}},
                     {"one by one, float", kPlotColours[3], true, {}},
                     {"one by one, double (its bound)", kPlotColours[2], true, {}}};
    const auto orders = {3, 4, 6, 8, 16, 32};
    add_orders(figure, "batch-float", 0, orders, measure_basis_batch<float>);
    add_orders(figure, "batch-double", 1, orders, measure_basis_batch<double>);
    add_orders(figure, "evaluate-float", 2, orders, measure_basis_single<float>);
    const std::size_t first = figure.rungs.size();
    add_orders(figure, "evaluate-double", 3, orders, measure_basis_single<double>);
    for (std::size_t i = first; i < figure.rungs.size(); ++i) {
        const double l = std::stod(figure.rungs[i].label) - 1;
        figure.rungs[i].bound = (4 + 1.5 * l) * std::numeric_limits<double>::epsilon();
    }
    ladder.figures = {std::move(figure)};
    return ladder;
}

RungLadder sh_rotation_ladder() {
    RungLadder ladder;
    ladder.effect = "sh-rotation";
    ladder.title = "Rotation of coefficients";
    ladder.text =
        "<p>64 vectors, each the sum of six lights of random direction and sign, turned by one "
        "rotation. Dots are labelled with the order. The error of a coefficient is divided by the "
        "largest one of its vector; exact are the sums of the lights in the turned directions, "
        "in double. <code>each</code> builds the matrices anew for every vector. "
        "<code>planes</code> "
        "have the vectors slot by slot. <code>zonal</code> turns functions of one axis without a "
        "matrix, and is compared with the matrices in double.</p>";
    ladder.result = "vector";
    ladder.error = "error over the largest coefficient";
    RungFigure figure;
    figure.file = "sh-rotation";
    figure.title = ladder.title;
    figure.subtitle = "64 vectors, float but for double; labels are orders";
    figure.series = {{"vectors", kPlotColours[0], true, {}},
                     {"planes", kPlotColours[5], true, {}},
                     {"vectors in double", kPlotColours[1], true, {}},
                     {"matrix for each", kPlotColours[3], true, {}},
                     {"zonal shortcut", kPlotColours[2], true, {}}};
    const auto orders = {3, 4, 6, 8, 16};
    add_orders(figure, "vectors-float", 0, orders, measure_rotation<float>);
    add_orders(figure, "planes-float", 1, orders, measure_rotation_planes);
    add_orders(figure, "vectors-double", 2, orders, measure_rotation<double>);
    add_orders(figure, "each-float", 3, orders, measure_rotation_each);
    add_orders(figure, "zonal-float", 4, orders, measure_rotation_zonal);
    ladder.figures = {std::move(figure)};
    return ladder;
}

const std::vector<ShLadder>& sh_ladders() {
    static const std::vector<ShLadder> kLadders = {
        {"sh-basis", [] { return plan_rungs(sh_basis_ladder); }},
        {"sh-rotation", [] { return plan_rungs(sh_rotation_ladder); }},
        {"sh-product", [] { return plan_rungs(sh_product_ladder); }},
        {"sh-triple", [] { return plan_rungs(sh_triple_ladder); }},
        {"sh-function", [] { return plan_rungs(sh_function_ladder); }},
        {"sh-psf", [] { return plan_rungs(sh_psf_ladder); }},
        {"sh-projection", [] { return plan_rungs(sh_projection_ladder); }},
        {"sh-transform", [] { return plan_rungs(sh_transform_ladder); }},
        {"sh-window", plan_sh_window_ladder},
        {"brdf", [] { return plan_rungs(brdf_lookup_ladder); }},
        {"brdf-fog", [] { return plan_rungs(brdf_fog_ladder); }},
    };
    return kLadders;
}

}  // namespace airlight
