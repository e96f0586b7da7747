// SPDX-License-Identifier: Apache-2.0
#include "prt/reflected_light.h"

#include <algorithm>
#include <cassert>

#include "core/constants.h"
#include "sh/index.h"

namespace airlight::detail {
namespace {

// Hits that are summed in float, before those sums are in double.
constexpr std::size_t kPartial = 16;

bool reflects(const Reflector& r) {
    return r.mesh && r.transfer && r.albedo > 0;
}

// Adds what a point of a triangle sends, times a weight.
void add_point(std::size_t size, const float* rows, const glm::uvec3& corner, float u, float v,
               float weight, float* sum) {
    const float* const a = rows + size * corner.x;
    const float* const b = rows + size * corner.y;
    const float* const c = rows + size * corner.z;
    const float wb = weight * u, wc = weight * v, wa = weight - wb - wc;
    for (std::size_t i = 0; i < size; ++i) sum[i] += wa * a[i] + wb * b[i] + wc * c[i];
}

}  // namespace

ReflectedLight::ReflectedLight(const RayScene& scene, const std::vector<Reflector>& reflectors,
                               int order)
    : scene_(scene),
      reflectors_(reflectors),
      size_(sh_count(order)),
      any_(std::any_of(reflectors.begin(), reflectors.end(), reflects)) {}

void ReflectedLight::add(const glm::vec3& origin, const glm::mat3& frame, const Samples& blocked,
                         double* sum) {
    if (!any_ || blocked.count == 0) return;
    hits_.resize(std::max(hits_.size(), blocked.count));
    const std::size_t found = scene_.find_hits(origin, frame, blocked.count, blocked.x, blocked.y,
                                               blocked.z, hits_.data());
    float partial[kLargestBakeOrder * kLargestBakeOrder];
    for (std::size_t h = 0; h < found;) {
        const std::size_t end = std::min(h + kPartial, found);
        std::fill_n(partial, size_, 0.0f);
        for (; h < end; ++h) {
            const RayHit& hit = hits_[h];
            if (!hit.front || hit.mesh >= reflectors_.size()) continue;
            const Reflector& from = reflectors_[hit.mesh];
            if (!reflects(from)) continue;
            assert(hit.triangle < from.mesh->triangles.size());
            const auto albedo = static_cast<float>(from.albedo);
            add_point(size_, from.transfer, from.mesh->triangles[hit.triangle], hit.u, hit.v,
                      albedo * blocked.weight[hit.ray] * blocked.z[hit.ray], partial);
        }
        for (std::size_t i = 0; i < size_; ++i) sum[i] += double(partial[i]) / kPi;
    }
}

}  // namespace airlight::detail
