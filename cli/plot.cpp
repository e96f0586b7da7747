// SPDX-License-Identifier: Apache-2.0
#include "cli/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "cli/plot_labels.h"

namespace airlight {
namespace {

constexpr double kWidth = 820, kHeight = 540;
constexpr PlotBox kFrame = {84, 92, 792, 478};
constexpr double kRadius = 4.5;
constexpr const char* kInk = "#222222";

bool shown(const PlotPoint& point) {
    return point.x > 0 && point.y > 0 && std::isfinite(point.x) && std::isfinite(point.y);
}

/// A logarithmic axis: the decimal logarithms of its ends, and where those lie on the page.
struct Scale {
    double low = 0, high = 1;
    double from = 0, to = 1;

    double operator()(double value) const {
        return from + (to - from) * (std::log10(value) - low) / (high - low);
    }
};

template <class Lowest, class Highest>
Scale make_scale(const Plot& plot, const Lowest& lowest, const Highest& highest, double from,
                 double to) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& point : series.points) {
            if (!shown(point)) continue;
            low = std::min(low, std::log10(lowest(point)));
            high = std::max(high, std::log10(highest(point)));
        }
    }
    if (low > high) low = 0, high = 1;
    // Room for markers and labels; at least an eighth of a decade.
    const double margin = std::max(0.07 * (high - low), 0.125);
    return {low - margin, high + margin, from, to};
}

std::string power_of_ten(int exponent) {
    if (exponent >= -2 && exponent <= 4) return fmt::format("{:g}", std::pow(10.0, exponent));
    return fmt::format("10<tspan dy=\"-5\" font-size=\"9\">{}{}</tspan>", exponent < 0 ? "−" : "",
                       std::abs(exponent));
}

/// Labels of ticks are SVG text already.
std::vector<PlotTick> make_ticks(const PlotAxis& axis, const Scale& scale) {
    std::vector<PlotTick> ticks;
    for (const PlotTick& tick : axis.ticks) {
        ticks.push_back({tick.value, xml_escaped(tick.label)});
    }
    if (!ticks.empty()) return ticks;
    const double span = scale.high - scale.low;
    const int step = std::max(1, static_cast<int>(std::ceil(span / 12)));
    const int first = static_cast<int>(std::floor(scale.low));
    for (int exponent = first; exponent <= scale.high; ++exponent) {
        const double decade = std::pow(10.0, exponent);
        if (exponent % step == 0) ticks.push_back({decade, power_of_ten(exponent)});
        if (span > 2.5) continue;
        for (const int digit : {2, 5}) {
            ticks.push_back({digit * decade, short_number(digit * decade)});
        }
    }
    ticks.erase(std::remove_if(ticks.begin(), ticks.end(),
                               [&](const PlotTick& tick) {
                                   const double at = std::log10(tick.value);
                                   return at < scale.low || at > scale.high;
                               }),
                ticks.end());
    return ticks;
}

void text(std::string& svg, double x, double y, const char* anchor, double size,
          const std::string& content, const std::string& more = {}) {
    fmt::format_to(std::back_inserter(svg),
                   "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{:g}\"{}>"
                   "{}</text>\n",
                   x, y, anchor, size, more, content);
}

void line(std::string& svg, double x0, double y0, double x1, double y1, const char* style) {
    fmt::format_to(std::back_inserter(svg),
                   "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x0, y0,
                   x1, y1, style);
}

void marker(std::string& svg, double x, double y, const std::string& colour, bool hollow) {
    fmt::format_to(std::back_inserter(svg),
                   "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:g}\" fill=\"{}\" stroke=\"{}\" "
                   "stroke-width=\"1.6\"/>\n",
                   x, y, kRadius, hollow ? "#ffffff" : colour, colour);
}

void bar(std::string& svg, double x, double y, double end, const std::string& colour) {
    fmt::format_to(std::back_inserter(svg),
                   "<path d=\"M{0:.1f} {1:.1f} V{2:.1f} M{3:.1f} {2:.1f} H{4:.1f}\" fill=\"none\" "
                   "stroke=\"{5}\" stroke-width=\"1.2\" stroke-opacity=\"0.55\"/>\n",
                   x, y, end, x - 3.5, x + 3.5, colour);
}

void draw_axes(std::string& svg, const Plot& plot, const Scale& x, const Scale& y) {
    constexpr const char* kGrid = "stroke=\"#e2e2e2\" stroke-width=\"1\"";
    for (const PlotTick& tick : make_ticks(plot.x, x)) {
        const double at = x(tick.value);
        line(svg, at, kFrame.top, at, kFrame.bottom, kGrid);
        text(svg, at, kFrame.bottom + 18, "middle", 12, tick.label);
    }
    for (const PlotTick& tick : make_ticks(plot.y, y)) {
        const double at = y(tick.value);
        line(svg, kFrame.left, at, kFrame.right, at, kGrid);
        text(svg, kFrame.left - 8, at + 4, "end", 12, tick.label);
    }
    fmt::format_to(std::back_inserter(svg),
                   "<rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" fill=\"none\" "
                   "stroke=\"#888888\"/>\n",
                   kFrame.left, kFrame.top, kFrame.right - kFrame.left, kFrame.bottom - kFrame.top);
    text(svg, 0.5 * (kFrame.left + kFrame.right), kHeight - 18, "middle", 13,
         xml_escaped(plot.x.label));
    const double middle = 0.5 * (kFrame.top + kFrame.bottom);
    text(svg, 22, middle, "middle", 13, xml_escaped(plot.y.label),
         fmt::format(" transform=\"rotate(-90 22 {:.1f})\"", middle));
}

void draw_legend(std::string& svg, const Plot& plot) {
    double x = kFrame.left + 6;
    const double y = kFrame.top - 17;
    for (const PlotSeries& series : plot.series) {
        if (series.name.empty()) continue;
        if (series.connected) {
            const std::string style =
                fmt::format("stroke=\"{}\" stroke-width=\"2\"", series.colour);
            line(svg, x - 6, y, x + 18, y, style.c_str());
        }
        const bool hollow = !series.points.empty() && series.points[0].hollow;
        marker(svg, x + 6, y, series.colour, hollow);
        text(svg, x + 23, y + 4, "start", 12, xml_escaped(series.name));
        x += 23 + label_width(series.name) + 22;
    }
}

std::string without_trailing_zeros(std::string number) {
    if (number.find('.') == std::string::npos) return number;
    number.erase(number.find_last_not_of('0') + 1);
    if (number.back() == '.') number.pop_back();
    return number;
}

}  // namespace

std::string xml_escaped(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            default:
                escaped += c;
        }
    }
    return escaped;
}

std::string short_number(double value, int digits) {
    const double size = std::abs(value);
    if (value == 0 || (size >= 1e-2 && size < 1e5)) {
        // As many decimals as the digits need, without an exponent for 210 or 21000.
        const int exponent = value == 0 ? 0 : static_cast<int>(std::floor(std::log10(size)));
        return without_trailing_zeros(
            fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent)));
    }
    const std::string text = fmt::format("{:.{}e}", value, digits - 1);
    const std::size_t e = text.find('e');
    if (e == std::string::npos) return text;
    return fmt::format("{}e{}", without_trailing_zeros(text.substr(0, e)),
                       std::stoi(text.substr(e + 1)));
}

std::string to_svg(const Plot& plot) {
    const auto x_of = [](const PlotPoint& point) { return point.x; };
    const auto y_of = [](const PlotPoint& point) { return point.y; };
    const auto bar_end = [](const PlotPoint& point) {
        return point.y_typical > 0 ? std::min(point.y, point.y_typical) : point.y;
    };
    const Scale x = make_scale(plot, x_of, x_of, kFrame.left, kFrame.right);
    const Scale y = make_scale(plot, bar_end, y_of, kFrame.bottom, kFrame.top);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
        "height=\"{1:g}\" font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" "
        "fill=\"{2}\">\n<title>{3}</title>\n<rect width=\"{0:g}\" height=\"{1:g}\" "
        "fill=\"#ffffff\"/>\n",
        kWidth, kHeight, kInk, xml_escaped(plot.title));
    text(svg, kFrame.left - 6, 28, "start", 17, xml_escaped(plot.title), " font-weight=\"bold\"");
    text(svg, kFrame.left - 6, 49, "start", 12.5, xml_escaped(plot.subtitle), " fill=\"#555555\"");
    draw_axes(svg, plot, x, y);
    draw_legend(svg, plot);

    LabelPlacer placer(kFrame);
    std::string markers;
    std::vector<PlacedPoint> labelled;
    for (const PlotSeries& series : plot.series) {
        std::string path;
        PlacedPoint previous;
        for (const PlotPoint& point : series.points) {
            if (!shown(point)) continue;
            const PlacedPoint place = {x(point.x), y(point.y), point.label};
            if (point.y_typical > 0) {
                const double end = y(point.y_typical);
                bar(svg, place.x, place.y, end, series.colour);
                placer.avoid_segment(place.x, place.y, place.x, end);
            }
            marker(markers, place.x, place.y, series.colour, point.hollow);
            placer.avoid_marker(place.x, place.y, kRadius + 1);
            if (series.connected && !path.empty()) {
                placer.avoid_segment(previous.x, previous.y, place.x, place.y);
            }
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", place.x, place.y);
            if (!point.label.empty()) labelled.push_back(place);
            previous = place;
        }
        if (!series.connected || path.empty()) continue;
        fmt::format_to(std::back_inserter(svg),
                       "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\" "
                       "stroke-opacity=\"0.7\"/>\n",
                       path, series.colour);
    }
    std::string labels;
    for (const PlacedPoint& point : labelled) {
        const PlacedLabel label = placer.place(point);
        if (label.leader) {
            line(svg, point.x, point.y, label.leader_x, label.leader_y,
                 "stroke=\"#999999\" stroke-width=\"0.8\"");
        }
        text(labels, label.box.left, label.box.bottom - 3.5, "start", kLabelSize,
             xml_escaped(point.label));
    }
    return svg + markers + labels + "</svg>\n";
}

}  // namespace airlight
