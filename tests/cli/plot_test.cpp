// SPDX-License-Identifier: Apache-2.0
#include "cli/plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "cli/plot_labels.h"

namespace airlight {
namespace {

bool overlap(const PlotBox& a, const PlotBox& b) {
    return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

TEST(Plot, LabelsStayInTheFrameAndOffEachOtherAndThePoints) {
    const PlotBox frame = {0, 0, 700, 380};
    std::mt19937 random(5);
    for (int round = 0; round < 200; ++round) {
        LabelPlacer placer(frame);
        std::vector<PlacedPoint> points;
        // A dozen points, as on a ladder: some anywhere, edges included, some close together.
        for (int i = 0; i < 12; ++i) {
            const double x = (random() % 1000) / 999.0, y = (random() % 1000) / 999.0;
            const std::string label = "sinh-gl" + std::to_string(i);
            if (i % 4 == 0) {
                points.push_back({300 + 80 * x, 160 + 60 * y, label});
            } else {
                points.push_back({8 + 684 * x, 8 + 364 * y, label});
            }
            placer.avoid_marker(points.back().x, points.back().y, 5);
        }
        std::vector<PlotBox> boxes;
        for (const PlacedPoint& point : points) {
            const PlotBox box = placer.place(point).box;
            EXPECT_NEAR(box.right - box.left, label_width(point.label), 1e-9);
            EXPECT_GE(box.left, frame.left);
            EXPECT_LE(box.right, frame.right);
            EXPECT_GE(box.top, frame.top);
            EXPECT_LE(box.bottom, frame.bottom);
            for (const PlotBox& other : boxes) EXPECT_FALSE(overlap(box, other)) << round;
            for (const PlacedPoint& other : points) {
                EXPECT_FALSE(other.x > box.left && other.x < box.right && other.y > box.top &&
                             other.y < box.bottom)
                    << round;
            }
            boxes.push_back(box);
        }
    }
}

TEST(Plot, PointsWithoutALogarithmAreLeftOutAndTextIsEscaped) {
    const double infinity = std::numeric_limits<double>::infinity();
    Plot plot;
    plot.title = "a < b & c";
    plot.series = {{"all", kPlotColours[0], true, {}}};
    for (const double bad : {0.0, -1.0, infinity, std::nan("")}) {
        plot.series[0].points.push_back({bad, 1, "bad"});
        plot.series[0].points.push_back({1, bad, "bad"});
    }
    EXPECT_EQ(to_svg(plot).find("bad"), std::string::npos);
    plot.series[0].points.push_back({10, 1e-3, "good"});
    const std::string svg = to_svg(plot);
    EXPECT_NE(svg.find(">good</text>"), std::string::npos);
    EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
    for (const char* word : {"bad", "nan", "inf"}) EXPECT_EQ(svg.find(word), std::string::npos);
    EXPECT_EQ(svg, to_svg(plot));
}

TEST(Plot, NumbersAreShort) {
    EXPECT_EQ(short_number(0), "0");
    EXPECT_EQ(short_number(3.2e-5), "3.2e-5");
    EXPECT_EQ(short_number(1e-3), "1e-3");
    EXPECT_EQ(short_number(0.047), "0.047");
    EXPECT_EQ(short_number(20), "20");
    EXPECT_EQ(short_number(0.5), "0.5");
    EXPECT_EQ(short_number(3.64e9, 3), "3.64e9");
    EXPECT_EQ(short_number(1234.5, 3), "1234");
    EXPECT_EQ(short_number(-2.5e-12), "-2.5e-12");
}

}  // namespace
}  // namespace airlight
