// SPDX-License-Identifier: Apache-2.0
#include "medium/surface_radiance_method.h"

#include "core/error.h"
#include "medium/surface_radiance.h"

namespace airlight {

SurfaceEvaluator::SurfaceEvaluator(const SurfaceOptions& options) : options_(options) {
    if (options_.table_size == 0) {
        options_.table_size = options_.method == SurfaceMethod::cubic_table ? 128 : 64;
    }
    switch (options_.method) {
        case SurfaceMethod::raw_table_nearest:
        case SurfaceMethod::raw_table_bilinear:
            table_.emplace<RawSurfaceTable>(options_.exponent, options_.table_size,
                                            options_.table_max_t);
            break;
        case SurfaceMethod::warped_table:
            table_.emplace<WarpedSurfaceTable>(options_.exponent, options_.table_size,
                                               SurfaceInterpolation::linear);
            break;
        case SurfaceMethod::cubic_table:
            table_.emplace<WarpedSurfaceTable>(options_.exponent, options_.table_size,
                                               SurfaceInterpolation::cubic);
            break;
        case SurfaceMethod::exact:
            if (!(options_.exponent >= 1 && options_.exponent <= 1000)) {
                throw Error(ErrorCode::usage, "exponent = " + std::to_string(options_.exponent) +
                                                  " is not in [1, 1000]");
            }
            break;
    }
}

double SurfaceEvaluator::operator()(double t_sp, double theta_s) const {
    switch (options_.method) {
        case SurfaceMethod::raw_table_nearest:
            return std::get<RawSurfaceTable>(table_).radiance(t_sp, theta_s, TableLookup::nearest);
        case SurfaceMethod::raw_table_bilinear:
            return std::get<RawSurfaceTable>(table_).radiance(t_sp, theta_s, TableLookup::bilinear);
        case SurfaceMethod::warped_table:
        case SurfaceMethod::cubic_table:
            return std::get<WarpedSurfaceTable>(table_).radiance(t_sp, theta_s);
        case SurfaceMethod::exact:
            break;
    }
    return surface_radiance(t_sp, theta_s, options_.exponent);
}

}  // namespace airlight
