// SPDX-License-Identifier: Apache-2.0
// What every batch call has to hold, on every SIMD target of this CPU.
#pragma once

#include <gtest/gtest.h>

#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/medium/sweep.h"

namespace airlight {

/// Batch calls run on this target while it lives.
class ForcedTarget {
  public:
    explicit ForcedTarget(std::int64_t target) { choose(target); }
    ~ForcedTarget() { choose(0); }
    ForcedTarget(const ForcedTarget&) = delete;
    ForcedTarget& operator=(const ForcedTarget&) = delete;

  private:
    static void choose(std::int64_t target) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    }
};

/// Better targets are lower bits; from HWY_AVX2 on they have a fused multiply-add.
inline bool has_fused_multiply_add(std::int64_t target) {
    return target <= HWY_AVX2;
}

inline bool same_bits(float a, float b) {
    return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

template <std::size_t kInputs>
struct BatchColumns {
    std::array<std::vector<float>, kInputs> inputs;
    std::vector<float> out;

    explicit BatchColumns(std::size_t count) : out(count) {
        for (auto& column : inputs) column.resize(count);
    }
    std::size_t count() const { return out.size(); }
    std::array<const float*, kInputs> from(std::size_t first) const {
        std::array<const float*, kInputs> pointers;
        for (std::size_t k = 0; k < kInputs; ++k) pointers[k] = inputs[k].data() + first;
        return pointers;
    }
};

/// draw(SweepDraw&) -> std::array<float, kInputs>
template <std::size_t kInputs, class Draw>
BatchColumns<kInputs> draw_columns(std::size_t count, const Draw& draw) {
    BatchColumns<kInputs> columns(count);
    for (std::size_t i = 0; i < count; ++i) {
        SweepDraw state(i);
        const std::array<float, kInputs> x = draw(state);
        for (std::size_t k = 0; k < kInputs; ++k) columns.inputs[k][i] = x[k];
    }
    return columns;
}

/// Whether `value` is the float for `exact`, within the tolerance or one denormal.
inline bool is_close(float value, double exact, double tolerance) {
    const float rounded = static_cast<float>(exact);
    if (same_bits(value, rounded)) return true;
    if (std::signbit(value) != std::signbit(rounded)) return false;
    const double denormal = std::numeric_limits<float>::denorm_min();
    if (std::abs(value - exact) <= tolerance * std::abs(exact) + denormal) return true;
    // Either side of the largest float.
    const double least = (1 - tolerance) * std::numeric_limits<float>::max();
    return std::abs(value) > least && std::abs(exact) > least;
}

/// For the headers: the largest error of the running test, which --gtest_output=xml shows.
inline void record_worst(const std::string& target, double error) {
    static std::map<std::string, double> errors;
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    double& worst =
        errors[std::string(test->test_suite_name()) + '.' + test->name() + ' ' + target];
    worst = std::max(worst, error);
    testing::Test::RecordProperty(target, std::to_string(1e6 * worst) + "e-6");
}

/// Calls batch(count, pointers, out) on every target over `count` inputs: relative error under
/// `tolerance` of reference(doubles), and the same bits on all targets of one kind of arithmetic.
template <std::size_t kInputs, class Draw, class Batch, class Reference>
void check_batch_accuracy(const Draw& draw, const Batch& batch, const Reference& reference,
                          double tolerance, std::size_t count = kSweepInputs) {
    BatchColumns<kInputs> columns = draw_columns<kInputs>(count, draw);
    std::vector<double> exact(columns.count());
    parallel_blocks(exact.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            std::array<double, kInputs> x;
            for (std::size_t k = 0; k < kInputs; ++k) x[k] = columns.inputs[k][i];
            exact[i] = reference(x);
        }
    });
    std::vector<float> first[2];
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        const ForcedTarget forced(target);
        std::fill(columns.out.begin(), columns.out.end(), -1.0f);
        batch(columns.count(), columns.from(0), columns.out.data());
        std::size_t failures = 0;
        double worst = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
            if (std::isnormal(static_cast<float>(exact[i]))) {
                worst = std::max(worst, std::abs(columns.out[i] / exact[i] - 1));
            }
            if (is_close(columns.out[i], exact[i], tolerance) || ++failures > 5) continue;
            std::ostringstream inputs;
            inputs.precision(9);
            for (const auto& column : columns.inputs) inputs << ' ' << column[i];
            ADD_FAILURE() << columns.out[i] << " for " << exact[i] << " at" << inputs.str();
        }
        EXPECT_EQ(failures, 0u);
        record_worst(hwy::TargetName(target), worst);
        std::vector<float>& same = first[has_fused_multiply_add(target)];
        if (same.empty()) same = columns.out;
        EXPECT_TRUE(std::equal(same.begin(), same.end(), columns.out.begin(), same_bits));
    }
}

/// Every count from 0 to 33 at places of every alignment, into other memory and in place: the bits
/// of one long call, and nothing written beside them.
template <std::size_t kInputs, class Draw, class Batch>
void check_batch_places(const Draw& draw, const Batch& batch) {
    const BatchColumns<kInputs> drawn = draw_columns<kInputs>(200, draw);
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        const ForcedTarget forced(target);
        BatchColumns<kInputs> whole = drawn;
        batch(whole.count(), whole.from(0), whole.out.data());
        for (std::size_t count = 0; count <= 33; ++count) {
            for (std::size_t first = 0; first < 17; ++first) {
                // k < kInputs: in place of input k; k = kInputs: into memory of its own.
                for (std::size_t k = 0; k <= kInputs; ++k) {
                    BatchColumns<kInputs> part = drawn;
                    std::vector<float>& out = k < kInputs ? part.inputs[k] : part.out;
                    const std::vector<float> before = out;
                    batch(count, part.from(first), out.data() + first);
                    for (std::size_t i = 0; i < out.size(); ++i) {
                        const bool inside = i >= first && i < first + count;
                        ASSERT_TRUE(same_bits(out[i], inside ? whole.out[i] : before[i]))
                            << "count " << count << " from " << first << " at " << i;
                    }
                }
            }
        }
    }
}

}  // namespace airlight
