// SPDX-License-Identifier: Apache-2.0
// The part of the unit square where a function of two values, blocked or not, is blocked.
//
// The square is cut into cells, 2^level · coarse of them along a side. All nodes of level 1 are
// asked for first. A mixed cell, one whose corners differ, is cut into four, for which its centre
// and the middles of its edges are asked for; where such a middle differs from both ends of its
// edge, the cell on the other side is cut too, so that a border is followed wherever it leads. On
// an edge between nodes that differ, the place of the border is found by halving. In a cell that is
// not cut any further the border is a straight line between those places, or, if all its edges are
// crossed, half of the cell counts as blocked.
//
// Error: nothing is known of what lies inside a cell with equal corners and reaches none of the
// nodes. A border with a radius of curvature R that crosses cells of size h is flattened by h^2 /
// 12R of its length in area, and each of its places is known to `width` h. Cost: 0.1 us a node,
// most of it in the visits of the tree (measured, the function left out).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace airlight {

class BorderGrid {
  public:
    /// Answers which of `count` points are blocked: writes their numbers to `hits`, ascending, and
    /// returns how many.
    using Ask = std::function<std::size_t(std::size_t count, const float* u, const float* v,
                                          std::uint32_t* hits)>;

    /// Cells of up to that level can be cut: levels >= 1 and coarse · 2^levels <= 4096, coarse
    /// >= 1.
    BorderGrid(int coarse, int levels);

    /// Forgets everything and asks for all nodes of level 1.
    void start(const Ask& ask);
    /// Cuts all cells of the levels below `level`.
    void cut_all(int level, const Ask& ask);
    /// Cuts the mixed cells of the levels below `level`, and what a border is followed into.
    void cut_mixed(int level, const Ask& ask);
    /// Finds borders on the edges of cells to `width` of an edge's length.
    void place(double width, const Ask& ask);

    int levels() const { return levels_; }
    int cells_along(int level) const { return coarse_ << level; }
    /// Points asked for so far.
    std::size_t asked() const { return asked_; }
    /// Nodes of that level that were not asked for.
    std::size_t missing(int level) const;
    /// Cells of the levels below `level` that cut_mixed() would begin with.
    std::size_t count_mixed(int level) const;

    /// An area of the square about (u, v).
    struct Area {
        float u, v, area;
    };
    /// The blocked part of a cell that is not cut, or all of one: its area and its centroid.
    struct Piece {
        float u, v, area;
        std::uint8_t level;
        bool whole;
    };
    struct Result {
        std::vector<Piece> pieces;
        /// How far a place of the border may be off: the standard deviation of the area it moves.
        std::vector<Area> doubts;
        /// Of cells whose quarters are not cut: their area now less what the straight line between
        /// their own edges' places makes of it.
        std::vector<Area> bends;
        /// Where nodes of level `finished` lie between others that differ from them, on a run
        /// shorter than 3/4 of their distance d: (d - run) d, positive for blocked nodes. As such
        /// a run is met by a node with the probability run / d only, this is what the runs that no
        /// node met are expected to amount to. At the ends of round shapes such runs are rare.
        std::vector<Area> hidden;

        void clear();
    };
    /// What the borders tell now; all cells of levels below `finished` must have been cut.
    void collect(int finished, Result& result) const;
    /// What counting the nodes of that level tells: pieces are nodes, and doubts the areas of a
    /// cell on each edge between nodes that differ.
    void count_nodes(int level, Result& result) const;

  private:
    /// Of the corners of a cell, counter-clockwise.
    static constexpr int kCornerX[] = {0, 1, 1, 0}, kCornerY[] = {0, 0, 1, 1};

    struct Cell {
        int level, i, j;
    };
    struct Crossing {
        int node, axis, length;
        bool first;       ///< the answer at the node
        float low, high;  ///< the border lies between, as parts of the length
    };

    int node(int x, int y) const { return y * (side_ + 1) + x; }
    int step(int axis) const { return axis == 0 ? 1 : side_ + 1; }
    int size_of(int level) const { return 1 << (levels_ - level); }
    bool known(int n) const { return marks_[static_cast<std::size_t>(n)] >> 1 == generation_; }
    bool blocked(int n) const { return (marks_[static_cast<std::size_t>(n)] & 1) != 0; }
    void mark(int n, bool value);
    int corners(const Cell& cell, bool* values) const;
    bool mixed(const Cell& cell) const;
    bool is_cut(const Cell& cell) const;

    void want(int n);
    void want_middle(int n, int axis, int length);
    void ask_wanted(const Ask& ask);
    void cut_queued(int below, const Ask& ask);
    void follow(const Cell& from, int di, int dj);
    void find_crossings(const Cell& cell);
    bool is_halved(const Crossing& crossing) const;
    void add_crossing(int n, int axis, int length);
    std::pair<int, int> shortest(int n, int axis, int length) const;
    const Crossing* find(int n, int axis, int length) const;
    double position(int n, int axis, int length) const;
    double part(const Cell& cell, double* u, double* v) const;
    double visit(const Cell& cell, Result& result) const;
    void collect_hidden(int level, Result& result) const;
    Area area_at(double x, double y, double area) const;

    int coarse_, levels_, side_;
    std::uint16_t generation_ = 0;
    std::size_t asked_ = 0;
    std::vector<std::uint16_t> marks_;  ///< generation and answer of each node
    std::vector<int> wanted_;
    std::vector<float> u_, v_;
    std::vector<std::uint32_t> hits_;
    std::vector<std::vector<Cell>> queues_;
    std::vector<Cell> now_;
    std::vector<Crossing> crossings_;
    std::vector<std::int32_t> slots_;  ///< hash table of crossings_, -1 where empty
};

}  // namespace airlight
