#pragma once
// W numbers handled at once: the pair physics is written over Pack<Real, W>, where W = 1 is the plain number
// that the wide versions are tested against.
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace slurry {

template <class Real, int W> struct PackOf {
    using type [[gnu::vector_size(sizeof(Real) * static_cast<std::size_t>(W))]] = Real;
};
template <class Real> struct PackOf<Real, 1> { using type = Real; };

template <class Real, int W> using Pack = typename PackOf<Real, W>::type;

// The plain number that a pack is made of. Constants in formulas are converted to it: a double does not mix
// with packs of float.
template <class P> struct ElementOf { using type = std::remove_cvref_t<decltype(std::declval<P>()[0])>; };
template <class P>
requires std::is_arithmetic_v<P>
struct ElementOf<P> {
    using type = P;
};
template <class P> using Element = typename ElementOf<P>::type;

#if defined(__AVX512F__)
inline constexpr int vector_bytes = 64;
#elif defined(__AVX__)
inline constexpr int vector_bytes = 32;
#else
inline constexpr int vector_bytes = 16;
#endif

template <class Real> inline constexpr int native_lanes = vector_bytes / static_cast<int>(sizeof(Real));

template <class P> P load(const auto* from) {
    P pack;
    std::memcpy(&pack, from, sizeof(P));
    return pack;
}

template <class P> void store(auto* to, const P& pack) {
    std::memcpy(to, &pack, sizeof(P));
}

// max(x, 0); 0 for NaN.
template <class P> P positive_part(P x) {
    const P zero{};
#ifdef __AVX512F__ // GCC makes a comparison and a masked move of the plain form
    if constexpr (std::is_same_v<P, Pack<float, 16>>) {
        return reinterpret_cast<P>(
            _mm512_maskz_max_ps(0xFFFF, reinterpret_cast<__m512>(x), reinterpret_cast<__m512>(zero)));
    } else if constexpr (std::is_same_v<P, Pack<double, 8>>) {
        return reinterpret_cast<P>(
            _mm512_maskz_max_pd(0xFF, reinterpret_cast<__m512d>(x), reinterpret_cast<__m512d>(zero)));
    } else
#endif
    {
        return x > zero ? x : zero;
    }
}

namespace detail {

// One step of Newton's method doubles the correct bits of an estimate of 1 / sqrt(x) or 1 / x.
template <class P> P refine_inverse_square_root(const P& x, const P& y) {
    return y * (Element<P>(1.5) - (Element<P>(0.5) * x) * (y * y));
}
template <class P> P refine_reciprocal(const P& x, const P& y) {
    return y * (2 - x * y);
}

} // namespace detail

// Square roots and divisions would take longer than the rest of a pair. The processor's estimates have 12
// bits or more; the arguments must be far from the ends of the exponents' range of a float.
template <class P> P inverse_square_root(const P& x) {
    using detail::refine_inverse_square_root;
#ifdef __AVX512F__
    if constexpr (std::is_same_v<P, Pack<float, 16>>) {
        const auto estimate = _mm512_maskz_rsqrt14_ps(0xFFFF, reinterpret_cast<__m512>(x));
        return refine_inverse_square_root(x, reinterpret_cast<P>(estimate));
    } else if constexpr (std::is_same_v<P, Pack<double, 8>>) {
        const auto estimate = _mm512_maskz_rsqrt14_pd(0xFF, reinterpret_cast<__m512d>(x));
        return refine_inverse_square_root(x, refine_inverse_square_root(x, reinterpret_cast<P>(estimate)));
    } else
#endif
#ifdef __AVX2__
        if constexpr (std::is_same_v<P, Pack<float, 8>>) {
        return refine_inverse_square_root(x,
                                          reinterpret_cast<P>(_mm256_rsqrt_ps(reinterpret_cast<__m256>(x))));
    } else if constexpr (std::is_same_v<P, Pack<double, 4>>) {
        const __m128 narrow = _mm256_cvtpd_ps(reinterpret_cast<__m256d>(x));
        P y = reinterpret_cast<P>(_mm256_cvtps_pd(_mm_rsqrt_ps(narrow)));
        for (int step = 0; step < 3; ++step) {
            y = refine_inverse_square_root(x, y);
        }
        return y;
    } else
#endif
        if constexpr (std::is_floating_point_v<P>) {
        return 1 / std::sqrt(x);
    } else {
        P y;
        for (std::size_t lane = 0; lane < sizeof(P) / sizeof(x[0]); ++lane) {
            y[lane] = 1 / std::sqrt(x[lane]);
        }
        return y;
    }
}

template <class P> P reciprocal(const P& x) {
    using detail::refine_reciprocal;
#ifdef __AVX512F__
    if constexpr (std::is_same_v<P, Pack<float, 16>>) {
        const auto estimate = _mm512_maskz_rcp14_ps(0xFFFF, reinterpret_cast<__m512>(x));
        return refine_reciprocal(x, reinterpret_cast<P>(estimate));
    } else if constexpr (std::is_same_v<P, Pack<double, 8>>) {
        const auto estimate = _mm512_maskz_rcp14_pd(0xFF, reinterpret_cast<__m512d>(x));
        return refine_reciprocal(x, refine_reciprocal(x, reinterpret_cast<P>(estimate)));
    } else
#endif
#ifdef __AVX2__
        if constexpr (std::is_same_v<P, Pack<float, 8>>) {
        return refine_reciprocal(x, reinterpret_cast<P>(_mm256_rcp_ps(reinterpret_cast<__m256>(x))));
    } else
#endif
    {
        return 1 / x;
    }
}

} // namespace slurry
