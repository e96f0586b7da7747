// SPDX-License-Identifier: Apache-2.0
// Where the labels of a plot's points go, so that they stay readable.
#pragma once

#include <string>
#include <vector>

namespace airlight {

/// A rectangle on the page, y downwards.
struct PlotBox {
    double left = 0, top = 0, right = 0, bottom = 0;
};

inline constexpr double kLabelSize = 12;

/// About the width of a label in a sans-serif font of kLabelSize, wide ones included.
double label_width(const std::string& text);

struct PlacedPoint {
    double x = 0, y = 0;
    std::string label = {};
};

struct PlacedLabel {
    PlotBox box;
    bool leader = false;  ///< so far away that a line should lead there, to leader_x, leader_y
    double leader_x = 0, leader_y = 0;
};

/// Puts labels beside their points one after the other, each at the place of eight directions and
/// four distances that covers least of what is there already: labels, then markers, then lines.
class LabelPlacer {
  public:
    explicit LabelPlacer(const PlotBox& frame) : frame_(frame) {}

    void avoid_marker(double x, double y, double radius);
    void avoid_segment(double x0, double y0, double x1, double y1);
    PlacedLabel place(const PlacedPoint& point);

  private:
    struct Segment {
        double x0, y0, x1, y1;
    };
    double cost(const PlotBox& box, const PlacedPoint& point) const;

    PlotBox frame_;
    std::vector<PlotBox> markers_, labels_;
    std::vector<Segment> segments_;
};

}  // namespace airlight
