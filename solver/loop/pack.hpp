#pragma once
// W numbers handled at once: the pair physics is written over Pack<Real, W>, where W = 1 is the plain number
// that the wide versions are tested against.
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace slurry {

template <class Real, int W> struct PackOf {
    using type [[gnu::vector_size(sizeof(Real) * static_cast<std::size_t>(W))]] = Real;
};
template <class Real> struct PackOf<Real, 1> { using type = Real; };

template <class Real, int W> using Pack = typename PackOf<Real, W>::type;

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

template <class P> P positive_part(P x) {
    const P zero{};
    return x > zero ? x : zero;
}

template <class P> P inverse_square_root(const P& x) {
    if constexpr (std::is_floating_point_v<P>) {
        return 1 / std::sqrt(x);
    } else {
#ifdef __AVX512F__
        // The hardware estimate has 14 bits; each Newton step doubles them. Square root and division would
        // take longer than the rest of the pair.
        if constexpr (std::is_same_v<P, Pack<double, 8>>) {
            P y = reinterpret_cast<P>(_mm512_maskz_rsqrt14_pd(0xFF, reinterpret_cast<__m512d>(x)));
            y = y * (1.5 - 0.5 * x * y * y);
            return y * (1.5 - 0.5 * x * y * y);
        }
#endif
        P y;
        for (std::size_t lane = 0; lane < sizeof(P) / sizeof(x[0]); ++lane) {
            y[lane] = 1 / std::sqrt(x[lane]);
        }
        return y;
    }
}

} // namespace slurry
