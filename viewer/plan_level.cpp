// SPDX-License-Identifier: Apache-2.0
#include "viewer/plan_level.h"

#include <algorithm>
#include <vector>

#include "viewer/plan.h"
#include "viewer/reference_picture.h"

namespace airlight {

double picture_level(const World& world, int width, int height) {
    constexpr int kSide = 32;
    constexpr std::size_t kMostBlobs = 2000;
    const Camera& camera = world.scene().camera;
    if (width <= 0) width = camera.width;
    if (height <= 0) height = camera.height;
    const double scale = std::min(1.0, double(kSide) / std::max(width, height));
    PlanOptions holds;
    holds.bounds = false;
    for (const Effect effect : {Effect::surface_point, Effect::particles}) {
        holds.only.remove(effect);
    }
    // Thousands of Gaussians would take longer than a sketch may; what they send is left out then.
    std::size_t blobs = 0;
    for (const SceneMedium& medium : world.scene().media) {
        const auto* const gaussians = std::get_if<SceneGaussians>(&medium.kind);
        blobs += gaussians ? gaussians->blobs.size() : 0;
    }
    if (blobs > kMostBlobs) {
        for (const Effect effect :
             {Effect::airlight_point, Effect::airlight_gaussians, Effect::airlight_environment}) {
            holds.only.remove(effect);
        }
    }
    const Plan plan = make_plan(world, holds);
    ReferencePictureOptions options;
    options.width = std::max(1, static_cast<int>(width * scale));
    options.height = std::max(1, static_cast<int>(height * scale));
    options.samples = 2;
    options.reference.quadrature = 0.05;
    const ReferencePicture sketch = render_reference(world, plan, options);
    std::vector<float> values(sketch.image.pixels.size() / 3);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float* const pixel = sketch.image.pixels.data() + 3 * i;
        values[i] = std::max({pixel[0], pixel[1], pixel[2]});
    }
    std::sort(values.begin(), values.end());
    const double high = values[(values.size() - 1) * 95 / 100];
    return std::max(high, 0.1 * double(values.back()));
}

}  // namespace airlight
