// SPDX-License-Identifier: Apache-2.0
#include "viewer/fast_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "viewer/camera.h"
#include "viewer/sample_stream.h"

namespace airlight {

FastPicture render_fast(const World& world, const Plan& plan, const FastMethods& methods,
                        const FastPictureOptions& options, std::size_t max_memory,
                        Progress* progress) {
    if (options.samples < 1 || options.samples > kLargestFastSamples) {
        throw Error(ErrorCode::usage, fmt::format("the samples of a pixel must be 1 to {}, got {}",
                                                  kLargestFastSamples, options.samples));
    }
    const Camera& camera = world.scene().camera;
    const int width = options.width > 0 ? options.width : camera.width;
    const int height = options.height > 0 ? options.height : camera.height;
    const std::size_t pixels = checked_product(
        {static_cast<std::size_t>(width), static_cast<std::size_t>(height)}, "the picture");
    const std::size_t images = 1 + (options.layers ? kRadianceLayerCount : 0);
    require_memory(checked_multiply(pixels, 12 * images, "the picture"), max_memory, "the picture",
                   world.scene().path);
    const PictureRays rays(camera, width, height);
    const FastRenderer renderer(world, plan, methods);
    FastPicture result;
    result.image = Image(width, height, 3);
    if (options.layers) result.layers.fill(result.image);

    // Rays of a pixel follow each other, and those of its neighbours come next.
    const auto samples = static_cast<std::size_t>(options.samples);
    const std::size_t grain = std::max<std::size_t>(1, 16 * FastBlock::kRays / samples);
    const auto set = [](Image& image, std::size_t i, const glm::dvec3& value) {
        for (int c = 0; c < 3; ++c) {
            image.pixels[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(value[c]);
        }
    };
    const auto of_block = [&](std::size_t begin, std::size_t end) {
        FastCounts counts;
        std::vector<glm::dvec3> directions;
        directions.reserve((end - begin) * samples);
        for (std::size_t i = begin; i < end; ++i) {
            const double x = double(i % static_cast<std::size_t>(width));
            const double y = double(i / static_cast<std::size_t>(width));
            for (std::size_t k = 0; k < samples; ++k) {
                SampleStream stream(i, k);
                const double dx = stream.next(), dy = stream.next();
                directions.push_back(rays(x + dx, y + dy));
            }
        }
        std::vector<LayeredRadiance> sums(end - begin);
        renderer.shade(directions.data(), end - begin, samples, sums.data(), counts);
        for (std::size_t i = begin; i < end; ++i) {
            LayeredRadiance& mean = sums[i - begin];
            for (glm::dvec3& layer : mean.layers) layer /= double(samples);
            set(result.image, i, mean.total());
            for (std::size_t l = 0; options.layers && l < kRadianceLayerCount; ++l) {
                set(result.layers[l], i, mean.layers[l]);
            }
        }
        if (progress) progress->tick(end - begin);
        return counts;
    };
    result.counts = ordered_reduce<FastCounts>(
        pixels, grain, {}, of_block, [](FastCounts& all, const FastCounts& part) { all += part; });
    result.counts += renderer.built();
    result.samples = pixels * samples;
    return result;
}

}  // namespace airlight
