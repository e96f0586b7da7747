// SPDX-License-Identifier: Apache-2.0
#include "bench/sharp_pairs.h"

#include <cassert>

#ifdef AIRLIGHT_HAVE_SHARP
#include <libsharp/sharp.h>
#include <libsharp/sharp_almhelpers.h>
#include <libsharp/sharp_geomhelpers.h>
#include <omp.h>

#include <complex>
#include <cstddef>
#include <random>
#include <vector>
#endif

namespace airlight {

#ifdef AIRLIGHT_HAVE_SHARP

struct SharpPairs::Impl {
    sharp_geom_info* grid = nullptr;
    sharp_alm_info* bands = nullptr;
    int flags = SHARP_DP;
    std::vector<double> in, out;
    std::vector<std::complex<double>> coefficients;

    void execute(sharp_jobtype job, std::vector<double>& map);
};

bool SharpPairs::available() {
    return true;
}

SharpPairs::SharpPairs(int rows, int columns, int threads) : impl_(std::make_unique<Impl>()) {
    sharp_make_fejer1_geom_info(rows, columns, 0.0, 1, columns, &impl_->grid);
    sharp_make_triangular_alm_info(rows - 1, rows - 1, 1, &impl_->bands);
    if (threads == 1) impl_->flags |= SHARP_NO_OPENMP;
    omp_set_num_threads(threads);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    impl_->in.resize(static_cast<std::size_t>(rows) * columns);
    for (double& value : impl_->in) value = uniform(random);
    impl_->out.resize(impl_->in.size());
    impl_->coefficients.resize(static_cast<std::size_t>(rows) * (rows + 1) / 2);
}

SharpPairs::~SharpPairs() {
    sharp_destroy_geom_info(impl_->grid);
    sharp_destroy_alm_info(impl_->bands);
}

void SharpPairs::Impl::execute(sharp_jobtype job, std::vector<double>& map) {
    void* values = map.data();
    void* bands_of_map = coefficients.data();
    for (int channel = 0; channel < 3; ++channel) {
        sharp_execute(job, 0, &bands_of_map, &values, grid, bands, flags, nullptr, nullptr);
    }
}

void SharpPairs::analyze() {
    impl_->execute(SHARP_MAP2ALM, impl_->in);
}

void SharpPairs::synthesize() {
    impl_->execute(SHARP_ALM2MAP, impl_->out);
}

#else

struct SharpPairs::Impl {};

bool SharpPairs::available() {
    return false;
}

SharpPairs::SharpPairs(int, int, int) {
    assert(false);
}

SharpPairs::~SharpPairs() = default;

void SharpPairs::analyze() {
    assert(false);
}

void SharpPairs::synthesize() {
    assert(false);
}

#endif

}  // namespace airlight
