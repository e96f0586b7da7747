// SPDX-License-Identifier: Apache-2.0
#include "prt/border_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "core/constants.h"

namespace airlight {
namespace {

using Shape = std::function<bool(double, double)>;

BorderGrid::Ask asking(const Shape& blocked) {
    return [blocked](std::size_t count, const float* u, const float* v, std::uint32_t* hits) {
        std::size_t found = 0;
        for (std::size_t k = 0; k < count; ++k) {
            if (blocked(double(u[k]), double(v[k]))) hits[found++] = static_cast<std::uint32_t>(k);
        }
        return found;
    };
}

struct Moments {
    double area = 0, u = 0, v = 0;
};

Moments moments(const BorderGrid::Result& result) {
    Moments sum;
    for (const BorderGrid::Piece& piece : result.pieces) {
        sum.area += double(piece.area);
        sum.u += double(piece.area) * double(piece.u);
        sum.v += double(piece.area) * double(piece.v);
    }
    return sum;
}

BorderGrid::Result measured(BorderGrid& grid, const Shape& blocked, double width = 1.0 / 64) {
    const BorderGrid::Ask ask = asking(blocked);
    grid.start(ask);
    grid.cut_mixed(2, ask);
    grid.place(width, ask);
    BorderGrid::Result result;
    grid.collect(1, result);
    return result;
}

Shape disk(double u, double v, double r) {
    return [=](double x, double y) { return std::hypot(x - u, y - v) < r; };
}

TEST(BorderGrid, HalfPlanesHaveTheAreaThatTheirPlacesAreKnownTo) {
    BorderGrid grid(4, 4);
    for (const double angle : {0.0, 0.3, 0.7, 1.1, 2.0, 3.5, 5.9}) {
        const double c = std::cos(angle), s = std::sin(angle);
        // Through the centre, so that half is blocked.
        const auto half = [&](double x, double y) { return c * (x - 0.5) + s * (y - 0.5) < 1e-9; };
        const Moments sum = moments(measured(grid, half, 1.0 / 1024));
        // Edges are 1/16, places are in the middle of 1/1024 of them.
        EXPECT_NEAR(sum.area, 0.5, 4e-5) << angle;
        const double reach = 0.5 / std::max(std::abs(c), std::abs(s));
        EXPECT_LT(std::abs(sum.u / sum.area - 0.5) * c + std::abs(sum.v / sum.area - 0.5) * s,
                  reach);
    }
}

TEST(BorderGrid, CurvedBordersAreFlattenedAsSaid) {
    for (const int coarse : {4, 8, 16}) {
        BorderGrid grid(coarse, 3);
        const double r = 0.317, h = 1.0 / (4 * coarse);
        const Moments sum = moments(measured(grid, disk(0.43, 0.52, r)));
        const double flattened = h * h / (12 * r) * 2 * kPi * r;
        EXPECT_NEAR(sum.area, kPi * r * r - 0.6 * flattened, 0.6 * flattened) << coarse;
        EXPECT_NEAR(sum.u / sum.area, 0.43, 2e-3);
        EXPECT_NEAR(sum.v / sum.area, 0.52, 2e-3);
    }
}

TEST(BorderGrid, BlockedAndFreeAreTreatedAlike) {
    BorderGrid grid(8, 3);
    const Shape in = disk(0.5, 0.4, 0.23);
    const Moments a = moments(measured(grid, in));
    const Moments b = moments(measured(grid, [&](double x, double y) { return !in(x, y); }));
    EXPECT_NEAR(a.area + b.area, 1, 1e-6);
    EXPECT_NEAR(a.u + b.u, 0.5, 1e-5);
}

TEST(BorderGrid, BordersAreFollowedWhereNoNodeOfTheLatticeIs) {
    // A strip that only its end shows to the lattice: nodes at multiples of 1/8.
    const auto strip = [](double x, double y) {
        return x > 0.05 && x < 0.95 && std::abs(y - 0.56) < (x < 0.15 ? 0.07 : 0.03);
    };
    BorderGrid grid(4, 4);
    const double area = moments(measured(grid, strip)).area;
    EXPECT_NEAR(area, 0.1 * 0.14 + 0.8 * 0.06, 0.15 * 0.06);
}

TEST(BorderGrid, NoPointIsAskedForTwice) {
    std::set<std::pair<float, float>> points;
    std::size_t count = 0;
    const Shape shape = disk(0.4, 0.6, 0.3);
    const BorderGrid::Ask ask = [&](std::size_t n, const float* u, const float* v,
                                    std::uint32_t* hits) {
        for (std::size_t k = 0; k < n; ++k) points.emplace(u[k], v[k]);
        count += n;
        return asking(shape)(n, u, v, hits);
    };
    BorderGrid grid(5, 4);
    grid.start(ask);
    EXPECT_EQ(count, 121u);
    grid.cut_mixed(2, ask);
    grid.place(0.125, ask);
    EXPECT_EQ(grid.asked(), count);
    EXPECT_EQ(points.size(), count);
    // What halving found serves the next cut too.
    grid.cut_mixed(3, ask);
    grid.place(0.125, ask);
    EXPECT_EQ(points.size(), count);
    const std::size_t missing = grid.missing(3), before = count;
    grid.cut_all(3, ask);
    EXPECT_LE(count - before, missing);
    EXPECT_GT(count - before, missing / 2);
    EXPECT_EQ(grid.missing(3), 0u);
    EXPECT_EQ(points.size(), count);
}

TEST(BorderGrid, CuttingMoreComesNearer) {
    const auto flower = [](double x, double y) {
        const double a = std::atan2(y - 0.5, x - 0.5);
        return std::hypot(x - 0.5, y - 0.5) < 0.3 + 0.1 * std::cos(5 * a);
    };
    const double truth = kPi * (0.09 + 0.005);
    const BorderGrid::Ask ask = asking(flower);
    BorderGrid grid(4, 6);
    grid.start(ask);
    double before = 1;
    for (int level = 2; level <= 6; ++level) {
        grid.cut_mixed(level, ask);
        grid.place(1.0 / 64, ask);
        BorderGrid::Result result;
        grid.collect(1, result);
        const double error = std::abs(moments(result).area - truth);
        EXPECT_LT(error, before / 1.5) << level;
        before = error;
    }
    EXPECT_LT(before, 2e-5);
}

TEST(BorderGrid, VerticesAfterEachOtherDoNotMix) {
    BorderGrid used(2, 3), fresh(2, 3);
    // So often that their marks begin anew.
    for (int k = 0; k < 33000; ++k) used.start(asking(disk(0.3, 0.3, 0.4)));
    const BorderGrid::Result a = measured(used, disk(0.6, 0.55, 0.21));
    const BorderGrid::Result b = measured(fresh, disk(0.6, 0.55, 0.21));
    ASSERT_EQ(a.pieces.size(), b.pieces.size());
    for (std::size_t k = 0; k < a.pieces.size(); ++k) {
        EXPECT_EQ(a.pieces[k].area, b.pieces[k].area);
        EXPECT_EQ(a.pieces[k].u, b.pieces[k].u);
    }
}

TEST(BorderGrid, CountedNodesAndHiddenRunsStandForThinThings) {
    // Strips across the rows, thinner than the distance of nodes: one in four is met.
    const auto strips = [](double x, double) {
        const double phase = 13 * x - std::floor(13 * x);
        return phase < 0.13;
    };
    const BorderGrid::Ask ask = asking(strips);
    BorderGrid grid(8, 3);
    grid.start(ask);
    grid.cut_mixed(2, ask);
    grid.place(1.0 / 8, ask);
    BorderGrid::Result borders, counted;
    grid.collect(1, borders);
    grid.count_nodes(1, counted);
    double hidden = 0;
    for (const BorderGrid::Area& each : borders.hidden) hidden += double(each.area);
    // Both miss or find whole strips, of 0.06 of the square each.
    EXPECT_NEAR(moments(counted).area, 0.13, 0.07);
    EXPECT_GT(hidden, 0.02);
    // Straight borders hide nothing.
    EXPECT_TRUE(measured(grid, [](double x, double y) { return x + y < 0.9; }).hidden.size() < 3);
}

TEST(BorderGrid, AllAndNothing) {
    BorderGrid grid(7, 4);
    const BorderGrid::Result none = measured(grid, [](double, double) { return false; });
    EXPECT_TRUE(none.pieces.empty());
    EXPECT_EQ(grid.asked(), 225u);
    const BorderGrid::Result all = measured(grid, [](double, double) { return true; });
    EXPECT_NEAR(moments(all).area, 1, 1e-5);
    EXPECT_TRUE(all.doubts.empty() && all.bends.empty() && all.hidden.empty());
}

}  // namespace
}  // namespace airlight
