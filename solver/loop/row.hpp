#pragma once
// Rows: what a pair needs of one particle, eight numbers side by side in memory, written once per pass and
// then only read. One neighbour costs half a cache line in float, and W of them are transposed in registers.
#include "solver/loop/pack.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace slurry {

inline constexpr int row_fields = 8;

template <class Real> struct alignas(row_fields * sizeof(Real)) Row { std::array<Real, row_fields> field; };

template <class P> using Fields = std::array<P, row_fields>;

namespace detail {

// Two rows side by side.
template <class Real> Pack<Real, 16> concatenate(const Pack<Real, 8>& low, const Pack<Real, 8>& high) {
#ifdef __AVX512F__ // GCC makes a shuffle of the plain form, which competes with those of the transposition
    if constexpr (std::is_same_v<Real, float>) {
        return reinterpret_cast<Pack<Real, 16>>(
            _mm512_maskz_insertf64x4(0xFF, _mm512_castpd256_pd512(reinterpret_cast<__m256d>(low)),
                                     reinterpret_cast<__m256d>(high), 1));
    } else
#endif
    {
        return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    }
}

// Transposes four vectors of 4 numbers.
template <class P> void transpose4(std::array<P, 4>& r) {
    const P t0 = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6);
    const P t1 = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
    const P t2 = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6);
    const P t3 = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
    r[0] = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
    r[1] = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
    r[2] = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
    r[3] = __builtin_shufflevector(t1, t3, 2, 3, 6, 7);
}

// One of the three steps of a transposition of 8 x 8 numbers, of two side by side if P is wide.
template <int Step, class P> void exchange(P& a, P& b) {
    P first, second;
    constexpr bool wide = sizeof(P) / sizeof(a[0]) == 16;
    if constexpr (Step == 0 && wide) {
        first = __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
        second = __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
    } else if constexpr (Step == 1 && wide) {
        first = __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
        second = __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
    } else if constexpr (wide) {
        first = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27);
        second = __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
    } else if constexpr (Step == 0) {
        first = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
        second = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    } else if constexpr (Step == 1) {
        first = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
        second = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    } else {
        first = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
        second = __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
    }
    a = first;
    b = second;
}

// Transposes eight vectors of 8 numbers, or of twice 8 numbers half by half, into eight fields. The steps are
// those that need no copies and no table of indices; they exchange numbers, then pairs, then fours.
template <class P> std::array<P, 8> transpose8(std::array<P, 8> r) {
    for (const std::size_t four : {0U, 4U}) {
        exchange<0>(r[four], r[four + 1]);
        exchange<0>(r[four + 2], r[four + 3]);
        exchange<1>(r[four], r[four + 2]);
        exchange<1>(r[four + 1], r[four + 3]);
    }
    for (std::size_t k = 0; k < 4; ++k) {
        exchange<2>(r[k], r[k + 4]);
    }
    return {r[0], r[2], r[1], r[3], r[4], r[6], r[5], r[7]};
}

} // namespace detail

// The W rows at the given offsets in bytes (bytes: the loop would spend an instruction a row on indices),
// field by field.
template <class Real, int W>
Fields<Pack<Real, W>> gather(const Row<Real>* rows, const std::uint32_t* offsets) {
    const auto fields_of = [&](std::size_t lane) {
        const auto* row = reinterpret_cast<const std::byte*>(rows) + offsets[lane];
        return reinterpret_cast<const Row<Real>*>(row)->field.data();
    };
    Fields<Pack<Real, W>> out;
    if constexpr (W == 1) {
        std::copy_n(fields_of(0), row_fields, out.begin());
    } else if constexpr (W == 16) {
        std::array<Pack<Real, 16>, 8> pairs;
        for (std::size_t k = 0; k < 8; ++k) { // the last step of the transposition wants them in this order
            const std::size_t lane = k + k / 4 * 4;
            pairs[k] = detail::concatenate<Real>(load<Pack<Real, 8>>(fields_of(lane)),
                                                 load<Pack<Real, 8>>(fields_of(lane + 4)));
        }
        out = detail::transpose8(pairs);
    } else if constexpr (W == 8) {
        for (std::size_t lane = 0; lane < 8; ++lane) {
            out[lane] = load<Pack<Real, 8>>(fields_of(lane));
        }
        out = detail::transpose8(out);
    } else if constexpr (W == 4) {
        for (std::size_t half = 0; half < 2; ++half) {
            std::array<Pack<Real, 4>, 4> part;
            for (std::size_t lane = 0; lane < 4; ++lane) {
                part[lane] = load<Pack<Real, 4>>(fields_of(lane) + 4 * half);
            }
            detail::transpose4(part);
            std::copy(part.begin(), part.end(), out.begin() + static_cast<std::ptrdiff_t>(4 * half));
        }
    } else {
        for (std::size_t f = 0; f < row_fields; ++f) {
            for (int lane = 0; lane < W; ++lane) {
                out[f][lane] = fields_of(static_cast<std::size_t>(lane))[f];
            }
        }
    }
    return out;
}

} // namespace slurry
