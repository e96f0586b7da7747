// SPDX-License-Identifier: Apache-2.0
#include "sh/transform.h"

#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "sh/legendre_stage.h"
#include "sh/meridian_weight.h"
#include "sh/row_spectra.h"

namespace airlight {
namespace {

using Complex = std::complex<double>;

Complex unit(double angle) {
    return {std::cos(angle), std::sin(angle)};
}

}  // namespace

struct SphericalTransform::Impl {
    Impl(int rows_in, int columns_in, int lmax_in)
        : rows(rows_in),
          columns(columns_in),
          lmax(lmax_in),
          ring(columns_in),
          meridian(rows_in),
          legendre(northern_colatitudes(rows_in), lmax_in),
          ones(rows_in, 1.0) {}

    std::size_t rows, columns;
    int lmax;
    LaneFft<double> ring;
    MeridianWeight<double> meridian;
    LegendreStage legendre;
    std::vector<double> ones;

    // Scratch of one thread: the folded rows of one order.
    struct Scratch {
        AlignedVector<double> even, odd, coefficients;
        LegendreStage::Workspace legendre;
    };

    Scratch scratch(std::size_t components) const {
        Scratch s;
        s.even.resize(components * legendre.padded_rows());
        s.odd.resize(components * legendre.padded_rows());
        s.coefficients.resize(components * legendre.padded_bands(0));
        return s;
    }

    // `map` points at the first of `count` channels of pixels that lie `stride` values apart. The
    // rows come out weighted for quadrature.
    template <class T>
    RowSpectra<double> spectra_of(const T* map, std::size_t stride, std::size_t count) const {
        RowSpectra<double> spectra(rows, static_cast<std::size_t>(lmax) + 1, count);
        spectra.forward(ring, stride, [&](std::size_t row, std::size_t channel) {
            return map + row * columns * stride + channel;
        });
        std::vector<Complex> turn;
        for (std::size_t m = 0; m < spectra.orders(); ++m) {
            const double width = (m % 2 ? -1.0 : 1.0) * (2 * kPi / columns);
            turn.push_back(width * unit(-kPi * m / columns));
        }
        meridian.apply(spectra, turn);
        return spectra;
    }

    template <class T>
    void map_of(const RowSpectra<double>& spectra, std::size_t stride, T* map) const {
        spectra.inverse(ring, stride, [&](std::size_t row, std::size_t channel) {
            return map + row * columns * stride + channel;
        });
    }

    // Bands of order m from its rows; leaves them in s.coefficients as (bands, components), with
    // the real part belonging to the cosine and the imaginary part to the sine harmonic.
    void analyze_order(const RowSpectra<double>& spectra, std::size_t m, Scratch& s) const {
        const std::size_t padded = legendre.padded_rows();
        for (std::size_t c = 0; c < spectra.components(); ++c) {
            fold_rows(spectra.at(m, c), ones.data(), rows, padded, s.even.data() + c * padded,
                      s.odd.data() + c * padded);
        }
        legendre.analyze(static_cast<int>(spectra.components()), s.even.data(), s.odd.data(),
                         s.coefficients.data(), s.legendre);
    }

    void synthesize_order(RowSpectra<double>& spectra, std::size_t m, Scratch& s) const {
        const std::size_t padded = legendre.padded_rows();
        legendre.synthesize(static_cast<int>(spectra.components()), s.coefficients.data(),
                            s.even.data(), s.odd.data(), s.legendre);
        for (std::size_t c = 0; c < spectra.components(); ++c) {
            unfold_rows(s.even.data() + c * padded, s.odd.data() + c * padded, rows,
                        spectra.at(m, c));
        }
        const double half = m == 0 ? 1.0 : 0.5;
        const Complex turn = half * (m % 2 ? -1.0 : 1.0) * unit(kPi * m / columns);
        for (std::size_t channel = 0; channel < spectra.channels(); ++channel) {
            double* re = spectra.at(m, 2 * channel);
            double* im = spectra.at(m, 2 * channel + 1);
            for (std::size_t row = 0; row < rows; ++row) {
                const Complex value = Complex(re[row], im[row]) * turn;
                re[row] = value.real();
                im[row] = value.imag();
            }
        }
    }

    template <class Body>
    void for_each_order(std::size_t components, const Body& body) const {
        parallel_blocks(static_cast<std::size_t>(lmax) + 1, 4, [&](std::size_t m0, std::size_t m1) {
            Scratch s = scratch(components);
            for (std::size_t m = m0; m < m1; ++m) {
                legendre.prepare(static_cast<int>(m), s.legendre);
                body(m, s);
            }
        });
    }
};

SphericalTransform::SphericalTransform(int rows, int columns, int lmax) {
    if (rows < 1 || lmax < 0 || lmax >= rows || 2LL * lmax >= columns) {
        throw Error(ErrorCode::data,
                    "band limit " + std::to_string(lmax) + " does not fit a map of " +
                        std::to_string(columns) + " x " + std::to_string(rows) +
                        " pixels: it must be below the rows and below half the columns");
    }
    impl_ = std::make_unique<Impl>(rows, columns, lmax);
}

SphericalTransform::~SphericalTransform() = default;

int SphericalTransform::lmax() const {
    return impl_->lmax;
}

template <class T>
void SphericalTransform::analyze(const T* map, int channels, T* coefficients) const {
    const Impl& impl = *impl_;
    RowSpectra<double> spectra = impl.spectra_of(map, channels, channels);
    const std::size_t count = static_cast<std::size_t>(impl.lmax + 1) * (impl.lmax + 1);
    impl.for_each_order(spectra.components(), [&](std::size_t m, Impl::Scratch& s) {
        impl.analyze_order(spectra, m, s);
        const double* value = s.coefficients.data();
        for (std::size_t l = m; l <= static_cast<std::size_t>(impl.lmax); ++l) {
            for (int channel = 0; channel < channels; ++channel, value += 2) {
                T* band = coefficients + channel * count + l * (l + 1);
                band[m] = static_cast<T>(value[0]);
                if (m > 0) *(band - m) = static_cast<T>(value[1]);
            }
        }
    });
}

template <class T>
void SphericalTransform::synthesize(const T* coefficients, int channels, T* map) const {
    const Impl& impl = *impl_;
    RowSpectra<double> spectra(impl.rows, static_cast<std::size_t>(impl.lmax) + 1, channels);
    const std::size_t count = static_cast<std::size_t>(impl.lmax + 1) * (impl.lmax + 1);
    impl.for_each_order(spectra.components(), [&](std::size_t m, Impl::Scratch& s) {
        double* value = s.coefficients.data();
        for (std::size_t l = m; l <= static_cast<std::size_t>(impl.lmax); ++l) {
            for (int channel = 0; channel < channels; ++channel, value += 2) {
                const T* band = coefficients + channel * count + l * (l + 1);
                value[0] = band[m];
                value[1] = m > 0 ? static_cast<double>(*(band - m)) : 0.0;
            }
        }
        impl.synthesize_order(spectra, m, s);
    });
    impl.map_of(spectra, channels, map);
}

template <class T>
void SphericalTransform::convolve(const T* map, int channels, const double* eigenvalues,
                                  T* out) const {
    const Impl& impl = *impl_;
    const std::size_t orders = static_cast<std::size_t>(impl.lmax) + 1;
    // Two channels at a time: with all of them, the row spectra would take twice the map's memory.
    for (int first = 0; first < channels; first += 2) {
        const int count = std::min(2, channels - first);
        RowSpectra<double> spectra = impl.spectra_of(map + first, channels, count);
        impl.for_each_order(spectra.components(), [&](std::size_t m, Impl::Scratch& s) {
            impl.analyze_order(spectra, m, s);
            double* value = s.coefficients.data();
            for (std::size_t l = m; l < orders; ++l) {
                for (int channel = first; channel < first + count; ++channel, value += 2) {
                    const double factor = eigenvalues[channel * orders + l];
                    value[0] *= factor;
                    value[1] *= factor;
                }
            }
            impl.synthesize_order(spectra, m, s);
        });
        impl.map_of(spectra, channels, out + first);
    }
}

template void SphericalTransform::analyze(const float*, int, float*) const;
template void SphericalTransform::analyze(const double*, int, double*) const;
template void SphericalTransform::synthesize(const float*, int, float*) const;
template void SphericalTransform::synthesize(const double*, int, double*) const;
template void SphericalTransform::convolve(const float*, int, const double*, float*) const;
template void SphericalTransform::convolve(const double*, int, const double*, double*) const;

}  // namespace airlight
