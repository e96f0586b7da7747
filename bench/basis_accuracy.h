// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace airlight {

/// The errors of the basis by order, up to 4096, as the Markdown of docs/BASIS_ACCURACY.md on
/// stdout.
void print_basis_accuracy();

}  // namespace airlight
