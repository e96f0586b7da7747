// SPDX-License-Identifier: Apache-2.0
// Rotation of spherical-harmonic coefficients.
//
// Rotations are active: light that came from direction d comes from R d afterwards. With f the
// function before and f' the one after, f'(d) = f(R^-1 d), and the coefficients of degree l become
//     c'_lm = sum_k D^l_mk c_lk,   D^l_mk = int Y_lm(d) Y_lk(R^-1 d) d omega,   Y(R d) = D Y(d).
// R acts on the basis's components (x, y, z): on world directions where coefficients are in the
// world frame of sh/basis.h. For coefficients in the map frame, (x, y, z) = world (Z, X, Y), pass P
// R P^T with P the cyclic turn from world to map components.
#pragma once

#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace airlight {

/// The rotation of order-n coefficients: one orthogonal (2l+1) x (2l+1) matrix D^l per degree.
///
/// Each degree comes from the one before by all terms of the recurrence of [Ivanic96], weighted so
/// that rounding is not magnified. Measured up to order 128: D^l D^l^T = 1 within 8e-15, D(R^-1) =
/// D(R)^T within 6e-16 in every entry, D Y(d) = Y(R d) within
/// 1.2e-14 sqrt((2l+1)/(4 pi)), most of it the rounding of R d.
/// Construction, one thread: 0.65, 2.3, 28 us for order 3, 6, 16, 2.1 ms for 64; 12 bytes for each
/// of the (4n^3 - n) / 3 entries.
class ShRotation {
  public:
    /// `rotation` times a column vector turns it; glm stores columns: rotation[column][row].
    ///
    /// Throws Error(usage) unless order >= 1 and the matrix is a rotation: every entry of
    /// R R^T - 1 within 1e-5, det R > 0. What passes is orthonormalised to the last digit first
    /// (the nearest rotation), so matrices rounded to float will do. Throws Error(memory) beyond
    /// the order, about 500, whose matrices exceed kDefaultMaxMemory.
    ShRotation(int order, const glm::dmat3& rotation);

    /// The turn v -> q v q^-1. Throws Error(usage) unless |q|^2 is within 1e-5 of 1.
    ShRotation(int order, const glm::dquat& rotation);

    /// The rotation that leaves everything alone, exactly.
    static ShRotation identity(int order);

    int order() const { return order_; }

    /// D^l, 0 <= l < order: (2l+1, 2l+1), row m + l, column k + l.
    const double* block(int l) const { return double_.data() + offset(l); }

    /// The rotation back, which is the transpose.
    ShRotation inverse() const;

    /// First `first`, then `second`; both of the same order, or Error(usage).
    friend ShRotation operator*(const ShRotation& second, const ShRotation& first);

    /// Rotates `count` vectors: in and out are (count, order^2), slots as in sh/index.h; channels
    /// are vectors like any other. out may be in, but not overlap it in another way. A vector's
    /// result depends on itself alone.
    ///
    /// Float matrices are the double ones rounded once; sums run in the type of the vectors.
    /// Largest error up to order 9, over the norm of the band: double 6e-16, float 1.7e-7
    /// (measured). Cost per float vector of order 6, 64 at a time, one thread: 13 ns with AVX2, 11
    /// with AVX-512, 29 with SSE4, where plain loops take 92.
    void rotate(std::size_t count, const double* in, double* out) const;
    void rotate(std::size_t count, const float* in, float* out) const;

    /// The same for coefficients stored slot by slot: slot k of vector v at [k * stride + v],
    /// stride >= count. rotate() transposes to this form and back; without that, 10 ns with AVX2.
    void rotate_planes(std::size_t count, std::size_t stride, const double* in, double* out) const;
    void rotate_planes(std::size_t count, std::size_t stride, const float* in, float* out) const;

  private:
    explicit ShRotation(int order);
    void round_to_float();
    /// Entries of all degrees below l.
    static std::size_t offset(int l) {
        const auto n = static_cast<std::size_t>(l);
        return n * (4 * n * n - 1) / 3;
    }

    int order_;
    std::vector<double> double_;
    std::vector<float> float_;
};

/// Coefficients of a zonal function turned to an axis: out[l(l+1)+m] = sqrt(4 pi / (2l+1)) g_l
/// Y_lm(axis), the zonal shortcut of a rotation, O(n^2) and without a matrix. `g` are the `order`
/// zonal coefficients (sh/zonal.h). Only the direction of the axis counts; one that is not
/// finite gives NaN, as evaluate_basis has it. The float overload computes in double and
/// rounds once.
void rotate_zonal(int order, const double* g, const glm::dvec3& axis, double* out);
void rotate_zonal(int order, const double* g, const glm::dvec3& axis, float* out);

}  // namespace airlight
