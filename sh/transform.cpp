// SPDX-License-Identifier: Apache-2.0
#include "sh/transform.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "sh/legendre_stage.h"
#include "sh/meridian_weight.h"
#include "sh/row_spectra.h"

namespace airlight {
namespace {

std::complex<double> unit(double angle) {
    return {std::cos(angle), std::sin(angle)};
}

}  // namespace

// Everything in numbers of type R.
template <class R>
struct SphericalTransform::Impl {
    using Complex = std::complex<R>;

    Impl(int rows_in, int columns_in, int lmax_in)
        : rows(rows_in),
          columns(columns_in),
          lmax(lmax_in),
          ring(columns_in),
          meridian(rows_in),
          legendre(northern_colatitudes(rows_in), lmax_in) {
        if (std::is_same_v<R, float>) precise.emplace(northern_colatitudes(rows_in), lmax_in);
    }

    std::size_t rows, columns;
    int lmax;
    LaneFft<R> ring;
    MeridianWeight<R> meridian;
    LegendreStage<R> legendre;
    // In float, what does the lowest orders: from a pole on they grow for many bands, and whatever
    // a step is rounded by goes on growing with it.
    std::optional<LegendreStage<double>> precise;
    static constexpr std::size_t kPreciseOrders = 16;

    // Orders that one task takes at a time: what they need of rows and of coefficients, which lie
    // far apart, comes by the cache line.
    static constexpr std::size_t kOrders = 4;

    // What the sums of one order take.
    template <class Q>
    struct Sums {
        AlignedVector<Q> even, odd;    // folded rows
        AlignedVector<Q> rows, bands;  // if Q is not R
        std::vector<Q> ones;
        typename LegendreStage<Q>::Workspace legendre[kOrders];
    };

    // Scratch of one task.
    struct Scratch {
        std::size_t first, count;  // orders
        std::size_t padded_rows, padded_bands;
        AlignedVector<R> rows;          // (orders, components, padded rows)
        AlignedVector<R> coefficients;  // (orders, bands, components)
        Sums<R> sums;
        Sums<double> precise;

        R* bands(std::size_t order, std::size_t components) {
            return coefficients.data() + order * padded_bands * components;
        }
    };

    // `map` points at the first of `count` channels of pixels that lie `stride` values apart. The
    // rows come out weighted for quadrature.
    template <class T>
    RowSpectra<R> spectra_of(const T* map, std::size_t stride, std::size_t count) const {
        RowSpectra<R> spectra(rows, static_cast<std::size_t>(lmax) + 1, count);
        spectra.forward(ring, stride, [&](std::size_t row, std::size_t channel) {
            return map + row * columns * stride + channel;
        });
        std::vector<Complex> turn;
        for (std::size_t m = 0; m < spectra.orders(); ++m) {
            const double width = (m % 2 ? -1.0 : 1.0) * (2 * kPi / columns);
            turn.push_back(static_cast<Complex>(width * unit(-kPi * m / columns)));
        }
        meridian.apply(spectra, turn);
        return spectra;
    }

    template <class T>
    void map_of(const RowSpectra<R>& spectra, std::size_t stride, T* map) const {
        spectra.inverse(ring, stride, [&](std::size_t row, std::size_t channel) {
            return map + row * columns * stride + channel;
        });
    }

    // Calls body(stage, sums) with those that do the task's orders.
    template <class Body>
    void with_sums(Scratch& s, const Body& body) const {
        if (precise && s.first < kPreciseOrders) {
            body(*precise, s.precise);
        } else {
            body(legendre, s.sums);
        }
    }

    template <class Q>
    void prepare(const LegendreStage<Q>& stage, Sums<Q>& sums, const Scratch& s,
                 std::size_t components) const {
        sums.even.resize(components * stage.padded_rows());
        sums.odd.resize(components * stage.padded_rows());
        sums.ones.assign(rows, Q(1));
        if (!std::is_same_v<Q, R>) {
            sums.rows.resize(s.padded_rows);
            sums.bands.resize(components * s.padded_bands);
        }
        for (std::size_t i = 0; i < s.count; ++i) {
            stage.prepare(static_cast<int>(s.first + i), sums.legendre[i]);
        }
    }

    template <class Q>
    void analyze_order(const LegendreStage<Q>& stage, Sums<Q>& sums, Scratch& s, std::size_t i,
                       std::size_t components) const {
        const std::size_t padded = stage.padded_rows();
        for (std::size_t c = 0; c < components; ++c) {
            const R* values = s.rows.data() + (i * components + c) * s.padded_rows;
            Q* even = sums.even.data() + c * padded;
            Q* odd = sums.odd.data() + c * padded;
            if constexpr (std::is_same_v<Q, R>) {
                fold_rows(values, sums.ones.data(), rows, padded, even, odd);
            } else {
                std::copy_n(values, rows, sums.rows.data());
                fold_rows(sums.rows.data(), sums.ones.data(), rows, padded, even, odd);
            }
        }
        const std::size_t count = components * stage.padded_bands(static_cast<int>(s.first + i));
        if constexpr (std::is_same_v<Q, R>) {
            stage.analyze(components, sums.even.data(), sums.odd.data(), s.bands(i, components),
                          sums.legendre[i]);
        } else {
            stage.analyze(components, sums.even.data(), sums.odd.data(), sums.bands.data(),
                          sums.legendre[i]);
            std::transform(sums.bands.data(), sums.bands.data() + count, s.bands(i, components),
                           [](Q value) { return static_cast<R>(value); });
        }
    }

    template <class Q>
    void synthesize_order(const LegendreStage<Q>& stage, Sums<Q>& sums, Scratch& s, std::size_t i,
                          std::size_t components) const {
        const std::size_t padded = stage.padded_rows();
        const std::size_t count = components * stage.padded_bands(static_cast<int>(s.first + i));
        if constexpr (std::is_same_v<Q, R>) {
            stage.synthesize(components, s.bands(i, components), sums.even.data(), sums.odd.data(),
                             sums.legendre[i]);
        } else {
            std::copy_n(s.bands(i, components), count, sums.bands.data());
            stage.synthesize(components, sums.bands.data(), sums.even.data(), sums.odd.data(),
                             sums.legendre[i]);
        }
        for (std::size_t c = 0; c < components; ++c) {
            R* values = s.rows.data() + (i * components + c) * s.padded_rows;
            const Q* even = sums.even.data() + c * padded;
            const Q* odd = sums.odd.data() + c * padded;
            if constexpr (std::is_same_v<Q, R>) {
                unfold_rows(even, odd, rows, values);
            } else {
                unfold_rows(even, odd, rows, sums.rows.data());
                std::transform(sums.rows.data(), sums.rows.data() + rows, values,
                               [](Q value) { return static_cast<R>(value); });
            }
        }
    }

    // Bands of the task's orders from their rows, as (bands, components) with the real part
    // belonging to the cosine and the imaginary part to the sine harmonic.
    void analyze_orders(const RowSpectra<R>& spectra, Scratch& s) const {
        spectra.read(s.first, s.count, s.rows.data());
        with_sums(s, [&](const auto& stage, auto& sums) {
            for (std::size_t i = 0; i < s.count; ++i) {
                analyze_order(stage, sums, s, i, spectra.components());
            }
        });
    }

    // The rows of the task's orders from their bands, which carry turn(m).
    void synthesize_orders(RowSpectra<R>& spectra, Scratch& s) const {
        with_sums(s, [&](const auto& stage, auto& sums) {
            for (std::size_t i = 0; i < s.count; ++i) {
                synthesize_order(stage, sums, s, i, spectra.components());
            }
        });
        spectra.write(s.first, s.count, s.rows.data());
    }

    // What the bands of order m are multiplied by for synthesis: the inverse transform counts
    // orders above 0 twice, and column 0 lies half a column from pi.
    Complex turn(std::size_t m) const {
        const double sign = m % 2 ? -1.0 : 1.0;
        return static_cast<Complex>((m == 0 ? 1.0 : 0.5) * sign * unit(kPi * m / columns));
    }

    template <class Body>
    void for_each_task(const RowSpectra<R>& spectra, const Body& body) const {
        const std::size_t components = spectra.components();
        parallel_blocks(spectra.orders(), kOrders, [&](std::size_t begin, std::size_t end) {
            Scratch s;
            s.first = begin;
            s.count = end - begin;
            s.padded_rows = spectra.padded_rows();
            s.padded_bands = legendre.padded_bands(static_cast<int>(begin));
            s.rows.resize(s.count * components * s.padded_rows);
            s.coefficients.resize(s.count * components * s.padded_bands);
            with_sums(s,
                      [&](const auto& stage, auto& sums) { prepare(stage, sums, s, components); });
            body(s);
        });
    }

    // Calls visit(order, values, slot of -m, slot of +m) for every degree, channel and order of a
    // task, with `values` {cosine, sine}: neighbouring orders, which lie side by side in a degree,
    // together.
    template <class Visit>
    void for_each_band(Scratch& s, std::size_t channels, const Visit& visit) const {
        const std::size_t last = static_cast<std::size_t>(lmax);
        for (std::size_t l = s.first; l <= last; ++l) {
            const std::size_t orders = std::min(s.count, l - s.first + 1);
            for (std::size_t channel = 0; channel < channels; ++channel) {
                const std::size_t slot = channel * (last + 1) * (last + 1) + l * (l + 1);
                for (std::size_t i = 0; i < orders; ++i) {
                    const std::size_t m = s.first + i;
                    R* values = s.bands(i, 2 * channels) + 2 * ((l - m) * channels + channel);
                    visit(i, values, slot - m, slot + m);
                }
            }
        }
    }

    template <class T>
    void analyze(const T* map, int channels, T* coefficients) const {
        const RowSpectra<R> spectra = spectra_of(map, channels, channels);
        for_each_task(spectra, [&](Scratch& s) {
            analyze_orders(spectra, s);
            for_each_band(s, channels,
                          [&](std::size_t, const R* values, std::size_t minus, std::size_t plus) {
                              coefficients[minus] = static_cast<T>(values[1]);
                              coefficients[plus] = static_cast<T>(values[0]);
                          });
        });
    }

    template <class T>
    void synthesize(const T* coefficients, int channels, T* map) const {
        RowSpectra<R> spectra(rows, static_cast<std::size_t>(lmax) + 1, channels);
        for_each_task(spectra, [&](Scratch& s) {
            Complex turns[kOrders];
            for (std::size_t i = 0; i < s.count; ++i) turns[i] = turn(s.first + i);
            for_each_band(
                s, channels, [&](std::size_t i, R* values, std::size_t minus, std::size_t plus) {
                    const double sine = minus == plus ? 0.0 : static_cast<R>(coefficients[minus]);
                    const Complex value =
                        Complex(static_cast<R>(coefficients[plus]), sine) * turns[i];
                    values[0] = value.real();
                    values[1] = value.imag();
                });
            synthesize_orders(spectra, s);
        });
        map_of(spectra, channels, map);
    }

    template <class T>
    void convolve(const T* map, int channels, const double* eigenvalues, T* out) const {
        const std::size_t orders = static_cast<std::size_t>(lmax) + 1;
        // Two channels at a time: with all of them, the row spectra would take twice the map's
        // memory.
        for (int first = 0; first < channels; first += 2) {
            const std::size_t count = std::min(2, channels - first);
            RowSpectra<R> spectra = spectra_of(map + first, channels, count);
            for_each_task(spectra, [&](Scratch& s) {
                analyze_orders(spectra, s);
                for (std::size_t i = 0; i < s.count; ++i) {
                    const Complex turned = turn(s.first + i);
                    R* value = s.bands(i, 2 * count);
                    for (std::size_t l = s.first + i; l < orders; ++l) {
                        for (std::size_t channel = 0; channel < count; ++channel, value += 2) {
                            const R factor =
                                static_cast<R>(eigenvalues[(first + channel) * orders + l]);
                            const Complex result = factor * turned * Complex(value[0], value[1]);
                            value[0] = result.real();
                            value[1] = result.imag();
                        }
                    }
                }
                synthesize_orders(spectra, s);
            });
            map_of(spectra, channels, out + first);
        }
    }
};

SphericalTransform::SphericalTransform(int rows, int columns, int lmax,
                                       TransformPrecision precision)
    : lmax_(lmax) {
    if (rows < 1 || lmax < 0 || lmax >= rows || 2LL * lmax >= columns) {
        throw Error(ErrorCode::data,
                    "band limit " + std::to_string(lmax) + " does not fit a map of " +
                        std::to_string(columns) + " x " + std::to_string(rows) +
                        " pixels: it must be below the rows and below half the columns");
    }
    if (precision == TransformPrecision::full) {
        impl_ = std::make_unique<Impl<double>>(rows, columns, lmax);
    } else {
        impl_ = std::make_unique<Impl<float>>(rows, columns, lmax);
    }
}

SphericalTransform::~SphericalTransform() = default;

template <class T>
void SphericalTransform::analyze(const T* map, int channels, T* coefficients) const {
    std::visit([&](const auto& impl) { impl->analyze(map, channels, coefficients); }, impl_);
}

template <class T>
void SphericalTransform::synthesize(const T* coefficients, int channels, T* map) const {
    std::visit([&](const auto& impl) { impl->synthesize(coefficients, channels, map); }, impl_);
}

template <class T>
void SphericalTransform::convolve(const T* map, int channels, const double* eigenvalues,
                                  T* out) const {
    std::visit([&](const auto& impl) { impl->convolve(map, channels, eigenvalues, out); }, impl_);
}

template void SphericalTransform::analyze(const float*, int, float*) const;
template void SphericalTransform::analyze(const double*, int, double*) const;
template void SphericalTransform::synthesize(const float*, int, float*) const;
template void SphericalTransform::synthesize(const double*, int, double*) const;
template void SphericalTransform::convolve(const float*, int, const double*, float*) const;
template void SphericalTransform::convolve(const double*, int, const double*, double*) const;

}  // namespace airlight
