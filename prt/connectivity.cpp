// SPDX-License-Identifier: Apache-2.0
#include "prt/connectivity.h"

#include <algorithm>
#include <numeric>

namespace airlight::detail {
namespace {

class Connector {
  public:
    explicit Connector(const Mesh& mesh) : mesh_(mesh) {}

    Connectivity run() {
        pair_edges();
        count_nonmanifold_vertices();
        part_fans();
        return std::move(result_);
    }

  private:
    std::uint32_t from(std::uint32_t h) const {
        return mesh_.triangles[h / 3][static_cast<int>(h % 3)];
    }
    std::uint32_t to(std::uint32_t h) const { return from(next_in_triangle(h)); }
    std::uint32_t low(std::uint32_t h) const { return std::min(from(h), to(h)); }
    std::uint32_t high(std::uint32_t h) const { return std::max(from(h), to(h)); }

    void pair_edges() {
        const auto count = static_cast<std::uint32_t>(3 * mesh_.triangles.size());
        // Sorted by the lower vertex by counting, then by the higher.
        std::vector<std::uint32_t> begin(mesh_.positions.size() + 1, 0), order(count);
        for (std::uint32_t h = 0; h < count; ++h) ++begin[low(h) + 1];
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        std::vector<std::uint32_t> at(begin.begin(), begin.end() - 1);
        for (std::uint32_t h = 0; h < count; ++h) order[at[low(h)]++] = h;
        result_.twin.assign(count, kNoTwin);
        parent_.resize(count);
        std::iota(parent_.begin(), parent_.end(), 0u);
        nonmanifold_.resize(mesh_.positions.size());
        for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
            const auto first = order.begin() + begin[v], last = order.begin() + begin[v + 1];
            std::sort(first, last, [&](std::uint32_t a, std::uint32_t b) {
                return high(a) != high(b) ? high(a) < high(b) : a < b;
            });
            for (auto group = first; group != last;) {
                auto end = group;
                while (end != last && high(*end) == high(*group)) ++end;
                join(&*group, static_cast<std::size_t>(end - group));
                group = end;
            }
        }
    }

    void join(const std::uint32_t* half_edges, std::size_t count) {
        ++result_.edges;
        if (count == 1) {
            ++result_.boundary_edges;
        } else if (count > 2) {
            ++result_.nonmanifold_edges;
            nonmanifold_[from(half_edges[0])] = nonmanifold_[to(half_edges[0])] = true;
        } else if (from(half_edges[0]) == from(half_edges[1])) {
            ++result_.flipped_edges;
            unite(half_edges[0], half_edges[1]);
            unite(next_in_triangle(half_edges[0]), next_in_triangle(half_edges[1]));
        } else {
            unite(half_edges[0], next_in_triangle(half_edges[1]));
            unite(next_in_triangle(half_edges[0]), half_edges[1]);
            result_.twin[half_edges[0]] = half_edges[1];
            result_.twin[half_edges[1]] = half_edges[0];
        }
    }

    // Corners, each named by the half-edge that begins there, as sets of one fan.
    std::uint32_t root(std::uint32_t corner) {
        while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
        return corner;
    }
    void unite(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

    void count_nonmanifold_vertices() {
        std::vector<bool> has_fan(mesh_.positions.size());
        for (std::uint32_t corner = 0; corner < parent_.size(); ++corner) {
            if (parent_[corner] != corner) continue;
            const std::uint32_t v = from(corner);
            if (has_fan[v]) nonmanifold_[v] = true;
            has_fan[v] = true;
        }
        result_.nonmanifold_vertices =
            static_cast<std::size_t>(std::count(nonmanifold_.begin(), nonmanifold_.end(), true));
        std::vector<std::uint32_t>().swap(parent_);
    }

    void part_fans() {
        const std::vector<std::uint32_t>& twin = result_.twin;
        const auto count = static_cast<std::uint32_t>(twin.size());
        constexpr std::uint32_t kUnseen = 0xffffffff;
        result_.vertex.assign(count, kUnseen);
        result_.file_vertex.resize(mesh_.positions.size());
        std::iota(result_.file_vertex.begin(), result_.file_vertex.end(), 0u);
        std::vector<bool> has_fan(mesh_.positions.size());
        for (std::uint32_t h = 0; h < count; ++h) {
            if (result_.vertex[h] != kUnseen) continue;
            const std::uint32_t v = from(h);
            std::uint32_t number = v;
            if (!has_fan[v]) {
                has_fan[v] = true;
            } else {
                number = static_cast<std::uint32_t>(result_.file_vertex.size());
                result_.file_vertex.push_back(v);
            }
            // Around the vertex one way to the border or back to the start, then the other way.
            std::uint32_t at = h;
            do {
                result_.vertex[at] = number;
                at = twin[previous_in_triangle(at)];
            } while (at != kNoTwin && at != h);
            if (at == h) continue;
            for (at = h; twin[at] != kNoTwin;) {
                at = next_in_triangle(twin[at]);
                result_.vertex[at] = number;
            }
        }
    }

    const Mesh& mesh_;
    Connectivity result_;
    std::vector<std::uint32_t> parent_;
    std::vector<bool> nonmanifold_;
};

}  // namespace

Connectivity connect(const Mesh& mesh) {
    return Connector(mesh).run();
}

}  // namespace airlight::detail
