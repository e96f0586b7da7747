// SPDX-License-Identifier: Apache-2.0
#include "cli/plot_labels.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace airlight {
namespace {

constexpr double kLineHeight = 15;
constexpr double kLeaderFrom = 18;

bool overlap(const PlotBox& a, const PlotBox& b) {
    return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

// The box whose nearest point to (x, y) lies at `distance` towards (dx, dy), each -1, 0 or 1.
PlotBox box_at(double x, double y, int dx, int dy, double distance, double width) {
    const double reach = dx != 0 && dy != 0 ? 0.75 * distance : distance;
    const double left = dx > 0 ? x + reach : dx < 0 ? x - reach - width : x - 0.5 * width;
    const double top = dy > 0   ? y + reach - 3
                       : dy < 0 ? y - reach - kLineHeight + 3
                                : y - 0.5 * kLineHeight;
    return {left, top, left + width, top + kLineHeight};
}

}  // namespace

double label_width(const std::string& text) {
    double width = 0;
    for (const char c : text) {
        // The second and later bytes of a UTF-8 character take no room.
        if ((static_cast<unsigned char>(c) & 0xc0) == 0x80) continue;
        const bool narrow = c == ' ' || c == '.' || c == ',' || c == 'i' || c == 'l' || c == '-';
        width += kLabelSize * (narrow ? 0.37 : 0.62);
    }
    return width;
}

void LabelPlacer::avoid_marker(double x, double y, double radius) {
    markers_.push_back({x - radius, y - radius, x + radius, y + radius});
}

void LabelPlacer::avoid_segment(double x0, double y0, double x1, double y1) {
    segments_.push_back({x0, y0, x1, y1});
}

double LabelPlacer::cost(const PlotBox& box, const PlacedPoint& point) const {
    double cost = 0;
    if (box.left < frame_.left || box.right > frame_.right || box.top < frame_.top ||
        box.bottom > frame_.bottom) {
        cost += 1000;
    }
    for (const PlotBox& label : labels_) cost += overlap(box, label) ? 300 : 0;
    for (const PlotBox& marker : markers_) cost += overlap(box, marker) ? 100 : 0;
    for (const Segment& s : segments_) {
        // Twenty points on the segment are close enough together to find a box of text.
        bool hit = false;
        for (int i = 0; i <= 20 && !hit; ++i) {
            const double x = s.x0 + (s.x1 - s.x0) * i / 20, y = s.y0 + (s.y1 - s.y0) * i / 20;
            hit = x > box.left && x < box.right && y > box.top && y < box.bottom;
        }
        cost += hit ? 40 : 0;
    }
    // A stranger's marker nearby makes the label ambiguous.
    const PlotBox around = {box.left - 8, box.top - 4, box.right + 8, box.bottom + 4};
    for (const PlotBox& marker : markers_) {
        const bool own = point.x > marker.left && point.x < marker.right && point.y > marker.top &&
                         point.y < marker.bottom;
        cost += !own && overlap(around, marker) ? 5 : 0;
    }
    return cost;
}

PlacedLabel LabelPlacer::place(const PlacedPoint& point) {
    constexpr int kDirections[8][2] = {{1, 0},  {-1, 0},  {1, -1}, {1, 1},
                                       {-1, 1}, {-1, -1}, {0, -1}, {0, 1}};
    const double width = label_width(point.label);
    PlacedLabel best;
    double least = std::numeric_limits<double>::infinity();
    for (const double distance : {9.0, 18.0, 30.0, 46.0}) {
        for (std::size_t i = 0; i < 8; ++i) {
            const PlotBox box =
                box_at(point.x, point.y, kDirections[i][0], kDirections[i][1], distance, width);
            const double price =
                cost(box, point) + 0.5 * (distance - 9) + 0.5 * static_cast<double>(i);
            if (price >= least) continue;
            least = price;
            best.box = box;
            best.leader = distance >= kLeaderFrom;
        }
    }
    best.leader_x = std::clamp(point.x, best.box.left, best.box.right);
    best.leader_y = std::clamp(point.y, best.box.top + 2, best.box.bottom - 2);
    labels_.push_back(best.box);
    return best;
}

}  // namespace airlight
