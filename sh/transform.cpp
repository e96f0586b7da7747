// SPDX-License-Identifier: Apache-2.0
#include "sh/transform.h"

#include <cmath>
#include <string>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "sh/legendre_stage.h"
#include "sh/row_spectra.h"

namespace airlight {
namespace {

using Complex = RingFft::Complex;

Complex unit(double angle) {
    return {std::cos(angle), std::sin(angle)};
}

// Multiplies a function given on pixel-centre rows by |sin theta| and projects the product onto
// trigonometric polynomials of degree < rows, so that a sum over the rows against any such
// polynomial P of the same parity is the integral of f P sin theta over the meridian.
class MeridianWeight {
  public:
    explicit MeridianWeight(int rows)
        : rows_(static_cast<std::size_t>(rows)), coarse_(2 * rows_), fine_(4 * rows_) {
        // |sin t| = sum of c_n exp(i n t), c_n = -(2 / pi) / (n^2 - 1) for even n. Terms beyond
        // 2 rows - 2 cannot reach the degrees that are kept.
        const std::size_t size = 4 * rows_;
        std::vector<Complex> spectrum(size), values(size);
        for (std::size_t n = 0; n + 2 <= 2 * rows_; n += 2) {
            const double c = -2 / (kPi * (static_cast<double>(n) * static_cast<double>(n) - 1));
            spectrum[n] = c;
            if (n > 0) spectrum[size - n] = c;
        }
        std::vector<Complex> scratch(fine_.scratch_size());
        fine_.transform(spectrum.data(), values.data(), true, scratch.data());
        // 1 / (2 rows) and 1 / (4 rows) undo the transforms, pi / rows is the row spacing.
        const double scale = kPi / (static_cast<double>(rows_) * 8 * rows_ * rows_);
        for (const Complex& value : values) weight_.push_back(value.real() * scale);
        for (std::size_t k = 0; k < rows_; ++k) {
            shift_.push_back(unit(-kPi * static_cast<double>(k) / (2 * rows_)));
        }
    }

    struct Workspace {
        std::vector<Complex> a, b, fft;
    };

    /// Replaces the rows of one order by their weighted values. `odd`: the order m is odd.
    void apply(double* re, double* im, bool odd, Workspace& work) const {
        const std::size_t n = 2 * rows_, size = 4 * rows_;
        work.a.assign(size, Complex());
        work.b.assign(size, Complex());
        work.fft.resize(std::max(coarse_.scratch_size(), fine_.scratch_size()));
        const double sign = odd ? -1 : 1;
        for (std::size_t j = 0; j < rows_; ++j) {
            work.a[j] = {re[j], im[j]};
            work.a[n - 1 - j] = {sign * re[j], sign * im[j]};
        }
        coarse_.transform(work.a.data(), work.b.data(), false, work.fft.data());
        std::fill(work.a.begin(), work.a.end(), Complex());
        // Degree `rows` itself does not occur in a band-limited function.
        for (std::size_t k = 0; k < rows_; ++k) {
            work.a[k] = work.b[k] * shift_[k];
            if (k > 0) work.a[size - k] = work.b[n - k] * std::conj(shift_[k]);
        }
        fine_.transform(work.a.data(), work.b.data(), true, work.fft.data());
        for (std::size_t j = 0; j < size; ++j) work.b[j] *= weight_[j];
        fine_.transform(work.b.data(), work.a.data(), false, work.fft.data());
        std::fill(work.b.begin(), work.b.end(), Complex());
        for (std::size_t k = 0; k < rows_; ++k) {
            work.b[k] = work.a[k] * std::conj(shift_[k]);
            if (k > 0) work.b[n - k] = work.a[size - k] * shift_[k];
        }
        coarse_.transform(work.b.data(), work.a.data(), true, work.fft.data());
        for (std::size_t j = 0; j < rows_; ++j) {
            re[j] = work.a[j].real();
            im[j] = work.a[j].imag();
        }
    }

  private:
    std::size_t rows_;
    ComplexFft coarse_, fine_;
    std::vector<double> weight_;
    std::vector<Complex> shift_;
};

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
    RingFft ring;
    MeridianWeight meridian;
    LegendreStage legendre;
    std::vector<double> ones;

    // Scratch of one thread: the folded rows of one order.
    struct Scratch {
        AlignedVector<double> even, odd, coefficients;
        LegendreStage::Workspace legendre;
        MeridianWeight::Workspace meridian;
    };

    Scratch scratch(std::size_t components) const {
        Scratch s;
        s.even.resize(components * legendre.padded_rows());
        s.odd.resize(components * legendre.padded_rows());
        s.coefficients.resize(components * legendre.padded_bands(0));
        return s;
    }

    // `map` points at the first of `count` channels of pixels that lie `stride` values apart.
    template <class T>
    RowSpectra spectra_of(const T* map, std::size_t stride, std::size_t count) const {
        RowSpectra spectra(rows, static_cast<std::size_t>(lmax) + 1, count);
        spectra.forward(ring, [&](std::size_t row, std::size_t channel, double* values) {
            const T* in = map + row * columns * stride + channel;
            for (std::size_t k = 0; k < columns; ++k) values[k] = in[k * stride];
        });
        return spectra;
    }

    template <class T>
    void map_of(const RowSpectra& spectra, std::size_t stride, T* map) const {
        spectra.inverse(ring, [&](std::size_t row, std::size_t channel, const double* values) {
            T* out = map + row * columns * stride + channel;
            for (std::size_t k = 0; k < columns; ++k) out[k * stride] = static_cast<T>(values[k]);
        });
    }

    // Bands of order m from its rows; leaves them in s.coefficients as (bands, components), with
    // the real part belonging to the cosine and the imaginary part to the sine harmonic.
    void analyze_order(RowSpectra& spectra, std::size_t m, Scratch& s) const {
        const std::size_t padded = legendre.padded_rows();
        const Complex turn = (m % 2 ? -1.0 : 1.0) * (2 * kPi / columns) * unit(-kPi * m / columns);
        for (std::size_t channel = 0; channel < spectra.channels(); ++channel) {
            double* re = spectra.at(m, 2 * channel);
            double* im = spectra.at(m, 2 * channel + 1);
            meridian.apply(re, im, m % 2 == 1, s.meridian);
            for (std::size_t row = 0; row < rows; ++row) {
                const Complex value = Complex(re[row], im[row]) * turn;
                re[row] = value.real();
                im[row] = value.imag();
            }
        }
        for (std::size_t c = 0; c < spectra.components(); ++c) {
            fold_rows(spectra.at(m, c), ones.data(), rows, padded, s.even.data() + c * padded,
                      s.odd.data() + c * padded);
        }
        legendre.analyze(static_cast<int>(spectra.components()), s.even.data(), s.odd.data(),
                         s.coefficients.data(), s.legendre);
    }

    void synthesize_order(RowSpectra& spectra, std::size_t m, Scratch& s) const {
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
    RowSpectra spectra = impl.spectra_of(map, channels, channels);
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
    RowSpectra spectra(impl.rows, static_cast<std::size_t>(impl.lmax) + 1, channels);
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
        RowSpectra spectra = impl.spectra_of(map + first, channels, count);
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
