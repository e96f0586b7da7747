// SPDX-License-Identifier: Apache-2.0
// Plots with two logarithmic axes, as SVG.
#pragma once

#include <string>
#include <vector>

namespace airlight {

struct PlotPoint {
    double x = 0;  ///< > 0; points that are not finite or not positive are left out
    double y = 0;
    std::string label = {};  ///< beside the point; empty for none
    bool hollow = false;
    double y_typical = 0;  ///< > 0: a bar leads there from the point
};

struct PlotSeries {
    std::string name;        ///< in the legend; empty for none
    std::string colour;      ///< as SVG takes it, "#0072b2"
    bool connected = false;  ///< a line through the points, in their order
    std::vector<PlotPoint> points;
};

struct PlotTick {
    double value = 0;
    std::string label;
};

struct PlotAxis {
    std::string label;
    std::vector<PlotTick> ticks = {};  ///< empty: decades, or 1, 2, 5 on a short axis
};

struct Plot {
    std::string title;
    std::string subtitle;
    PlotAxis x, y;
    std::vector<PlotSeries> series;
};

/// Colours that people of any colour vision tell apart and that stand on white.
inline constexpr const char* kPlotColours[] = {"#0072b2", "#d55e00", "#009e73",
                                               "#aa4499", "#b8860b", "#555555"};

/// A picture of 820 x 540 units without scripts, fonts or other resources. Labels are put where
/// they meet no point, line or other label, as far as there is room. Equal plots give equal text.
std::string to_svg(const Plot& plot);

/// Text for the inside of an XML element or attribute.
std::string xml_escaped(const std::string& text);

/// A number for people with that many significant digits, "3.2e-5", "0.047", "210".
std::string short_number(double value, int digits = 2);

}  // namespace airlight
