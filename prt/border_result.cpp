// SPDX-License-Identifier: Apache-2.0
// What the answers at nodes and the places on edges amount to.
#include <algorithm>
#include <cmath>

#include "prt/border_grid.h"

namespace airlight {

// Where the border crosses an edge between nodes that differ, as a part of its length.
double BorderGrid::position(int n, int axis, int length) const {
    const auto [first, part] = shortest(n, axis, length);
    const Crossing* const crossing = find(first, axis, part);
    const double inside = crossing ? 0.5 * (double(crossing->low) + crossing->high) : 0.5;
    return ((first - n) / step(axis) + inside * part) / length;
}

// The part of a cell that is blocked as its corners and its edges have it, and its centroid in the
// cell.
double BorderGrid::part(const Cell& cell, double* u, double* v) const {
    bool values[4];
    const int count = corners(cell, values);
    *u = *v = 0.5;
    if (count % 4 == 0) return count / 4;
    if (count == 2 && values[0] == values[2]) return 0.5;
    const int size = size_of(cell.level), n = node(cell.i * size, cell.j * size);
    double x[6], y[6];
    int points = 0;
    for (int k = 0; k < 4; ++k) {
        const int next = (k + 1) % 4;
        if (values[k]) {
            x[points] = kCornerX[k];
            y[points++] = kCornerY[k];
        }
        if (values[k] == values[next]) continue;
        const double way = k == 0   ? position(n, 0, size)
                           : k == 1 ? position(n + size * step(0), 1, size)
                           : k == 2 ? 1 - position(n + size * step(1), 0, size)
                                    : 1 - position(n, 1, size);
        x[points] = kCornerX[k] + way * (kCornerX[next] - kCornerX[k]);
        y[points++] = kCornerY[k] + way * (kCornerY[next] - kCornerY[k]);
    }
    double twice = 0, mu = 0, mv = 0;
    for (int k = 0; k < points; ++k) {
        const int next = (k + 1) % points;
        const double w = x[k] * y[next] - x[next] * y[k];
        twice += w;
        mu += w * (x[k] + x[next]);
        mv += w * (y[k] + y[next]);
    }
    if (!(twice > 1e-9)) return 0;
    *u = mu / (3 * twice);
    *v = mv / (3 * twice);
    return 0.5 * twice;
}

void BorderGrid::Result::clear() {
    pieces.clear();
    doubts.clear();
    bends.clear();
    hidden.clear();
}

BorderGrid::Area BorderGrid::area_at(double x, double y, double area) const {
    const double unit = 1.0 / side_;
    return {static_cast<float>(x * unit), static_cast<float>(y * unit),
            static_cast<float>(area * unit * unit)};
}

// The blocked part of a cell.
double BorderGrid::visit(const Cell& cell, Result& result) const {
    const double size = size_of(cell.level), x = cell.i * size, y = cell.j * size;
    double u = 0.5, v = 0.5;
    const auto add_piece = [&](double inside, bool whole) {
        const Area area = area_at(x + u * size, y + v * size, inside * size * size);
        result.pieces.push_back(
            {area.u, area.v, area.area, static_cast<std::uint8_t>(cell.level), whole});
    };
    if (!is_cut(cell)) {
        const double inside = part(cell, &u, &v);
        if (inside > 0) add_piece(inside, inside == 1);
        return inside;
    }
    const std::size_t pieces = result.pieces.size();
    double inside = 0;
    bool last = true;
    for (int k = 0; k < 4; ++k) {
        const Cell quarter = {cell.level + 1, 2 * cell.i + kCornerX[k], 2 * cell.j + kCornerY[k]};
        last = last && !is_cut(quarter);
        inside += 0.25 * visit(quarter, result);
    }
    const bool is_mixed = mixed(cell);
    if (inside == 1 && !is_mixed) {
        result.pieces.resize(pieces);
        add_piece(1, true);
    }
    if (is_mixed && last) {
        const double bend = inside - part(cell, &u, &v);
        if (bend != 0) {
            result.bends.push_back(area_at(x + 0.5 * size, y + 0.5 * size, bend * size * size));
        }
    }
    return inside;
}

void BorderGrid::collect_hidden(int level, Result& result) const {
    const int size = size_of(level);
    for (int axis = 0; axis < 2; ++axis) {
        const int before = -size * step(axis), after = size * step(axis);
        for (int across = 0; across <= side_; across += size) {
            for (int along = size; along < side_; along += size) {
                const int x = axis == 0 ? along : across, y = axis == 0 ? across : along;
                const int n = node(x, y);
                const bool value = blocked(n);
                if (blocked(n + before) == value || blocked(n + after) == value) continue;
                const double run = 1 - position(n + before, axis, size) + position(n, axis, size);
                if (run >= 0.75) continue;
                const double missed = (1 - run) * size * size;
                result.hidden.push_back(area_at(x, y, value ? missed : -missed));
            }
        }
    }
}

void BorderGrid::collect(int finished, Result& result) const {
    result.clear();
    for (int j = 0; j < coarse_; ++j) {
        for (int i = 0; i < coarse_; ++i) visit({0, i, j}, result);
    }
    for (const Crossing& c : crossings_) {
        if (is_halved(c)) continue;
        const double way = 0.5 * (double(c.low) + c.high) * c.length;
        const double doubt = double(c.length) * c.length * (double(c.high) - c.low);
        const int along = side_ + 1;
        result.doubts.push_back(area_at(c.node % along + (c.axis == 0 ? way : 0),
                                        c.node / along + (c.axis == 1 ? way : 0),
                                        doubt * std::sqrt(1.0 / 12)));
    }
    collect_hidden(finished, result);
}

void BorderGrid::count_nodes(int level, Result& result) const {
    result.clear();
    const int size = size_of(level);
    const double area = double(size) * size;
    for (int y = 0; y <= side_; y += size) {
        for (int x = 0; x <= side_; x += size) {
            const int n = node(x, y);
            const bool value = blocked(n), right = x < side_, down = y < side_;
            if (value) {
                const double part = (x == 0 || !right ? 0.5 : 1.0) * (y == 0 || !down ? 0.5 : 1.0);
                const Area cell = area_at(x, y, part * area);
                result.pieces.push_back(
                    {cell.u, cell.v, cell.area, static_cast<std::uint8_t>(level), false});
            }
            if (right && blocked(n + size * step(0)) != value) {
                result.doubts.push_back(area_at(x + 0.5 * size, y, area));
            }
            if (down && blocked(n + size * step(1)) != value) {
                result.doubts.push_back(area_at(x, y + 0.5 * size, area));
            }
        }
    }
}

}  // namespace airlight
