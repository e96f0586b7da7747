// SPDX-License-Identifier: Apache-2.0
#include "envmap/fog.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "envmap/band_filter.h"
#include "envmap/fog_kernel.h"
#include "envmap/kernel_reach.h"
#include "envmap/ring_filter.h"
#include "sh/phase_psf.h"
#include "sh/transform.h"

namespace airlight {
namespace {

// What pixel integrals and float pixels add to the error of a kernel.
constexpr double kRingsError = 1e-6;
// The scaled kernel's energy is at most 2.5 (pi^2 / 4 at T = 0): times this, even the largest float
// scatters less than half the smallest one. A backward peak may lift it by 2 / (1 + g).
constexpr double kInvisible = 4e-85;
constexpr double kInvisibleOfPeak = 1e-16 * kInvisible;
// Smaller tolerances than this are left to the rings.
constexpr double kFinestSplit = 3e-6;

std::vector<double> one_per_channel(const std::vector<double>& values, int channels,
                                    const char* name) {
    if (values.size() == 1) return std::vector<double>(channels, values[0]);
    if (values.size() != static_cast<std::size_t>(channels)) {
        throw Error(ErrorCode::usage,
                    fmt::format("{} takes 1 value or one for each of the {} channels, not {}", name,
                                channels, values.size()));
    }
    return values;
}

// One group for each optical thickness in use. PSF_T = T e^-T times the scaled kernel of
// fog_kernel.h; the factored form has the shape of T = 1 at every T.
std::vector<FogKernelGroup> kernel_groups(const FogPlan& plan) {
    std::map<double, FogKernelGroup> groups;
    const double least = plan.phase.kind() == PhaseKind::isotropic ? kInvisible : kInvisibleOfPeak;
    for (int channel = 0; channel < plan.channels; ++channel) {
        const double thickness = plan.optical_thickness[channel];
        const double amplitude = plan.albedo[channel] * thickness * std::exp(-thickness);
        if (amplitude < least) continue;
        const double shape = plan.psf == PsfForm::factored ? 1.0 : thickness;
        FogKernelGroup& group = groups[shape];
        group.shape = shape;
        group.channels.push_back(channel);
        group.amplitude.push_back(amplitude);
    }
    std::vector<FogKernelGroup> result;
    for (auto& [shape, group] : groups) result.push_back(std::move(group));
    return result;
}

int scattering_channels(const FogPlan& plan) {
    int count = 0;
    for (const FogKernelGroup& group : plan.groups)
        count += static_cast<int>(group.channels.size());
    return count;
}

int largest_lmax(int rows, int columns) {
    return std::min(rows - 1, (columns - 1) / 2);
}

// Builds the kernels of the cheapest split, or chooses the rings where those are cheaper still.
void choose_split(FogPlan& plan) {
    const int channels = scattering_channels(plan), groups = static_cast<int>(plan.groups.size());
    const KernelReach reach(plan.rows, plan.columns);
    std::vector<std::pair<double, int>> candidates;  // cost, lmax
    const double rings = ring_filter_cost(reach, channels, groups, 2.0);
    const int end = std::min(3 * plan.rows / 4, (plan.columns - 1) / 2);
    for (int lmax = 12; lmax <= end; lmax += std::max(4, lmax / 8)) {
        const double radius = split_radius(lmax, plan.tolerance);
        if (radius > 0.7) continue;
        const double cost = band_filter_cost(plan.rows, plan.columns, channels, lmax) +
                            ring_filter_cost(reach, channels, groups, radius);
        if (cost < rings) candidates.push_back({cost, lmax});
    }
    std::sort(candidates.begin(), candidates.end());
    for (const auto& [cost, lmax] : candidates) {
        bool reached = true;
        plan.estimated_error = plan.radius = 0;
        for (FogKernelGroup& group : plan.groups) {
            std::optional<SplitKernel> split =
                make_split_kernel(group.shape, lmax, plan.tolerance, plan.phase);
            reached = reached && split.has_value();
            if (!reached) break;
            plan.estimated_error = std::max(plan.estimated_error, split->error);
            plan.radius = std::max(plan.radius, 2 * std::asin(0.5 * split->radius));
            group.split = std::make_shared<const SplitKernel>(std::move(*split));
        }
        if (reached) {
            plan.lmax = lmax;
            return;
        }
    }
    plan.method = FogMethod::rings;
}

// The tables of another phase function, and their error.
void measure_rings(FogPlan& plan, double tolerance) {
    const double pixel = 2 * kPi / plan.columns * kPi / plan.rows;
    for (FogKernelGroup& group : plan.groups) {
        group.whole = std::make_shared<const RemainderTable>(whole_kernel(group.shape, plan.phase));
        plan.estimated_error = std::max(
            plan.estimated_error, whole_kernel_error(group.shape, plan.phase, *group.whole, pixel));
    }
    if (plan.estimated_error > tolerance) {
        throw Error(ErrorCode::usage,
                    fmt::format("tolerance {} is below what is reached with this phase function at "
                                "this size and thickness, {:.1e}",
                                tolerance, plan.estimated_error));
    }
}

void run_split(const Image& map, const FogPlan& plan, Image& out, Progress* progress) {
    std::vector<BandKernel> bands;
    std::vector<RingKernel> near;
    for (const FogKernelGroup& group : plan.groups) {
        for (std::size_t c = 0; c < group.channels.size(); ++c) {
            bands.push_back({group.channels[c], &group.split->eigenvalues, group.amplitude[c]});
        }
        near.push_back({&group.split->near, group.channels, group.amplitude});
    }
    write_band_filter(map, bands, out, progress);
    add_ring_filter(map, near, out, progress);
}

void run_rings(const Image& map, const FogPlan& plan, Image& out, Progress* progress) {
    for (const FogKernelGroup& group : plan.groups) {
        const auto table =
            group.whole
                ? group.whole
                : std::make_shared<const RemainderTable>(whole_kernel(group.shape, plan.phase));
        add_ring_filter(map, {{table.get(), group.channels, group.amplitude}}, out, progress);
    }
}

void run_sh(const Image& map, const FogPlan& plan, Image& out) {
    const std::size_t orders = static_cast<std::size_t>(plan.lmax) + 1;
    std::vector<double> eigenvalues(orders * plan.channels, 0.0);
    for (const FogKernelGroup& group : plan.groups) {
        const std::vector<double> lambda =
            psf_eigenvalues_scaled(group.shape, plan.phase, static_cast<int>(orders));
        for (std::size_t c = 0; c < group.channels.size(); ++c) {
            for (std::size_t l = 0; l < orders; ++l) {
                eigenvalues[group.channels[c] * orders + l] = group.amplitude[c] * lambda[l];
            }
        }
    }
    const SphericalTransform transform(map.height, map.width, plan.lmax);
    transform.convolve(map.pixels.data(), map.channels, eigenvalues.data(), out.pixels.data());
}

float smallest(const std::vector<float>& values) {
    return ordered_reduce<float>(
        values.size(), std::size_t{1} << 16, std::numeric_limits<float>::infinity(),
        [&](std::size_t begin, std::size_t end) {
            // Sixteen minima side by side, so that the compiler can use vectors.
            constexpr std::size_t kLanes = 16;
            float lane[kLanes];
            std::fill(lane, lane + kLanes, std::numeric_limits<float>::infinity());
            std::size_t i = begin;
            for (; i + kLanes <= end; i += kLanes) {
                for (std::size_t k = 0; k < kLanes; ++k) {
                    lane[k] = values[i + k] < lane[k] ? values[i + k] : lane[k];
                }
            }
            for (; i < end; ++i) lane[0] = std::min(lane[0], values[i]);
            return *std::min_element(lane, lane + kLanes);
        },
        [](float& least, float part) { least = std::min(least, part); });
}

}  // namespace

const char* fog_method_name(FogMethod method) {
    switch (method) {
        case FogMethod::automatic:
            return "auto";
        case FogMethod::sh:
            return "sh";
        case FogMethod::split:
            return "split";
        case FogMethod::rings:
            return "rings";
    }
    return "";
}

FogMethod fog_method_from_name(const std::string& name) {
    for (const FogMethod method :
         {FogMethod::automatic, FogMethod::sh, FogMethod::split, FogMethod::rings}) {
        if (name == fog_method_name(method)) return method;
    }
    throw Error(ErrorCode::usage,
                fmt::format("unknown method '{}': use auto, sh, split or rings", name));
}

FogPlan plan_fog(int rows, int columns, int channels, const FogOptions& options) {
    assert(rows > 0 && columns > 0 && channels > 0);
    FogPlan plan;
    plan.rows = rows;
    plan.columns = columns;
    plan.channels = channels;
    plan.psf = options.psf;
    plan.phase = options.phase;
    plan.optical_thickness =
        one_per_channel(options.optical_thickness, channels, "optical thickness");
    plan.albedo = one_per_channel(options.albedo, channels, "albedo");
    for (int c = 0; c < channels; ++c) {
        const double thickness = plan.optical_thickness[c], albedo = plan.albedo[c];
        if (!(thickness >= 0 && std::isfinite(thickness))) {
            throw Error(ErrorCode::usage,
                        fmt::format("optical thickness {} is not a finite number >= 0", thickness));
        }
        if (!(albedo >= 0 && albedo <= 1)) {
            throw Error(ErrorCode::usage, fmt::format("albedo {} is not in [0, 1]", albedo));
        }
    }
    if (!(options.tolerance >= kRingsError && options.tolerance < 1)) {
        throw Error(ErrorCode::usage,
                    fmt::format("tolerance {} is not in [{}, 1)", options.tolerance, kRingsError));
    }
    if (options.method == FogMethod::split && options.tolerance < kFinestSplit) {
        throw Error(ErrorCode::usage,
                    fmt::format("tolerance {} is below what method split reaches, {}: use rings",
                                options.tolerance, kFinestSplit));
    }
    plan.method = options.method;
    plan.tolerance = std::clamp(options.tolerance, kFinestSplit, 0.1);
    plan.groups = kernel_groups(plan);
    if (plan.groups.empty()) return plan;

    if (plan.method == FogMethod::automatic) {
        plan.method = options.tolerance < kFinestSplit ? FogMethod::rings : FogMethod::split;
    }
    if (plan.method == FogMethod::split) choose_split(plan);
    const std::size_t channel_rows = static_cast<std::size_t>(scattering_channels(plan)) * rows;
    const std::uint64_t ring_ticks = plan.groups.size() * ((rows + 1) / 2);
    switch (plan.method) {
        case FogMethod::automatic:
            break;
        case FogMethod::sh: {
            const int limit = largest_lmax(rows, columns);
            if (options.sh_order < 0 || options.sh_order > limit + 1) {
                throw Error(ErrorCode::usage,
                            fmt::format("order {} does not fit a map of {} x {} pixels: at most {}",
                                        options.sh_order, columns, rows, limit + 1));
            }
            plan.lmax = options.sh_order == 0 ? limit : options.sh_order - 1;
            plan.estimated_error = -1;
            plan.working_bytes = 16 * channel_rows * (plan.lmax + 1);
            break;
        }
        case FogMethod::split:
            plan.ticks = 2 * rows + plan.lmax + 1 + ring_ticks;
            plan.working_bytes = 16 * channel_rows * (plan.lmax + 1);
            break;
        case FogMethod::rings:
            plan.estimated_error = kRingsError;
            if (plan.phase.kind() != PhaseKind::isotropic) measure_rings(plan, options.tolerance);
            plan.radius = kPi;
            plan.ticks = ring_ticks;
            plan.working_bytes = 8 * channel_rows * columns;
            break;
    }
    return plan;
}

Image scattered_light(const Image& map, const FogPlan& plan, Progress* progress) {
    assert(map.width == plan.columns && map.height == plan.rows && map.channels == plan.channels);
    Image out(map.width, map.height, map.channels);
    out.metadata = map.metadata;
    if (plan.groups.empty()) return out;
    switch (plan.method) {
        case FogMethod::automatic:
            break;
        case FogMethod::sh:
            run_sh(map, plan, out);
            break;
        case FogMethod::split:
            run_split(map, plan, out, progress);
            break;
        case FogMethod::rings:
            run_rings(map, plan, out, progress);
            break;
    }
    // Rounding may leave -1e-16 of the brightest pixel where nothing shines. What sh rings is its
    // own.
    if (plan.method != FogMethod::sh && smallest(out.pixels) < 0 && smallest(map.pixels) >= 0) {
        for (float& value : out.pixels) value = std::max(value, 0.0f);
    }
    return out;
}

Image direct_light(const Image& map, const FogPlan& plan) {
    Image out(map.width, map.height, map.channels);
    out.metadata = map.metadata;
    add_direct_light(map, plan, out);
    return out;
}

void add_direct_light(const Image& map, const FogPlan& plan, Image& scattered) {
    const std::size_t channels = plan.optical_thickness.size();
    const std::size_t row_values = map.width * channels;
    // One factor per value of a row makes the loop the same for every channel.
    std::vector<double> transmittance(row_values);
    for (std::size_t i = 0; i < row_values; ++i) {
        transmittance[i] = std::exp(-plan.optical_thickness[i % channels]);
    }
    parallel_blocks(map.height, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            const float* in = map.pixels.data() + row * row_values;
            float* out = scattered.pixels.data() + row * row_values;
            for (std::size_t i = 0; i < row_values; ++i) {
                out[i] = static_cast<float>(out[i] + transmittance[i] * in[i]);
            }
        }
    });
    // Untouched where there is no fog: -0 stays -0.
    for (std::size_t c = 0; c < channels; ++c) {
        if (plan.optical_thickness[c] != 0) continue;
        for (std::size_t i = c; i < map.pixels.size(); i += channels) {
            scattered.pixels[i] = map.pixels[i];
        }
    }
}

}  // namespace airlight
