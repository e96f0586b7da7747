// SPDX-License-Identifier: Apache-2.0
#include "viewer/reference_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "viewer/camera.h"

namespace airlight {
namespace {

// What a pixel has gathered: sums of its samples and of the squares of their differences from the
// mean (Welford's recurrence), of the channel where these are largest.
struct PixelSum {
    glm::dvec3 mean{0}, squares{0};
    std::uint32_t count = 0;

    void add(const glm::dvec3& sample) {
        ++count;
        const glm::dvec3 before = sample - mean;
        mean += before * (1 / double(count));
        squares += before * (sample - mean);
    }
    double error() const {
        if (count < 2) return 0;
        const double largest = std::max({squares.x, squares.y, squares.z});
        return std::sqrt(largest / (double(count) * (count - 1)));
    }
    double brightness() const { return std::max({mean.x, mean.y, mean.z}); }
};

void check(const ReferencePictureOptions& options) {
    if (options.samples < 1 || options.samples > kLargestSamples) {
        throw Error(ErrorCode::usage, fmt::format("the samples of a pixel must be 1 to {}, got {}",
                                                  kLargestSamples, options.samples));
    }
    if (!(options.tolerance >= 0 && options.tolerance <= 1)) {
        throw Error(ErrorCode::usage,
                    fmt::format("the tolerance must be in [0, 1], got {}", options.tolerance));
    }
}

// `radiance` takes origin, direction, stream and counts and gives LayeredRadiance.
template <class Radiance>
ReferencePicture draw(const World& world, const Radiance& radiance,
                      const ReferencePictureOptions& options, std::size_t max_memory,
                      Progress* progress) {
    check(options);
    const Camera& camera = world.scene().camera;
    const int width = options.width > 0 ? options.width : camera.width;
    const int height = options.height > 0 ? options.height : camera.height;
    const std::size_t pixels = checked_product(
        {static_cast<std::size_t>(width), static_cast<std::size_t>(height)}, "the picture");
    const std::size_t of_layers =
        options.layers ? sizeof(LayeredRadiance) + 12 * kRadianceLayerCount : 0;
    require_memory(checked_multiply(pixels, sizeof(PixelSum) + 12 + of_layers, "the picture"),
                   max_memory, "the picture", world.scene().path);
    const glm::dmat3 axes = camera_axes(camera);
    std::vector<PixelSum> sums(pixels);
    std::vector<LayeredRadiance> layers(options.layers ? pixels : 0);
    ReferencePicture result;

    // Pixels of neighbours in a row.
    constexpr std::size_t kBlock = 64;
    const auto take_samples = [&](std::uint32_t most, double wanted) {
        const auto of_block = [&](std::size_t begin, std::size_t end) {
            ReferenceCounts counts;
            for (std::size_t i = begin; i < end; ++i) {
                PixelSum& sum = sums[i];
                const double x = double(i % static_cast<std::size_t>(width));
                const double y = double(i / static_cast<std::size_t>(width));
                while (sum.count < most && !(sum.count >= kFirstSamples && sum.error() <= wanted)) {
                    SampleStream stream(i, sum.count);
                    const double dx = stream.next(), dy = stream.next();
                    const LayeredRadiance light =
                        radiance(camera.position,
                                 camera_direction(camera, axes, width, height, x + dx, y + dy),
                                 stream, counts);
                    sum.add(light.total());
                    if (layers.empty()) continue;
                    for (std::size_t l = 0; l < kRadianceLayerCount; ++l) {
                        glm::dvec3& mean = layers[i].layers[l];
                        mean += (light.layers[l] - mean) / double(sum.count);
                    }
                }
            }
            if (progress) progress->tick(end - begin);
            return counts;
        };
        const ReferenceCounts counts = ordered_reduce<ReferenceCounts>(
            pixels, kBlock, {}, of_block,
            [](ReferenceCounts& all, const ReferenceCounts& part) { all += part; });
        result.counts += counts;
    };
    const auto brightest = [&] {
        double most = 0;
        for (const PixelSum& sum : sums) most = std::max(most, sum.brightness());
        return most;
    };
    const auto noise = [&] {
        const double level = brightest();
        double squares = 0;
        for (const PixelSum& sum : sums) squares += sum.error() * sum.error();
        return level > 0 ? std::sqrt(squares / double(pixels)) / level : 0;
    };
    const auto samples = static_cast<std::uint32_t>(options.samples);
    const bool together = options.scattering == Scattering::multiple;
    if (options.tolerance > 0 && together) {
        for (std::uint32_t most = std::min<std::uint32_t>(kFirstSamples, samples);;
             most = std::min(2 * most, samples)) {
            take_samples(most, -1);
            if (most == samples || noise() <= options.tolerance) break;
        }
    } else if (options.tolerance > 0 && options.samples > kFirstSamples) {
        take_samples(kFirstSamples, -1);
        take_samples(samples, options.tolerance * brightest());
    } else {
        take_samples(samples, -1);
    }

    result.image = Image(width, height, 3);
    if (options.layers) result.layers.fill(result.image);
    const double level = brightest();
    result.noise = noise();
    const bool finished = together && result.noise <= options.tolerance;
    for (std::size_t i = 0; i < pixels; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const int channel = static_cast<int>(c);
            result.image.pixels[3 * i + c] = static_cast<float>(sums[i].mean[channel]);
            for (std::size_t l = 0; options.layers && l < kRadianceLayerCount; ++l) {
                result.layers[l].pixels[3 * i + c] =
                    static_cast<float>(layers[i].layers[l][channel]);
            }
        }
        result.samples += sums[i].count;
        const double error = level > 0 ? sums[i].error() / level : 0;
        const bool noisy = options.tolerance > 0 && error > options.tolerance && !finished;
        result.unfinished += noisy ? 1 : 0;
    }
    return result;
}

}  // namespace

ReferencePicture render_reference(const World& world, const ReferencePictureOptions& options,
                                  std::size_t max_memory, Progress* progress) {
    PlanOptions holds;
    holds.bounds = false;
    return render_reference(world, make_plan(world, holds), options, max_memory, progress);
}

ReferencePicture render_reference(const World& world, const Plan& plan,
                                  const ReferencePictureOptions& options, std::size_t max_memory,
                                  Progress* progress) {
    if (options.scattering == Scattering::multiple) {
        const PathTracer tracer(world, options.paths);
        const auto radiance = [&](const glm::dvec3& origin, const glm::dvec3& direction,
                                  SampleStream& stream, ReferenceCounts& counts) {
            LayeredRadiance light;  // paths mix all layers
            light[RadianceLayer::direct] = tracer.radiance(origin, direction, stream, counts);
            return light;
        };
        return draw(world, radiance, options, max_memory, progress);
    }
    const ReferenceRenderer renderer(world, plan, options.reference);
    const auto radiance = [&](const glm::dvec3& origin, const glm::dvec3& direction,
                              SampleStream& stream, ReferenceCounts& counts) {
        return renderer.layers(origin, direction, stream, counts);
    };
    return draw(world, radiance, options, max_memory, progress);
}

}  // namespace airlight
