// SPDX-License-Identifier: Apache-2.0
// The media of a scene, made ready for rays.
#pragma once

#include <algorithm>
#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "medium/density_field.h"
#include "medium/gaussian_tree.h"
#include "medium/phase_function.h"
#include "viewer/scene.h"

namespace airlight {

/// Where a ray is inside a box: distances, near >= 0. Nothing where it misses the box or only
/// touches it. Any direction but 0; a ray within a face is inside.
struct RaySpan {
    double near = 0, far = 0;
};
std::optional<RaySpan> clip_to_box(const SceneBox& box, const glm::dvec3& origin,
                                   const glm::dvec3& direction, double distance);

/// A scene's phase function, read if it is a table.
PhaseFunction phase_of(const ScenePhase& phase);

/// Which media: those that are the same everywhere, those of some extent or all.
enum class MediumExtent { any, endless, limited };

/// How near to each other marks of Gaussians may be, in units of their 1 / scale, and the optical
/// depth that all may have together who get no marks for being faint.
struct MarkSpacing {
    double gaussians = 0.9, faintest = 1e-7;
};

/// One medium: extinction density_c(x) [1/m] in channel c, of which the part albedo_c scatters.
class MediumPart {
  public:
    /// Any medium but a slab, whose surfaces make it another thing.
    explicit MediumPart(const SceneMedium& medium);

    const glm::dvec3& albedo() const { return albedo_; }
    const PhaseFunction& phase() const { return phase_; }
    const std::optional<SceneBox>& bounds() const { return bounds_; }
    bool is_gaussian() const { return gaussian_; }
    /// Its shape where it has one for all channels and is no sum of Gaussians, to be scaled by
    /// colour(); else null.
    const Density* single_shape() const {
        return !gaussian_ && shapes_.size() == 1 ? &shapes_[0].parts[0] : nullptr;
    }
    /// Of a linear layer, whose border is another in each channel; else null.
    const std::array<LinearHeightDensity, 3>* linear_shapes() const {
        return linear_ ? &*linear_ : nullptr;
    }
    const glm::dvec3& colour() const { return colour_; }
    /// Of Gaussians, else none.
    const std::vector<GaussianBlob>& blobs() const { return blobs_; }

    /// Extinction [1/m] at a point; 0 outside the bounds. Of more than kFewBlobs Gaussians those
    /// are left out that add up to kTreeDensity of the largest amplitude at most.
    glm::dvec3 density(const glm::dvec3& x) const;

    /// Optical depth along `distance` in [0, inf] of a unit direction, not negative, +inf where
    /// the medium is without end. The closed forms of medium/density_field.h. Of more than
    /// kFewBlobs Gaussians those are left out whose depths add up to kTreeDepth at most.
    glm::dvec3 depth(const glm::dvec3& origin, const glm::dvec3& direction, double distance) const;

    /// A distance along a ray; another as near as `width` does as well.
    struct Mark {
        double at = 0, width = 0;
    };
    /// Adds distances in (0, distance) at which the medium begins or ends along a ray, and those
    /// around which a Gaussian is dense, and some free paths into what is dense beside the way to
    /// `lamp`, if there is one; those of crowding ones may be left out that others are nearer to
    /// than the spacing.
    void mark(const glm::dvec3& origin, const glm::dvec3& direction, double distance,
              const glm::dvec3* lamp, const MarkSpacing& spacing, std::vector<Mark>& marks) const;
    /// Adds those to which light of a lamp comes through a dense Gaussian.
    void mark_shadows(const glm::dvec3& lamp, const glm::dvec3& origin, const glm::dvec3& direction,
                      double distance, const MarkSpacing& spacing, std::vector<Mark>& marks) const;

    /// The extinction of a medium that is the same everywhere.
    const std::optional<glm::dvec3>& everywhere() const { return everywhere_; }

    bool is_of(MediumExtent extent) const {
        return extent == MediumExtent::any ||
               everywhere_.has_value() == (extent == MediumExtent::endless);
    }

    static constexpr std::size_t kFewBlobs = 32;
    static constexpr double kTreeDepth = 1e-7;
    static constexpr double kTreeDensity = 1e-9;

  private:
    /// of_shape(shape) for each channel, once where all have the same.
    template <class OfShape>
    glm::dvec3 by_channel(const OfShape& of_shape) const;

    /// One for all channels, scaled by colour_, or one for each.
    std::vector<DensityField> shapes_;
    std::shared_ptr<const GaussianTree> tree_;  ///< in place of a shape, for many Gaussians
    std::optional<std::array<LinearHeightDensity, 3>> linear_;
    double densest_ = 0;  ///< their largest amplitude
    glm::dvec3 colour_{1}, albedo_{1};
    PhaseFunction phase_;
    std::optional<SceneBox> bounds_;
    std::optional<glm::dvec3> everywhere_;
    bool gaussian_ = false;
    std::vector<GaussianBlob> blobs_;
};

/// All media but slabs; what they do adds up.
class SceneMedia {
  public:
    SceneMedia() = default;
    explicit SceneMedia(const std::vector<SceneMedium>& media);

    bool empty() const { return parts_.empty(); }
    const std::vector<MediumPart>& parts() const { return parts_; }
    /// Whether a part is made of Gaussians, or is not.
    bool any(bool gaussian) const;
    /// The extinction of all where each is the same everywhere.
    const std::optional<glm::dvec3>& everywhere() const { return everywhere_; }
    bool has_endless() const { return has(MediumExtent::endless); }
    bool has_limited() const { return has(MediumExtent::limited); }

    glm::dvec3 density(const glm::dvec3& x) const;
    glm::dvec3 depth(const glm::dvec3& origin, const glm::dvec3& direction, double distance,
                     MediumExtent extent = MediumExtent::any) const;
    /// e^{-depth}.
    glm::dvec3 transmittance(const glm::dvec3& origin, const glm::dvec3& direction,
                             double distance) const;

    /// 0, the marks of all media and `distance`, ascending, thinned out where they crowd.
    /// With those of shadows in the light of `lamp`, unless it is null.
    std::vector<double> marks(const glm::dvec3& origin, const glm::dvec3& direction,
                              double distance, const glm::dvec3* lamp = nullptr,
                              const MarkSpacing& spacing = kFineMarks) const;

    /// Rules of 15 nodes are exact to 1e-8 between the former; between the second they have to be
    /// halved here and there, which is quicker where 1e-3 is enough. The third are for drawing
    /// places between them.
    static constexpr MarkSpacing kFineMarks{0.9, 1e-7}, kWideMarks{3, 1e-4}, kDrawnMarks{0.9, 1e-4};

  private:
    bool has(MediumExtent extent) const;

    std::vector<MediumPart> parts_;
    std::optional<glm::dvec3> everywhere_;
};

/// The channel that has most.
inline double largest(const glm::dvec3& colour) {
    return std::max({colour.x, colour.y, colour.z});
}

/// e^{-depth}, once where all channels have the same.
glm::dvec3 transmittance_of(const glm::dvec3& depth);

}  // namespace airlight
