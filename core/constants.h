// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace airlight {

inline constexpr double kPi = 3.14159265358979323846;

}  // namespace airlight
