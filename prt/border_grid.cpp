// SPDX-License-Identifier: Apache-2.0
#include "prt/border_grid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace airlight {
namespace {

constexpr std::uint16_t kGenerations = 0x7fff;
std::size_t hash_of(int node, int axis) {
    const std::uint64_t key =
        static_cast<std::uint64_t>(node) * 2 + static_cast<std::uint64_t>(axis);
    return static_cast<std::size_t>(key * 0x9e3779b97f4a7c15u >> 40);
}

}  // namespace

BorderGrid::BorderGrid(int coarse, int levels)
    : coarse_(coarse), levels_(levels), side_(coarse << levels) {
    assert(coarse >= 1 && levels >= 1 && side_ <= 4096);
    const auto along = static_cast<std::size_t>(side_) + 1;
    marks_.assign(along * along, 0);
    queues_.resize(static_cast<std::size_t>(levels));
    slots_.assign(1024, -1);
}

void BorderGrid::mark(int n, bool value) {
    marks_[static_cast<std::size_t>(n)] =
        static_cast<std::uint16_t>(generation_ * 2 + (value ? 1 : 0));
}

// The answers at the corners, counter-clockwise; returns how many are blocked.
int BorderGrid::corners(const Cell& cell, bool* values) const {
    const int size = size_of(cell.level), x = cell.i * size, y = cell.j * size;
    int count = 0;
    for (int k = 0; k < 4; ++k) {
        values[k] = blocked(node(x + kCornerX[k] * size, y + kCornerY[k] * size));
        count += values[k] ? 1 : 0;
    }
    return count;
}

bool BorderGrid::mixed(const Cell& cell) const {
    bool values[4];
    return corners(cell, values) % 4 != 0;
}

// A cell is cut when its centre is known: nothing else asks for it.
bool BorderGrid::is_cut(const Cell& cell) const {
    if (cell.level >= levels_) return false;
    const int size = size_of(cell.level);
    return known(node(cell.i * size + size / 2, cell.j * size + size / 2));
}

void BorderGrid::want(int n) {
    if (known(n)) return;
    mark(n, false);
    wanted_.push_back(n);
}

// The middle of an edge, which its crossing may tell.
void BorderGrid::want_middle(int n, int axis, int length) {
    const int middle = n + length / 2 * step(axis);
    if (known(middle)) return;
    const Crossing* const crossing = find(n, axis, length);
    if (crossing && crossing->low >= 0.5f) {
        mark(middle, crossing->first);
    } else if (crossing && crossing->high <= 0.5f) {
        mark(middle, !crossing->first);
    } else {
        want(middle);
    }
}

void BorderGrid::ask_wanted(const Ask& ask) {
    const std::size_t count = wanted_.size();
    if (count == 0) return;
    const auto along = side_ + 1;
    const float unit = 1 / static_cast<float>(side_);
    u_.resize(count);
    v_.resize(count);
    hits_.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        u_[k] = static_cast<float>(wanted_[k] % along) * unit;
        v_[k] = static_cast<float>(wanted_[k] / along) * unit;
    }
    const std::size_t found = ask(count, u_.data(), v_.data(), hits_.data());
    for (std::size_t h = 0; h < found; ++h) mark(wanted_[hits_[h]], true);
    asked_ += count;
    wanted_.clear();
}

void BorderGrid::start(const Ask& ask) {
    if (++generation_ > kGenerations) {
        std::fill(marks_.begin(), marks_.end(), std::uint16_t{0});
        generation_ = 1;
    }
    asked_ = 0;
    crossings_.clear();
    std::fill(slots_.begin(), slots_.end(), -1);
    const int size = size_of(1);
    for (int y = 0; y <= side_; y += size) {
        for (int x = 0; x <= side_; x += size) want(node(x, y));
    }
    ask_wanted(ask);
}

std::size_t BorderGrid::missing(int level) const {
    const int size = size_of(level);
    std::size_t count = 0;
    for (int y = 0; y <= side_; y += size) {
        for (int x = 0; x <= side_; x += size) count += known(node(x, y)) ? 0 : 1;
    }
    return count;
}

// Cuts what is queued on levels below `below`, coarse cells first, and what follows from it.
void BorderGrid::cut_queued(int below, const Ask& ask) {
    for (;;) {
        std::size_t level = 0;
        while (level < queues_.size() && queues_[level].empty()) ++level;
        if (level == queues_.size()) return;
        now_.clear();
        std::swap(now_, queues_[level]);
        const int size = size_of(static_cast<int>(level)), half = size / 2;
        for (const Cell& cell : now_) {
            const int n = node(cell.i * size, cell.j * size);
            want(n + half * step(0) + half * step(1));
            want_middle(n, 0, size);
            want_middle(n, 1, size);
            want_middle(n + size * step(1), 0, size);
            want_middle(n + size * step(0), 1, size);
        }
        ask_wanted(ask);
        for (const Cell& cell : now_) {
            if (cell.level + 1 < below) {
                for (int k = 0; k < 4; ++k) {
                    const Cell quarter = {cell.level + 1, 2 * cell.i + kCornerX[k],
                                          2 * cell.j + kCornerY[k]};
                    if (mixed(quarter) && !is_cut(quarter)) {
                        queues_[static_cast<std::size_t>(quarter.level)].push_back(quarter);
                    }
                }
            }
            const int n = node(cell.i * size, cell.j * size);
            const auto odd = [&](int first, int axis) {
                const bool value = blocked(first);
                return blocked(first + size * step(axis)) == value &&
                       blocked(first + half * step(axis)) != value;
            };
            if (odd(n, 0)) follow(cell, 0, -1);
            if (odd(n, 1)) follow(cell, -1, 0);
            if (odd(n + size * step(1), 0)) follow(cell, 0, 1);
            if (odd(n + size * step(0), 1)) follow(cell, 1, 0);
        }
    }
}

// Queues the smallest cell over the neighbour, unless the neighbour is cut already.
void BorderGrid::follow(const Cell& from, int di, int dj) {
    const int i = from.i + di, j = from.j + dj, along = cells_along(from.level);
    if (i < 0 || j < 0 || i >= along || j >= along) return;
    for (int level = 0; level <= from.level; ++level) {
        const int up = from.level - level;
        const Cell over = {level, i >> up, j >> up};
        if (is_cut(over)) continue;
        queues_[static_cast<std::size_t>(level)].push_back(over);
        return;
    }
}

void BorderGrid::cut_all(int level, const Ask& ask) {
    for (int k = 1; k < level; ++k) {
        for (int j = 0; j < cells_along(k); ++j) {
            for (int i = 0; i < cells_along(k); ++i) {
                if (!is_cut({k, i, j})) queues_[static_cast<std::size_t>(k)].push_back({k, i, j});
            }
        }
        cut_queued(k + 1, ask);
    }
}

void BorderGrid::cut_mixed(int level, const Ask& ask) {
    for (int k = 1; k < level; ++k) {
        // Cells of this level exist where the one above is cut.
        for (int j = 0; j < cells_along(k); ++j) {
            for (int i = 0; i < cells_along(k); ++i) {
                if (k > 1 && !is_cut({k - 1, i >> 1, j >> 1})) continue;
                const Cell cell = {k, i, j};
                if (mixed(cell) && !is_cut(cell)) {
                    queues_[static_cast<std::size_t>(k)].push_back(cell);
                }
            }
        }
        cut_queued(level, ask);
    }
}

std::size_t BorderGrid::count_mixed(int level) const {
    std::size_t count = 0;
    for (int k = 1; k < level; ++k) {
        for (int j = 0; j < cells_along(k); ++j) {
            for (int i = 0; i < cells_along(k); ++i) {
                if (k > 1 && !is_cut({k - 1, i >> 1, j >> 1})) continue;
                const Cell cell = {k, i, j};
                count += mixed(cell) && !is_cut(cell) ? 1 : 0;
            }
        }
    }
    return count;
}

// The smallest part of an edge between nodes that differ, as far as nodes are known: first node and
// length.
std::pair<int, int> BorderGrid::shortest(int n, int axis, int length) const {
    while (length > 1) {
        const int half = length / 2, middle = n + half * step(axis);
        if (!known(middle)) break;
        if (blocked(middle) == blocked(n)) n = middle;
        length = half;
    }
    return {n, length};
}

const BorderGrid::Crossing* BorderGrid::find(int n, int axis, int length) const {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = hash_of(n, axis) & mask; slots_[slot] >= 0; slot = (slot + 1) & mask) {
        const Crossing& crossing = crossings_[static_cast<std::size_t>(slots_[slot])];
        if (crossing.node == n && crossing.axis == axis && crossing.length == length) {
            return &crossing;
        }
    }
    return nullptr;
}

// Its halves have taken its place.
bool BorderGrid::is_halved(const Crossing& c) const {
    return c.length > 1 && known(c.node + c.length / 2 * step(c.axis));
}

void BorderGrid::add_crossing(int n, int axis, int length) {
    const auto [first, part] = shortest(n, axis, length);
    if (find(first, axis, part)) return;
    Crossing crossing = {first, axis, part, blocked(first), 0, 1};
    // What is known of the edge that this one is half of.
    const int along = axis == 0 ? first % (side_ + 1) : first / (side_ + 1);
    const bool second = along / part % 2 != 0;
    if (const Crossing* whole = find(second ? first - part * step(axis) : first, axis, 2 * part)) {
        const float shift = second ? 1 : 0;
        crossing.low = std::max(0.0f, 2 * whole->low - shift);
        crossing.high = std::min(1.0f, 2 * whole->high - shift);
    }
    if (2 * (crossings_.size() + 1) > slots_.size()) {
        slots_.assign(2 * slots_.size(), -1);
        const std::size_t mask = slots_.size() - 1;
        for (std::size_t k = 0; k < crossings_.size(); ++k) {
            std::size_t slot = hash_of(crossings_[k].node, crossings_[k].axis) & mask;
            while (slots_[slot] >= 0) slot = (slot + 1) & mask;
            slots_[slot] = static_cast<std::int32_t>(k);
        }
    }
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash_of(first, axis) & mask;
    while (slots_[slot] >= 0) slot = (slot + 1) & mask;
    slots_[slot] = static_cast<std::int32_t>(crossings_.size());
    crossings_.push_back(crossing);
}

void BorderGrid::find_crossings(const Cell& cell) {
    if (is_cut(cell)) {
        for (int k = 0; k < 4; ++k) {
            find_crossings({cell.level + 1, 2 * cell.i + kCornerX[k], 2 * cell.j + kCornerY[k]});
        }
        return;
    }
    bool values[4];
    if (corners(cell, values) % 4 == 0) return;
    const int size = size_of(cell.level), n = node(cell.i * size, cell.j * size);
    if (values[0] != values[1]) add_crossing(n, 0, size);
    if (values[1] != values[2]) add_crossing(n + size * step(0), 1, size);
    if (values[3] != values[2]) add_crossing(n + size * step(1), 0, size);
    if (values[0] != values[3]) add_crossing(n, 1, size);
}

void BorderGrid::place(double width, const Ask& ask) {
    for (int j = 0; j < coarse_; ++j) {
        for (int i = 0; i < coarse_; ++i) find_crossings({0, i, j});
    }
    const auto along = side_ + 1;
    const float unit = 1 / static_cast<float>(side_), enough = static_cast<float>(width);
    for (;;) {
        wanted_.clear();
        u_.clear();
        v_.clear();
        for (std::size_t k = 0; k < crossings_.size(); ++k) {
            const Crossing& c = crossings_[k];
            if (c.high - c.low <= enough || is_halved(c)) continue;
            const float way = 0.5f * (c.low + c.high) * static_cast<float>(c.length);
            wanted_.push_back(static_cast<int>(k));
            u_.push_back((static_cast<float>(c.node % along) + (c.axis == 0 ? way : 0)) * unit);
            v_.push_back((static_cast<float>(c.node / along) + (c.axis == 1 ? way : 0)) * unit);
        }
        const std::size_t count = wanted_.size();
        if (count == 0) return;
        hits_.resize(count);
        const std::size_t found = ask(count, u_.data(), v_.data(), hits_.data());
        asked_ += count;
        for (std::size_t k = 0, h = 0; k < count; ++k) {
            Crossing& c = crossings_[static_cast<std::size_t>(wanted_[k])];
            const bool value = h < found && hits_[h] == k;
            h += value ? 1 : 0;
            (value == c.first ? c.low : c.high) = 0.5f * (c.low + c.high);
        }
        wanted_.clear();
    }
}

}  // namespace airlight
