// SPDX-License-Identifier: Apache-2.0
// What the blocked directions of vertices take away; for sources only.
#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <vector>

#include "sh/aligned.h"

namespace airlight::detail {

/// Directions over a vertex, z along its normal, with the solid angles for which they stand.
struct Samples {
    std::size_t count = 0;
    const float* x = nullptr;
    const float* y = nullptr;
    const float* z = nullptr;
    const float* weight = nullptr;
};

/// Sums of w Y(omega) and of w (n omega) Y(omega) over the blocked directions of the vertices of a
/// block, Y in the world's frame.
///
/// Rays come first and sums later, for many vertices at a time: where sums run in AVX-512, a
/// processor may lower its clock for a while, and taking turns vertex by vertex cost 4 to 6 % of
/// the whole bake.
class BlockedSums {
  public:
    /// Samples of one call of add().
    static constexpr std::size_t kMostSamples = 2048;

    /// of_cosine() needs `with_cosine`.
    BlockedSums(int order, bool with_cosine, std::size_t vertices);

    /// Takes blocked directions of the block's vertex k, whose frame turns them into the world's.
    /// Samples of a call are summed by themselves: the result depends on how a vertex's samples are
    /// split into calls, and not on other vertices.
    void add(std::size_t k, const glm::mat3& frame, const Samples& blocked);

    /// Adds up what was taken so far; the sums are complete after it.
    void finish();

    /// Slots of the order, of vertex k.
    const double* of_basis(std::size_t k) const { return sums_.data() + channels_ * size_ * k; }
    const double* of_cosine(std::size_t k) const { return of_basis(k) + size_; }

  private:
    struct Segment {
        std::size_t vertex, first, count;
    };

    int order_;
    std::size_t channels_, size_, pending_ = 0;
    AlignedVector<float> x_, y_, z_, values_;
    std::vector<Segment> segments_;
    std::vector<double> sums_;
};

}  // namespace airlight::detail
