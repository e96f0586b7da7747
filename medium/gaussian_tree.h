// SPDX-License-Identifier: Apache-2.0
// Thousands of Gaussians: which of them a ray, or a ray and a light, has to know.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "medium/gaussian_airlight.h"

namespace airlight {

/// What a query of GaussianTree looked at.
struct GaussianTreeVisits {
    std::size_t nodes = 0;  ///< nodes whose bound was computed
    std::size_t blobs = 0;  ///< blobs whose bound was computed
    std::size_t taken = 0;  ///< blobs that were kept
};

/// A bounding-volume hierarchy over the centers of Gaussians, flat, split at medians. Building
/// takes O(n log n), and the tree depends on the list of blobs alone.
///
/// The bound. The line integral of blob i over any segment that keeps the distance d from its
/// center is at most A_i exp(-a_i^2 d^2), A_i = c_i sqrt(pi) / a_i, and that of a node's blobs
/// together (sum A) exp(-(min a)^2 d^2) with d the distance to the sphere around their centers.
/// A query states a tolerance for the optical depth of all that is left out together. It opens the
/// node with the largest bound, or takes the blob that has it, until the bounds of all that is
/// neither opened nor taken add up to no more than the tolerance: every blob is in exactly one of
/// those, so the tolerance is split by need and holds for the sum. (An even split, tolerance / n
/// for each blob, uses a thousandth of it.) Distances round: the statement holds at coordinates
/// moved by 1e-15 of their size.
///
/// Cost: O(log n + k) nodes for k blobs taken. From 8000 blobs to 64000 of the same density a
/// segment that takes 54 and 59 of them opens 528 and 600 nodes. 1000, 10000 and 100000 blobs of
/// falling size in one cube: 34, 110 and 450 us for 59, 145 and 327 taken, 230, 850 and 1900 nodes;
/// building .2, 3.6 and 51 ms (bench/gaussian_bench.cpp).
///
/// Queries are const and may run in parallel. Sums run from the largest bound down.
///
/// Deviates: [Zhou07] eq. 30 bounds a blob by a cone around its direction from one origin, cut at
/// one density for all; its square root is that of a negative number for c below that density and
/// its sine exceeds 1 for a viewer inside. A bound on the line integral itself has neither case,
/// and serves every ray.
class GaussianTree {
  public:
    /// Error (data) for a center that is not finite or beyond 1e100, a scale or amplitude that is
    /// not finite or negative or beyond 1e100, a scale of 0 with an amplitude above 0, and for more
    /// than 2^31 blobs.
    explicit GaussianTree(std::vector<GaussianBlob> blobs);

    /// The blobs as they were given.
    const std::vector<GaussianBlob>& blobs() const { return blobs_; }
    std::size_t node_count() const { return nodes_.size(); }

    /// Optical depth of a segment, never above the sum over all blobs and below it by no more than
    /// `tolerance` in [0, inf]. Unit direction and dist in [0, inf] as in gaussian_optical_depth;
    /// anything outside the domain gives NaN.
    double optical_depth(const glm::dvec3& origin, const glm::dvec3& direction, double dist,
                         double tolerance, GaussianTreeVisits* visits = nullptr) const;

    /// The same, faster and by more blobs: each has an even share of the tolerance, and a node of n
    /// is left out where its bound is under the share of n. Nothing is sorted. A picture of 100000
    /// blobs took a quarter of the time, with 1e-9.
    double quick_optical_depth(const glm::dvec3& origin, const glm::dvec3& direction, double dist,
                               double tolerance, GaussianTreeVisits* visits = nullptr) const;

    /// Density [1/m] at a point, never above the sum over all blobs and below it by no more than
    /// `tolerance` in [0, inf], by even shares likewise; the bound of a node is
    /// (sum c) exp(-(min a)^2 d^2). NaN outside the domain. Of 1000, 10000
    /// and 100000 blobs as above 75, 105 and 132 are taken at 240, 590 and 770 nodes for 1e-8 /m.
    double density(const glm::dvec3& x, double tolerance,
                   GaussianTreeVisits* visits = nullptr) const;

    /// The blobs, as ascending indices into blobs(), but for some whose optical depths along the
    /// segment add up to no more than `tolerance`. Empty for arguments outside the domain.
    std::vector<std::uint32_t> along(const glm::dvec3& origin, const glm::dvec3& direction,
                                     double dist, double tolerance,
                                     GaussianTreeVisits* visits = nullptr) const;

    /// The blobs, as ascending indices, that the airlight of a ray needs: those near the triangle
    /// of viewer, end of the ray and light. Along any line within it, what is left out adds up to
    /// no more than `tolerance`; with h the light's distance from the ray, the airlight of the rest
    /// is
    ///     L_a - tolerance / (4 pi h^2) <= L <= L_a e^{2 tolerance}.
    std::vector<std::uint32_t> around(const AirlightRay& ray, double tolerance,
                                      GaussianTreeVisits* visits = nullptr) const;

  private:
    /// A subtree's blobs are order_[begin, begin + count); its first child follows it.
    struct Node {
        glm::dvec3 center;
        double radius;
        double min_scale;
        double whole;                 ///< sum of A
        double peaks;                 ///< sum of c
        double log_whole, log_peaks;  ///< of their means over the blobs
        std::uint32_t begin, count;
        std::uint32_t second;  ///< 0 for a leaf
    };

    std::uint32_t build(std::uint32_t begin, std::uint32_t count);
    template <class Distance, class Take>
    void visit(const Distance& distance, double tolerance, const Take& take,
               GaussianTreeVisits* visits) const;
    template <class Distance, class Most, class Take>
    void descend(const Distance& distance, const Most& most, double tolerance, const Take& take,
                 GaussianTreeVisits* visits) const;
    double last_distance(const glm::dvec3& origin, double tolerance) const;

    std::vector<GaussianBlob> blobs_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace airlight
