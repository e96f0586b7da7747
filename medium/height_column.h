// SPDX-License-Identifier: Apache-2.0
// The column of exponential height fog before it is rounded to a double.
#pragma once

#include "medium/exact_sum.h"

namespace airlight {
namespace detail {

/// exponential_height_depth of arguments in their domain. Nothing over- or underflows; +inf has an
/// infinite mantissa.
Scaled exponential_height_column(double height, double up, double distance, double falloff);

}  // namespace detail
}  // namespace airlight
