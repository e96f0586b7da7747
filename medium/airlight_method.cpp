// SPDX-License-Identifier: Apache-2.0
#include "medium/airlight_method.h"

#include "medium/airlight.h"
#include "medium/airlight_rungs.h"

namespace airlight {

AirlightEvaluator::AirlightEvaluator(const AirlightOptions& options) : options_(options) {
    switch (options.method) {
        case AirlightMethod::f_table_nearest:
        case AirlightMethod::f_table_bilinear:
            table_.emplace<SpecialFTable>(options.table_size, options.table_max_u);
            break;
        case AirlightMethod::warped_table:
            table_.emplace<WarpedAirlightTable>(options.table_size);
            break;
        default:
            break;
    }
}

double AirlightEvaluator::operator()(double gamma, double t_sv, double t_vp) const {
    switch (options_.method) {
        case AirlightMethod::f_table_nearest:
            return std::get<SpecialFTable>(table_).airlight(gamma, t_sv, t_vp,
                                                            TableLookup::nearest);
        case AirlightMethod::f_table_bilinear:
            return std::get<SpecialFTable>(table_).airlight(gamma, t_sv, t_vp,
                                                            TableLookup::bilinear);
        case AirlightMethod::warped_table:
            return std::get<WarpedAirlightTable>(table_).airlight(gamma, t_sv, t_vp);
        case AirlightMethod::march64:
            return airlight_march(gamma, t_sv, t_vp, options_.march_steps);
        case AirlightMethod::sinh_gl6:
            return airlight_sinh_gl(gamma, t_sv, t_vp, 6);
        case AirlightMethod::sinh_gl8:
            return airlight_sinh_gl(gamma, t_sv, t_vp, 8);
        case AirlightMethod::sinh_gl12:
            return airlight_sinh_gl(gamma, t_sv, t_vp, 12);
        case AirlightMethod::sinh_gl16:
            return airlight_sinh_gl(gamma, t_sv, t_vp, 16);
        case AirlightMethod::sinh_gl24:
            return airlight_sinh_gl(gamma, t_sv, t_vp, 24);
        case AirlightMethod::sinh_gl32:
            return airlight_sinh_gl(gamma, t_sv, t_vp, 32);
        case AirlightMethod::e1:
            return airlight_e1(gamma, t_sv, t_vp);
        case AirlightMethod::exact:
            break;
    }
    return airlight(gamma, t_sv, t_vp);
}

}  // namespace airlight
