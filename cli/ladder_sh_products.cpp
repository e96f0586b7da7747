// SPDX-License-Identifier: Apache-2.0
// Ladders of products, triple-product integrals and functions of functions.
#include <fmt/format.h>

#include "cli/ladder_draws.h"
#include "cli/ladder_sh.h"
#include "sh/function_grid.h"
#include "sh/index.h"
#include "sh/product.h"
#include "sh/product_matrix.h"
#include "sh/triple_product.h"

namespace airlight {
namespace {

const int kOrders[] = {3, 4, 5, 6, 8};

template <class T>
std::vector<T> converted(const std::vector<float>& values) {
    return {values.begin(), values.end()};
}

/// Factors that floats hold, and their products by the sum over Gamma in double.
struct Pairs {
    std::vector<float> a, b;
    std::vector<double> exact;

    explicit Pairs(int order)
        : a(random_numbers<float>(kLadderVectors * sh_count(order), 21)),
          b(random_numbers<float>(kLadderVectors * sh_count(order), 22)),
          exact(a.size()) {
        ShProduct(order, ShProductMethod::sparse)
            .multiply(kLadderVectors, converted<double>(a).data(), converted<double>(b).data(),
                      exact.data());
    }
};

RungResult measure_planes_product(int order, ShProductMethod method) {
    const Pairs pairs(order);
    const std::size_t size = sh_count(order);
    const auto a = transposed(pairs.a, size), b = transposed(pairs.b, size);
    const ShProduct product(order, method);
    return measure_planes<float>(pairs.exact, size, [&](float* out) {
        product.multiply_planes(kLadderVectors, kLadderVectors, a.data(), b.data(), out);
    });
}

// `at_once` pairs in a call.
template <class T>
RungResult measure_product(int order, ShProductMethod method, std::size_t at_once) {
    const Pairs pairs(order);
    const std::size_t size = sh_count(order);
    const auto a = converted<T>(pairs.a), b = converted<T>(pairs.b);
    const ShProduct product(order, method);
    return measure_vectors<T>(pairs.exact, size, [&](T* out) {
        for (std::size_t v = 0; v < kLadderVectors; v += at_once) {
            product.multiply(at_once, &a[v * size], &b[v * size], out + v * size);
        }
    });
}

// Methods with their series; the last series is that of doubles.
const std::vector<PlotSeries> kMethodSeries = {{"sparse", kPlotColours[3], true, {}},
                                               {"tree", kPlotColours[2], true, {}},
                                               {"rows", kPlotColours[0], true, {}},
                                               {"grid", kPlotColours[4], true, {}},
                                               {"in double", kPlotColours[1], true, {}}};

template <class Add>
void for_each_method(const Add& add) {
    for (std::size_t i = 0; i < std::size(kShProductMethods); ++i) {
        for (const int order : kOrders) {
            const ShProductMethod method = kShProductMethods[i].method;
            if (method == ShProductMethod::tree && order > 5) continue;
            add(i, method, std::string(kShProductMethods[i].name), order);
        }
    }
}

LadderRung rung_of(const std::string& method, int order, std::size_t series,
                   std::function<RungResult()> measure) {
    return {method, order_name(order), std::to_string(order), series, std::move(measure)};
}

/// Triples <L|V|B> with one light for all vertices.
struct Triples {
    std::vector<float> light, v, b;
    std::vector<double> exact;

    explicit Triples(int order)
        : light(random_numbers<float>(sh_count(order), 23)),
          v(random_numbers<float>(kLadderVectors * sh_count(order), 24)),
          b(random_numbers<float>(v.size(), 25)) {
        const TripleProducts triples(order);
        const auto wide_light = converted<double>(light), wide_v = converted<double>(v),
                   wide_b = converted<double>(b);
        for (std::size_t i = 0; i < v.size(); i += sh_count(order)) {
            exact.push_back(triples.integral(wide_light.data(), &wide_v[i], &wide_b[i]));
        }
    }
};

double norm(const float* v, std::size_t size) {
    double sum = 0;
    for (std::size_t k = 0; k < size; ++k) sum += static_cast<double>(v[k]) * v[k];
    return std::sqrt(sum);
}

template <class T, class Run>
RungResult measure_integrals(const Triples& triples, const Run& run) {
    const std::size_t size = triples.light.size();
    std::vector<T> out(kLadderVectors);
    run(out.data());
    LadderErrors errors;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double scale = norm(triples.light.data(), size) * norm(&triples.v[i * size], size) *
                             norm(&triples.b[i * size], size);
        errors.add(std::abs(static_cast<double>(out[i]) - triples.exact[i]) / scale);
    }
    return {nanoseconds_each(kLadderVectors, [&] { run(out.data()); }), errors.largest(),
            errors.rms()};
}

RungResult measure_matrix(int order) {
    const Triples triples(order);
    const ShProductMatrix matrix(TripleProducts(order), triples.light.data());
    return measure_integrals<float>(triples, [&](float* out) {
        matrix.integral(kLadderVectors, triples.v.data(), triples.b.data(), out);
    });
}

RungResult measure_matrix_each(int order) {
    const Triples triples(order);
    const TripleProducts gamma(order);
    const std::size_t size = sh_count(order);
    return measure_integrals<float>(triples, [&](float* out) {
        for (std::size_t i = 0; i < kLadderVectors; ++i) {
            ShProductMatrix(gamma, triples.light.data())
                .integral(1, &triples.v[i * size], &triples.b[i * size], out + i);
        }
    });
}

RungResult measure_product_dot(int order) {
    const Triples triples(order);
    const ShProduct product(order);
    std::vector<float> products(triples.v.size());
    return measure_integrals<float>(triples, [&](float* out) {
        product.multiply(kLadderVectors, triples.v.data(), triples.b.data(), products.data());
        sh_dot(order, triples.light.data(), kLadderVectors, products.data(), out);
    });
}

RungResult measure_triple_sum(int order) {
    const Triples triples(order);
    const TripleProducts gamma(order);
    const auto light = converted<double>(triples.light), v = converted<double>(triples.v),
               b = converted<double>(triples.b);
    return measure_integrals<double>(triples, [&](double* out) {
        for (std::size_t i = 0; i < kLadderVectors; ++i) {
            const std::size_t at = i * sh_count(order);
            out[i] = gamma.integral(light.data(), &v[at], &b[at]);
        }
    });
}

constexpr int kFunctionOrder = 6, kFineRows = 96;
constexpr float kFloor = 1e-3f;

/// A function of a function, on any grid.
struct GridFunction {
    const char* name;
    double (*value)(double f);
    void (*batch)(const ShGrid& grid, const float* in, float* out);
    double middle, reach;  ///< of the values of f
};

const GridFunction kFunctions[] = {
    {"exp", [](double f) { return std::exp(f); },
     [](const ShGrid& grid, const float* in, float* out) {
         grid.exponential(kLadderVectors, in, out);
     },
     0, 3},
    {"log", [](double f) { return std::log(std::max(f, static_cast<double>(kFloor))); },
     [](const ShGrid& grid, const float* in, float* out) {
         grid.logarithm(kLadderVectors, kFloor, in, out);
     },
     1, 0.9},
    {"clamp", [](double f) { return std::clamp(f, 0.0, 1.0); },
     [](const ShGrid& grid, const float* in, float* out) {
         grid.clamp(kLadderVectors, 0, 1, in, out);
     },
     0.5, 1}};

RungResult measure_function(const GridFunction& function, int rows) {
    const std::size_t size = sh_count(kFunctionOrder);
    const ShGrid fine(kFunctionOrder, kFineRows), grid(kFunctionOrder, rows);
    auto in = random_numbers<float>(kLadderVectors * size, 26);
    std::vector<double> exact(in.size()), one(size);
    for (std::size_t v = 0; v < in.size(); v += size) {
        in[v] = 0;
        for (std::size_t k = 0; k < size; ++k) one[k] = in[v + k];
        double largest = 0;
        fine.apply(
            [&](double f) {
                largest = std::max(largest, std::abs(f));
                return f;
            },
            one.data(), &exact[v]);
        for (std::size_t k = 0; k < size; ++k) {
            in[v + k] = static_cast<float>(in[v + k] * function.reach / largest);
        }
        in[v] = static_cast<float>(std::sqrt(4 * kPi) * function.middle);
        for (std::size_t k = 0; k < size; ++k) one[k] = in[v + k];
        fine.apply(function.value, one.data(), &exact[v]);
    }
    return measure_vectors<float>(exact, size,
                                  [&](float* out) { function.batch(grid, in.data(), out); });
}

}  // namespace

RungLadder sh_product_ladder() {
    RungLadder ladder;
    ladder.effect = "sh-product";
    ladder.title = "Products of functions";
    ladder.text =
        "<p>Products of pairs of random vectors, projected to their order, the dot's label. First "
        "64 pairs at once, slot by slot (<code>planes</code>; <code>grid</code> takes vectors one "
        "after the other), then pairs one by one. The error of a coefficient is divided by the "
        "largest one of the product; exact is the sum over all triple-product coefficients in "
        "double, the method <code>sparse</code>, so that <code>rows</code> in double shows the "
        "rounding of both.</p>";
    ladder.result = "product";
    ladder.error = "error over the largest coefficient";
    RungFigure planes, single;
    planes.file = "sh-product";
    planes.title = "Products of 64 pairs at once";
    planes.subtitle = "float, and rows in double; labels are orders";
    single.file = "sh-product-single";
    single.title = "Products of pairs one by one";
    single.subtitle = planes.subtitle;
    planes.series = single.series = kMethodSeries;
    for_each_method([&](std::size_t series, ShProductMethod method, const std::string& name,
                        int order) {
        const bool grid = method == ShProductMethod::grid;
        planes.rungs.push_back(rung_of(name + (grid ? "-vectors" : "-planes"), order, series, [=] {
            return grid ? measure_product<float>(order, method, kLadderVectors)
                        : measure_planes_product(order, method);
        }));
        single.rungs.push_back(rung_of(name + "-single", order, series,
                                       [=] { return measure_product<float>(order, method, 1); }));
    });
    for (const int order : kOrders) {
        planes.rungs.push_back(rung_of("rows-double-vectors", order, 4, [=] {
            return measure_product<double>(order, ShProductMethod::rows, kLadderVectors);
        }));
        single.rungs.push_back(rung_of("rows-double-single", order, 4, [=] {
            return measure_product<double>(order, ShProductMethod::rows, 1);
        }));
    }
    ladder.figures = {std::move(planes), std::move(single)};
    return ladder;
}

RungLadder sh_triple_ladder() {
    RungLadder ladder;
    ladder.effect = "sh-triple";
    ladder.title = "Triple-product integrals";
    ladder.text =
        "<p>⟨L|V|B⟩ = ∫ L V B dω of one light and the visibility and reflectance of 64 vertices, "
        "random vectors of the dot's order. Errors are divided by |L| |V| |B|; exact is the sum "
        "over all triple-product coefficients in double, whose own bound is drawn. The matrix is "
        "that of products with the light, built once for all vertices or for each. A product, "
        "then a dot product, does not need one light for all.</p>";
    ladder.result = "vertex";
    ladder.error = "error over |L| |V| |B|";
    RungFigure figure;
    figure.file = "sh-triple";
    figure.title = ladder.title;
    figure.subtitle = "one light, 64 vertices; labels are orders";
    figure.series = {{"matrix of the light", kPlotColours[0], true, {}},
                     {"product, then dot", kPlotColours[1], true, {}},
                     {"matrix built for each", kPlotColours[3], true, {}},
                     {"sum in double (its bound)", kPlotColours[2], true, {}}};
    const auto add = [&](const char* name, std::size_t series, RungResult (*measure)(int)) {
        for (const int order : kOrders) {
            figure.rungs.push_back(rung_of(name, order, series, [=] { return measure(order); }));
            if (series == 3) figure.rungs.back().bound = 1e-15;
        }
    };
    add("matrix", 0, measure_matrix);
    add("product-dot", 1, measure_product_dot);
    add("matrix-each", 2, measure_matrix_each);
    add("sum-double", 3, measure_triple_sum);
    ladder.figures = {std::move(figure)};
    return ladder;
}

RungLadder sh_function_ladder() {
    RungLadder ladder;
    ladder.effect = "sh-function";
    ladder.title = "Functions of functions";
    ladder.text = fmt::format(
        "<p>exp(f) of 64 random functions of order {} with |f| ≤ 3, log(max(f, 0.001)) of such in "
        "0.1 … 1.9, and f in −0.5 … 1.5 clamped to 0 … 1, in float on a Gauss grid. Dots are "
        "labelled with its rows. The error of a coefficient is divided by the largest one; exact "
        "is a grid of {} rows in double.</p>",
        kFunctionOrder, kFineRows);
    ladder.result = "vector";
    ladder.error = "error over the largest coefficient";
    RungFigure figure;
    figure.file = "sh-function";
    figure.title = ladder.title;
    figure.subtitle = fmt::format("order {}, labels are rows of the grid", kFunctionOrder);
    figure.series = {{"exp", kPlotColours[0], true, {}},
                     {"log", kPlotColours[2], true, {}},
                     {"clamp", kPlotColours[1], true, {}}};
    for (std::size_t i = 0; i < std::size(kFunctions); ++i) {
        for (const int rows : {6, 9, 12, 18, 24}) {
            figure.rungs.push_back({fmt::format("grid-{}", rows), kFunctions[i].name,
                                    std::to_string(rows), i,
                                    [=] { return measure_function(kFunctions[i], rows); }});
        }
    }
    ladder.figures = {std::move(figure)};
    return ladder;
}

}  // namespace airlight
