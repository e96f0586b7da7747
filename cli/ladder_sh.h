// SPDX-License-Identifier: Apache-2.0
// The ladders of the operations on spherical-harmonic coefficients.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "cli/ladder_rungs.h"

namespace airlight {

/// An effect whose work is planned when it is asked for.
struct ShLadder {
    std::string effect;
    LadderWork (*plan)();
};

const std::vector<ShLadder>& sh_ladders();

RungLadder sh_basis_ladder();
RungLadder sh_rotation_ladder();
RungLadder sh_product_ladder();
RungLadder sh_triple_ladder();
RungLadder sh_function_ladder();
RungLadder sh_psf_ladder();
RungLadder sh_projection_ladder();
RungLadder sh_transform_ladder();
RungLadder brdf_lookup_ladder();
RungLadder brdf_fog_ladder();
LadderWork plan_sh_window_ladder();

/// Vectors that one run of a batch has.
inline constexpr std::size_t kLadderVectors = 64;

inline std::string order_name(int order) {
    return "order " + std::to_string(order);
}

/// Errors of vectors of `size` numbers, one after the other, over the largest number of the exact
/// vector.
template <class T>
LadderErrors vector_errors(const std::vector<double>& exact, const std::vector<T>& values,
                           std::size_t size) {
    LadderErrors errors;
    for (std::size_t begin = 0; begin < exact.size(); begin += size) {
        double largest = 0;
        for (std::size_t k = begin; k < begin + size; ++k) {
            largest = std::max(largest, std::abs(exact[k]));
        }
        for (std::size_t k = begin; k < begin + size; ++k) {
            errors.add(std::abs(static_cast<double>(values[k]) - exact[k]) / largest);
        }
    }
    return errors;
}

/// The rung whose run(out) makes these vectors.
template <class T, class Run>
RungResult measure_vectors(const std::vector<double>& exact, std::size_t size, const Run& run) {
    std::vector<T> out(exact.size());
    run(out.data());
    const LadderErrors errors = vector_errors(exact, out, size);
    const double results = static_cast<double>(exact.size() / size);
    return {nanoseconds_each(results, [&] { run(out.data()); }), errors.largest(), errors.rms()};
}

/// Vectors one after the other, (count, size), as planes, (size, count), and back where `size` and
/// count are exchanged.
template <class T>
std::vector<T> transposed(const std::vector<T>& vectors, std::size_t size) {
    const std::size_t count = vectors.size() / size;
    std::vector<T> out(vectors.size());
    for (std::size_t v = 0; v < count; ++v) {
        for (std::size_t k = 0; k < size; ++k) out[k * count + v] = vectors[v * size + k];
    }
    return out;
}

/// The same for a method that works on planes.
template <class T, class Run>
RungResult measure_planes(const std::vector<double>& exact, std::size_t size, const Run& run) {
    std::vector<T> out(exact.size());
    run(out.data());
    const std::size_t count = exact.size() / size;
    const LadderErrors errors = vector_errors(exact, transposed(out, count), size);
    return {nanoseconds_each(static_cast<double>(count), [&] { run(out.data()); }),
            errors.largest(), errors.rms()};
}

}  // namespace airlight
