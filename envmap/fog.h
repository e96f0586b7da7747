// SPDX-License-Identifier: Apache-2.0
// Foggy environment maps: what a viewer in a uniform medium sees of a distant lat-long map.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/progress.h"
#include "envmap/image.h"
#include "medium/phase_function.h"
#include "medium/psf.h"

namespace airlight {

/// How the scattered light is computed, from cheap to exact.
enum class FogMethod {
    automatic,  ///< the cheapest with a bound that meets the tolerance
    sh,         ///< bands l < sh_order of the sampled map: smooth, rings, and no bound
    split,      ///< Ewald's split of the kernel into near pixels and far bands, to the tolerance
    rings,      ///< every pair of rings: exact to 1e-6, O(rows^2 columns)
};

/// The name of a method on the command line, and back; throws Error(usage) for an unknown name.
const char* fog_method_name(FogMethod method);
FogMethod fog_method_from_name(const std::string& name);

struct FogOptions {
    /// Optical thickness T = sigma_t * distance of the medium between viewer and map, in [0, inf):
    /// one value, or one per channel.
    std::vector<double> optical_thickness = {1.0};
    /// Single-scattering albedo sigma_s / sigma_t in [0, 1]: one value, or one per channel.
    std::vector<double> albedo = {1.0};
    PhaseFunction phase;  ///< of the medium, the same in all channels
    PsfForm psf = PsfForm::exact;
    /// Largest relative error of a pixel's scattered light, for a map without negative pixels.
    double tolerance = 1e-3;
    FogMethod method = FogMethod::automatic;
    /// For FogMethod::sh: bands l = 0 … sh_order-1; 0 takes all that the map holds.
    int sh_order = 0;
};

struct SplitKernel;
class RemainderTable;

/// Channels that share one kernel shape, each with its factor on PSF_T e^T / T.
struct FogKernelGroup {
    double shape = 0;  ///< T of the shape: 1 for the factored form
    std::vector<int> channels;
    std::vector<double> amplitude;                ///< albedo T e^-T, one per channel
    std::shared_ptr<const SplitKernel> split;     ///< for FogMethod::split
    std::shared_ptr<const RemainderTable> whole;  ///< for FogMethod::rings, if not isotropic
};

/// What one run will do: made from the size of the map and the options, before any pixel is
/// touched.
struct FogPlan {
    int rows = 0, columns = 0, channels = 0;
    FogMethod method = FogMethod::automatic;
    PsfForm psf = PsfForm::exact;
    PhaseFunction phase;
    std::vector<double> optical_thickness, albedo;  ///< one per channel
    /// Kernels of the channels that scatter at all; the others cost nothing.
    std::vector<FogKernelGroup> groups;
    double tolerance = 0;  ///< that the split's kernel is built for
    int lmax = -1;         ///< highest band of sh and split
    double radius = 0;     ///< of the near part, radians
    /// Bound on the relative error of scattered light: measured on the kernel for split, a priori
    /// for rings, negative for sh, which has none.
    double estimated_error = 0;
    std::uint64_t ticks = 0;        ///< progress steps of scattered_light
    std::size_t working_bytes = 0;  ///< memory beyond the map and the result, about
};

/// Checks the options and chooses the method. Throws Error(usage) for values outside their domain.
FogPlan plan_fog(int rows, int columns, int channels, const FogOptions& options);

/// The scattered light at every pixel centre omega of a piecewise constant map L,
///
///     albedo * sum_j L_j ∫_{pixel j} PSF_T(angle(omega, omega')) domega',
///
/// with PSF_T of medium/psf.h, or that of the plan's phase function (medium/phase_airlight.h), per
/// channel ([Sun05] sec. 6.4). Never negative for a map without
/// negative pixels. Errors are relative to each pixel's own value, beside a sun as anywhere.
/// Metadata is the map's. Results do not depend on the number of threads.
///
/// Measured on 1024 x 512 and smaller maps against direct sums of exact pixel integrals, with a
/// one-pixel sun of 1e5 and T = 1e-4 … 50: below the tolerance asked at every pixel (tests/envmap).
Image scattered_light(const Image& map, const FogPlan& plan, Progress* progress = nullptr);

/// The transmitted map, e^-T L.
Image direct_light(const Image& map, const FogPlan& plan);

/// Adds direct_light(map) to `scattered`, pixel by pixel in double. With T = 0 in a channel, that
/// channel becomes the map's, bit for bit.
void add_direct_light(const Image& map, const FogPlan& plan, Image& scattered);

}  // namespace airlight
