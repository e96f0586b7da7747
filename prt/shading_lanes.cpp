// SPDX-License-Identifier: Apache-2.0
#include "prt/shading_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prt/shading_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cassert>

#include "sh/aligned.h"
#include "sh/index.h"
#include "sh/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using detail::kShadingTile;
using detail::VertexLights;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

// Calls take(k, coefficients k of Lanes(d) vertices), k ascending to `size`.
struct Rows {
    const float* rows;
    std::size_t stride;

    template <class Take>
    HWY_INLINE void visit(D d, std::size_t size, const Take& take) const {
#if HWY_TARGET != HWY_SCALAR
        if (stride >= 4) {
            for (std::size_t k = 0; k < size; k += 4) {
                const std::size_t first = std::min(k, stride - 4);
                V v[4];
                for (std::size_t r = 0; r < 4; ++r) {
                    v[r] = load_blocks(d, rows + r * stride + first, 4 * stride);
                }
                transpose_blocks(d, v);
                if (first == k && k + 4 <= size) {
                    take(k, v[0]);
                    take(k + 1, v[1]);
                    take(k + 2, v[2]);
                    take(k + 3, v[3]);
                } else {
                    for (std::size_t s = k; s < std::min(size, first + 4); ++s) {
                        take(s, v[s - first]);
                    }
                }
            }
            return;
        }
#endif
        alignas(64) float lanes[hn::MaxLanes(D())];
        for (std::size_t k = 0; k < size; ++k) {
            for (std::size_t v = 0; v < hn::Lanes(d); ++v) lanes[v] = rows[v * stride + k];
            take(k, hn::Load(d, lanes));
        }
    }
};

struct Planes {
    const float* planes;

    template <class Take>
    HWY_INLINE void visit(D d, std::size_t size, const Take& take) const {
        for (std::size_t k = 0; k < size; ++k) take(k, hn::Load(d, planes + k * kShadingTile));
    }
};

HWY_INLINE void store(D d, const VertexLights& lights, const V (&sums)[3], float* radiance) {
    hn::StoreInterleaved3(hn::Mul(sums[0], hn::Set(d, lights.albedo.x)),
                          hn::Mul(sums[1], hn::Set(d, lights.albedo.y)),
                          hn::Mul(sums[2], hn::Set(d, lights.albedo.z)), d, radiance);
}

HWY_INLINE V weight(D d, const VertexLights& lights, std::size_t channel, std::size_t term,
                    std::size_t vertex) {
    const std::size_t c = lights.weight_channels == 1 ? 0 : channel;
    return hn::LoadU(d, lights.weights + (c * lights.terms + term) * lights.weight_stride + vertex);
}

// Lanes(d) vertices, whose weights begin at `vertex`.
template <int kLights, class Source>
HWY_INLINE void shade_lanes(D d, const VertexLights& lights, const Source& source,
                            std::size_t vertex, float* radiance) {
    V sums[3 * kLights];
    for (V& sum : sums) sum = hn::Zero(d);
    const float* HWY_RESTRICT light = lights.lights;
    const std::size_t stride = lights.light_stride;
    source.visit(d, sh_count(lights.order), [&](std::size_t k, V value) HWY_ATTR {
        for (std::size_t c = 0; c < 3 * kLights; ++c) {
            sums[c] = hn::MulAdd(value, hn::Set(d, light[c * stride + k]), sums[c]);
        }
    });
    V total[3] = {sums[0], sums[1], sums[2]};
    if (lights.weights) {
        for (std::size_t c = 0; c < 3; ++c) {
            total[c] = hn::Mul(weight(d, lights, c, 0, vertex), sums[c]);
            for (std::size_t j = 1; j < kLights; ++j) {
                total[c] = hn::MulAdd(weight(d, lights, c, j, vertex), sums[3 * j + c], total[c]);
            }
        }
    }
    store(d, lights, total, radiance);
}

template <class Source>
HWY_INLINE void shade_degrees(D d, const VertexLights& lights, const Source& source,
                              std::size_t vertex, float* radiance) {
    V total[3], sums[3];
    for (std::size_t c = 0; c < 3; ++c) total[c] = sums[c] = hn::Zero(d);
    const float* HWY_RESTRICT light = lights.lights;
    const std::size_t stride = lights.light_stride;
    std::size_t degree = 0, last = 0;
    source.visit(d, sh_count(lights.order), [&](std::size_t k, V value) HWY_ATTR {
        for (std::size_t c = 0; c < 3; ++c) {
            sums[c] = hn::MulAdd(value, hn::Set(d, light[c * stride + k]), sums[c]);
        }
        if (k != last) return;
        for (std::size_t c = 0; c < 3; ++c) {
            total[c] = hn::MulAdd(weight(d, lights, c, degree, vertex), sums[c], total[c]);
            sums[c] = hn::Zero(d);
        }
        ++degree;
        last += 2 * degree + 1;
    });
    store(d, lights, total, radiance);
}

template <class Source>
HWY_INLINE void shade_all(D d, const VertexLights& lights, const Source& source, std::size_t vertex,
                          float* radiance) {
    if (lights.by_degree) {
        shade_degrees(d, lights, source, vertex, radiance);
    } else if (lights.terms == 1) {
        shade_lanes<1>(d, lights, source, vertex, radiance);
    } else if (lights.terms == 2) {
        shade_lanes<2>(d, lights, source, vertex, radiance);
    } else if (lights.terms == 3) {
        shade_lanes<3>(d, lights, source, vertex, radiance);
    } else {
        assert(lights.terms == 4);
        shade_lanes<4>(d, lights, source, vertex, radiance);
    }
}

// The last vertices, fewer than the lanes, with weights that may be read beyond them.
struct Rest {
    AlignedVector<float> weights;
    VertexLights lights;
    alignas(64) float radiance[3 * hn::MaxLanes(D())];

    HWY_INLINE Rest(D d, const VertexLights& from, std::size_t vertex, std::size_t count)
        : lights(from) {
        if (!from.weights) return;
        const std::size_t lanes = hn::Lanes(d), rows = from.weight_channels * from.terms;
        weights.resize(rows * lanes);
        std::fill(weights.begin(), weights.end(), 0.0f);
        for (std::size_t r = 0; r < rows; ++r) {
            std::copy_n(from.weights + r * from.weight_stride + vertex, count, &weights[r * lanes]);
        }
        lights.weights = weights.data();
        lights.weight_stride = lanes;
    }
};

HWY_ATTR void shade_rows(const VertexLights& lights, std::size_t stride, std::size_t count,
                         const float* rows, float* radiance) {
    const D d;
    const std::size_t lanes = hn::Lanes(d), rest = count % lanes;
    std::size_t v = 0;
    for (; v + lanes <= count; v += lanes) {
        shade_all(d, lights, Rows{rows + v * stride, stride}, v, radiance + 3 * v);
    }
    if (rest == 0) return;
    AlignedVector<float> padded(lanes * stride);
    std::fill(std::copy_n(rows + v * stride, rest * stride, padded.begin()), padded.end(), 0.0f);
    Rest last(d, lights, v, rest);
    shade_all(d, last.lights, Rows{padded.data(), stride}, 0, last.radiance);
    std::copy_n(last.radiance, 3 * rest, radiance + 3 * v);
}

HWY_ATTR void shade_planes(const VertexLights& lights, std::size_t count, const float* planes,
                           float* radiance) {
    const D d;
    const std::size_t lanes = hn::Lanes(d), rest = count % lanes;
    std::size_t v = 0;
    for (; v + lanes <= count; v += lanes) {
        shade_all(d, lights, Planes{planes + v}, v, radiance + 3 * v);
    }
    if (rest == 0) return;
    Rest last(d, lights, v, rest);
    shade_all(d, last.lights, Planes{planes + v}, 0, last.radiance);
    std::copy_n(last.radiance, 3 * rest, radiance + 3 * v);
}

HWY_ATTR void rows_to_planes(std::size_t size, std::size_t count, const float* rows,
                             float* planes) {
    const D d;
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t v = 0; v < kShadingTile; v += lanes) {
        if (v + lanes <= count) {
            to_lanes(d, size, rows + v * size, planes + v, kShadingTile);
        } else {
            to_some_lanes(d, size, count > v ? count - v : 0, rows + v * size, planes + v,
                          kShadingTile);
        }
    }
}

HWY_ATTR void planes_to_rows(std::size_t size, std::size_t count, const float* planes,
                             float* rows) {
    const D d;
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t v = 0; v < count; v += lanes) {
        if (v + lanes <= count) {
            from_lanes(d, size, planes + v, kShadingTile, rows + v * size);
        } else {
            from_some_lanes(size, count - v, planes + v, kShadingTile, rows + v * size);
        }
    }
}

HWY_ATTR void scale_planes(int order, const float* factors, float* planes) {
    const D d;
    for (int l = 0; l < order; ++l) {
        const auto factor = hn::Set(d, factors[l]);
        const std::size_t count = static_cast<std::size_t>(2 * l + 1) * kShadingTile;
        for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
            hn::Store(hn::Mul(factor, hn::Load(d, planes + i)), d, planes + i);
        }
        planes += count;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(shade_rows);
HWY_EXPORT(shade_planes);
HWY_EXPORT(rows_to_planes);
HWY_EXPORT(planes_to_rows);
HWY_EXPORT(scale_planes);

namespace detail {

void shade_rows(const VertexLights& lights, std::size_t stride, std::size_t count,
                const float* rows, float* radiance) {
    HWY_DYNAMIC_DISPATCH(shade_rows)(lights, stride, count, rows, radiance);
}

void shade_planes(const VertexLights& lights, std::size_t count, const float* planes,
                  float* radiance) {
    assert(count <= kShadingTile);
    HWY_DYNAMIC_DISPATCH(shade_planes)(lights, count, planes, radiance);
}

void rows_to_planes(std::size_t size, std::size_t count, const float* rows, float* planes) {
    HWY_DYNAMIC_DISPATCH(rows_to_planes)(size, count, rows, planes);
}

void planes_to_rows(std::size_t size, std::size_t count, const float* planes, float* rows) {
    HWY_DYNAMIC_DISPATCH(planes_to_rows)(size, count, planes, rows);
}

void scale_planes(int order, const float* factors, float* planes) {
    HWY_DYNAMIC_DISPATCH(scale_planes)(order, factors, planes);
}

}  // namespace detail
}  // namespace airlight
#endif
