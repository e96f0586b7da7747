// SPDX-License-Identifier: Apache-2.0
// A colour for every direction, looked up without a square root or an angle.
#pragma once

#include <cmath>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

namespace airlight {

/// The sphere folded out of an octahedron onto a square of nodes, with linear interpolation
/// between them in both directions. Continuous: nodes of the square's border that are the same
/// direction hold the same value.
class SphereTable {
  public:
    SphereTable() = default;
    /// `size` >= 2 nodes on a side; of_direction(unit dvec3) -> dvec3.
    template <class F>
    SphereTable(int size, const F& of_direction) : size_(size) {
        values_.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
        for (int row = 0; row < size; ++row) {
            for (int column = 0; column < size; ++column) {
                values_.push_back(glm::vec3(of_direction(direction_at(row, column))));
            }
        }
    }

    /// Directions of any finite length but 0.
    glm::dvec3 operator()(const glm::dvec3& direction) const {
        const double sum = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
        double u = direction.x / sum, v = direction.z / sum;
        if (direction.y < 0) {
            const double folded = (1 - std::abs(v)) * (u < 0 ? -1 : 1);
            v = (1 - std::abs(u)) * (v < 0 ? -1 : 1);
            u = folded;
        }
        const double x = (0.5 * u + 0.5) * (size_ - 1), y = (0.5 * v + 0.5) * (size_ - 1);
        const int column = x < size_ - 2 ? static_cast<int>(x) : size_ - 2;
        const int row = y < size_ - 2 ? static_cast<int>(y) : size_ - 2;
        const float right = static_cast<float>(x - column), down = static_cast<float>(y - row);
        const glm::vec3* const a =
            values_.data() + static_cast<std::ptrdiff_t>(row) * size_ + column;
        const glm::vec3* const b = a + size_;
        return glm::dvec3((1 - down) * ((1 - right) * a[0] + right * a[1]) +
                          down * ((1 - right) * b[0] + right * b[1]));
    }

    bool empty() const { return values_.empty(); }

  private:
    glm::dvec3 direction_at(int row, int column) const {
        double u = 2.0 * column / (size_ - 1) - 1, v = 2.0 * row / (size_ - 1) - 1;
        const double y = 1 - std::abs(u) - std::abs(v);
        if (y < 0) {
            const double folded = (1 - std::abs(v)) * (u < 0 ? -1 : 1);
            v = (1 - std::abs(u)) * (v < 0 ? -1 : 1);
            u = folded;
        }
        const double length = std::sqrt(u * u + v * v + y * y);
        return {u / length, y / length, v / length};
    }

    int size_ = 0;
    std::vector<glm::vec3> values_;
};

}  // namespace airlight
