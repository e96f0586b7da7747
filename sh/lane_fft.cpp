// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/lane_fft.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "sh/lane_fft.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class T>
using Tag = hn::CappedTag<T, 64 / sizeof(T)>;

template <class T>
struct Number {
    hn::Vec<Tag<T>> re, im;
};

template <class T>
HWY_INLINE Number<T> operator+(const Number<T>& a, const Number<T>& b) {
    return {hn::Add(a.re, b.re), hn::Add(a.im, b.im)};
}

template <class T>
HWY_INLINE Number<T> operator-(const Number<T>& a, const Number<T>& b) {
    return {hn::Sub(a.re, b.re), hn::Sub(a.im, b.im)};
}

template <class T>
HWY_INLINE Number<T> scaled(const Number<T>& a, T factor) {
    const auto f = hn::Set(Tag<T>(), factor);
    return {hn::Mul(a.re, f), hn::Mul(a.im, f)};
}

// a + factor b
template <class T>
HWY_INLINE Number<T> sum(const Number<T>& a, T factor, const Number<T>& b) {
    const auto f = hn::Set(Tag<T>(), factor);
    return {hn::MulAdd(f, b.re, a.re), hn::MulAdd(f, b.im, a.im)};
}

// a - i b and a + i b
template <class T>
HWY_INLINE void turned(const Number<T>& a, const Number<T>& b, Number<T>& minus, Number<T>& plus) {
    minus = {hn::Add(a.re, b.im), hn::Sub(a.im, b.re)};
    plus = {hn::Sub(a.re, b.im), hn::Add(a.im, b.re)};
}

// The forward DFTs of 2 ... 5 elements, in place.
template <class T>
HWY_INLINE void butterfly(Number<T> (&z)[2]) {
    const Number<T> a = z[0];
    z[0] = a + z[1];
    z[1] = a - z[1];
}

template <class T>
HWY_INLINE void butterfly(Number<T> (&z)[3]) {
    constexpr T kSine = static_cast<T>(0.86602540378443864676L);
    const Number<T> both = z[1] + z[2], apart = scaled(z[1] - z[2], kSine);
    const Number<T> middle = sum(z[0], static_cast<T>(-0.5), both);
    z[0] = z[0] + both;
    turned(middle, apart, z[1], z[2]);
}

template <class T>
HWY_INLINE void butterfly(Number<T> (&z)[4]) {
    const Number<T> a = z[0] + z[2], b = z[0] - z[2], c = z[1] + z[3], d = z[1] - z[3];
    z[0] = a + c;
    z[2] = a - c;
    turned(b, d, z[1], z[3]);
}

template <class T>
HWY_INLINE void butterfly(Number<T> (&z)[5]) {
    constexpr T kCos1 = static_cast<T>(0.30901699437494742410L);
    constexpr T kCos2 = static_cast<T>(-0.80901699437494742410L);
    constexpr T kSin1 = static_cast<T>(0.95105651629515357212L);
    constexpr T kSin2 = static_cast<T>(0.58778525229247312917L);
    const Number<T> a = z[1] + z[4], b = z[2] + z[3], c = z[1] - z[4], d = z[2] - z[3];
    const Number<T> middle1 = sum(sum(z[0], kCos1, a), kCos2, b);
    const Number<T> middle2 = sum(sum(z[0], kCos2, a), kCos1, b);
    z[0] = z[0] + a + b;
    turned(middle1, sum(scaled(c, kSin1), kSin2, d), z[1], z[4]);
    turned(middle2, sum(scaled(c, kSin2), -kSin1, d), z[2], z[3]);
}

// out[q + done (kRadix p + j)] = w^(jp) DFT_j over i of in[q + done (p + rest i)], with
// w = exp(-2 pi i / (kRadix rest)). `re` and `im` say where the two parts lie in an element: the
// other way round makes the inverse.
template <class T, int kRadix, bool kTwiddled>
HWY_ATTR void pass(const T* HWY_RESTRICT in, T* HWY_RESTRICT out, std::size_t rest,
                   std::size_t done, const T* twiddle, std::size_t re, std::size_t im) {
    const Tag<T> d;
    constexpr std::size_t kLanes = 64 / sizeof(T), kStride = 2 * kLanes;
    for (std::size_t p = 0; p < rest; ++p) {
        T w[2 * kRadix - 1] = {};
        if (kTwiddled) std::copy_n(twiddle + 2 * (kRadix - 1) * p, 2 * (kRadix - 1), w);
        for (std::size_t q = 0; q < done; ++q) {
            const T* from = in + (q + done * p) * kStride;
            T* to = out + (q + done * kRadix * p) * kStride;
            for (std::size_t lane = 0; lane < kLanes; lane += hn::Lanes(d)) {
                Number<T> z[kRadix];
                for (int i = 0; i < kRadix; ++i) {
                    const T* element = from + i * rest * done * kStride + lane;
                    z[i] = {hn::Load(d, element + re), hn::Load(d, element + im)};
                }
                butterfly(z);
                for (int j = 0; j < kRadix; ++j) {
                    T* element = to + j * done * kStride + lane;
                    if (kTwiddled && j > 0) {
                        const auto c = hn::Set(d, w[2 * j - 2]), s = hn::Set(d, w[2 * j - 1]);
                        hn::Store(hn::MulSub(z[j].re, c, hn::Mul(z[j].im, s)), d, element + re);
                        hn::Store(hn::MulAdd(z[j].re, s, hn::Mul(z[j].im, c)), d, element + im);
                    } else {
                        hn::Store(z[j].re, d, element + re);
                        hn::Store(z[j].im, d, element + im);
                    }
                }
            }
        }
    }
}

template <class T, int kRadix>
HWY_ATTR void pass_of_radix(const T* in, T* out, std::size_t rest, std::size_t done,
                            const T* twiddle, std::size_t re, std::size_t im) {
    if (rest > 1) {
        pass<T, kRadix, true>(in, out, rest, done, twiddle, re, im);
    } else {
        pass<T, kRadix, false>(in, out, rest, done, twiddle, re, im);
    }
}

template <class T>
HWY_ATTR void run_pass(const T* in, T* out, std::size_t radix, std::size_t rest, std::size_t done,
                       const T* twiddle, std::size_t re, std::size_t im) {
    switch (radix) {
        case 2:
            return pass_of_radix<T, 2>(in, out, rest, done, twiddle, re, im);
        case 3:
            return pass_of_radix<T, 3>(in, out, rest, done, twiddle, re, im);
        case 4:
            return pass_of_radix<T, 4>(in, out, rest, done, twiddle, re, im);
        default:
            return pass_of_radix<T, 5>(in, out, rest, done, twiddle, re, im);
    }
}

HWY_ATTR void run_pass_float(const float* in, float* out, std::size_t radix, std::size_t rest,
                             std::size_t done, const float* twiddle, std::size_t re,
                             std::size_t im) {
    run_pass(in, out, radix, rest, done, twiddle, re, im);
}

HWY_ATTR void run_pass_double(const double* in, double* out, std::size_t radix, std::size_t rest,
                              std::size_t done, const double* twiddle, std::size_t re,
                              std::size_t im) {
    run_pass(in, out, radix, rest, done, twiddle, re, im);
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(run_pass_float);
HWY_EXPORT(run_pass_double);

namespace {

void run_pass(const float* in, float* out, std::size_t radix, std::size_t rest, std::size_t done,
              const float* twiddle, std::size_t re, std::size_t im) {
    HWY_DYNAMIC_DISPATCH(run_pass_float)(in, out, radix, rest, done, twiddle, re, im);
}

void run_pass(const double* in, double* out, std::size_t radix, std::size_t rest, std::size_t done,
              const double* twiddle, std::size_t re, std::size_t im) {
    HWY_DYNAMIC_DISPATCH(run_pass_double)(in, out, radix, rest, done, twiddle, re, im);
}

// exp(-pi i numerator / half), the numerator reduced for accuracy.
template <class T>
std::complex<T> root(std::size_t numerator, std::size_t half) {
    const long double angle = 3.14159265358979323846264338327950288L *
                              static_cast<long double>(numerator % (2 * half)) / half;
    return {static_cast<T>(std::cos(angle)), static_cast<T>(-std::sin(angle))};
}

// The factors 4 first, then 2, 3 and 5; empty if others remain.
std::vector<std::size_t> radices(std::size_t n) {
    std::vector<std::size_t> list;
    for (const std::size_t radix : {4, 2, 3, 5}) {
        for (; n % radix == 0; n /= radix) list.push_back(radix);
    }
    return n == 1 ? list : std::vector<std::size_t>();
}

}  // namespace

// A transform as a convolution with a chirp, over a power of two.
template <class T>
struct LaneFft<T>::Chirp {
    explicit Chirp(std::size_t length, std::size_t padded) : fft(padded) {
        std::vector<std::complex<T>> kernel(padded);
        for (std::size_t k = 0; k < length; ++k) {
            turn.push_back(root<T>(k * k, length));
            kernel[k] = kernel[(padded - k) % padded] = std::conj(turn[k]);
        }
        AlignedVector<T> data(fft.buffer_size()), scratch(fft.buffer_size());
        for (std::size_t k = 0; k < padded; ++k) {
            std::fill_n(data.data() + k * kStride, kLanes, kernel[k].real());
            std::fill_n(data.data() + k * kStride + kLanes, kLanes, kernel[k].imag());
        }
        const T* result = fft.transform(data.data(), false, scratch.data());
        for (std::size_t k = 0; k < padded; ++k) {
            spectrum.push_back(std::complex<T>(result[k * kStride], result[k * kStride + kLanes]) /
                               static_cast<T>(padded));
        }
    }

    LaneFft fft;
    std::vector<std::complex<T>> turn, spectrum;
};

namespace {

// Element k times factors[k], or its conjugate.
template <class T>
void multiply(T* data, const std::vector<std::complex<T>>& factors, bool conjugate) {
    for (const std::complex<T>& factor : factors) {
        multiply_element(data, conjugate ? std::conj(factor) : factor);
        data += LaneFft<T>::kStride;
    }
}

}  // namespace

template <class T>
LaneFft<T>::LaneFft(std::size_t length) : length_(length) {
    assert(length >= 1);
    const std::vector<std::size_t> list = radices(length);
    if (list.empty() && length > 1) {
        std::size_t padded = 1;
        while (padded < 2 * length - 1) padded *= 2;
        chirp_ = std::make_unique<Chirp>(length, padded);
        return;
    }
    std::size_t rest = length, done = 1;
    for (const std::size_t radix : list) {
        rest /= radix;
        passes_.push_back({radix, rest, done, twiddles_.size()});
        for (std::size_t p = 0; p < rest; ++p) {
            for (std::size_t j = 1; j < radix; ++j) {
                const std::complex<T> w = root<T>(2 * j * p, radix * rest);
                twiddles_.push_back(w.real());
                twiddles_.push_back(w.imag());
            }
        }
        done *= radix;
    }
}

template <class T>
LaneFft<T>::~LaneFft() = default;
template <class T>
LaneFft<T>::LaneFft(LaneFft&&) noexcept = default;
template <class T>
LaneFft<T>& LaneFft<T>::operator=(LaneFft&&) noexcept = default;

template <class T>
std::size_t LaneFft<T>::buffer_size() const {
    return chirp_ ? chirp_->fft.buffer_size() : kStride * length_;
}

template <class T>
T* LaneFft<T>::transform(T* data, bool inverse, T* scratch) const {
    const std::size_t re = inverse ? kLanes : 0, im = kLanes - re;
    if (!chirp_) {
        for (const Pass& pass : passes_) {
            run_pass(data, scratch, pass.radix, pass.rest, pass.done,
                     twiddles_.data() + pass.twiddle, re, im);
            std::swap(data, scratch);
        }
        return data;
    }
    multiply(data, chirp_->turn, inverse);
    std::fill(data + kStride * length_, data + buffer_size(), T(0));
    T* spectrum = chirp_->fft.transform(data, inverse, scratch);
    multiply(spectrum, chirp_->spectrum, inverse);
    T* result = chirp_->fft.transform(spectrum, !inverse, spectrum == data ? scratch : data);
    multiply(result, chirp_->turn, inverse);
    return result;
}

template class LaneFft<float>;
template class LaneFft<double>;

}  // namespace airlight
#endif
