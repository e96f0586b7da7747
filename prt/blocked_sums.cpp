// SPDX-License-Identifier: Apache-2.0
#include "prt/blocked_sums.h"

#include <algorithm>
#include <cassert>

#include "sh/basis_batch.h"
#include "sh/index.h"

namespace airlight::detail {
namespace {

// Directions that wait to be summed.
constexpr std::size_t kPending = 6 << 10;

}  // namespace

BlockedSums::BlockedSums(int order, bool with_cosine, std::size_t vertices)
    : order_(order),
      channels_(with_cosine ? 2 : 1),
      size_(sh_count(order)),
      x_(kPending),
      y_(kPending),
      z_(kPending),
      values_(channels_ * kPending),
      sums_(channels_ * size_ * vertices) {}

void BlockedSums::add(std::size_t k, const glm::mat3& frame, const Samples& blocked) {
    const std::size_t count = blocked.count;
    assert(count <= kMostSamples);
    if (count == 0) return;
    if (pending_ + count > kPending) finish();
    float* const turned[] = {x_.data() + pending_, y_.data() + pending_, z_.data() + pending_};
    for (int axis = 0; axis < 3; ++axis) {
        // In the order in which prt/aim_rays.cpp turns what is traced.
        const float a = frame[0][axis], b = frame[1][axis], c = frame[2][axis];
        for (std::size_t i = 0; i < count; ++i) {
            turned[axis][i] = a * blocked.x[i] + b * blocked.y[i] + c * blocked.z[i];
        }
    }
    float* const values = values_.data() + channels_ * pending_;
    std::copy_n(blocked.weight, count, values);
    if (channels_ == 2) {
        for (std::size_t i = 0; i < count; ++i) {
            values[count + i] = blocked.weight[i] * blocked.z[i];
        }
    }
    segments_.push_back({k, pending_, count});
    pending_ += count;
}

void BlockedSums::finish() {
    for (const Segment& s : segments_) {
        project_basis_batch(order_, s.count, x_.data() + s.first, y_.data() + s.first,
                            z_.data() + s.first, static_cast<int>(channels_),
                            values_.data() + channels_ * s.first,
                            sums_.data() + channels_ * size_ * s.vertex);
    }
    segments_.clear();
    pending_ = 0;
}

}  // namespace airlight::detail
