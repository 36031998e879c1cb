#pragma once
// Rows: what a pair needs of one particle, eight numbers side by side in memory, written once per pass and
// then only read. One neighbour costs one cache line in double, and W of them are transposed in registers.
#include "solver/loop/pack.hpp"

#include <array>
#include <cstdint>

namespace slurry {

inline constexpr int row_fields = 8;

template <class Real> struct alignas(row_fields * sizeof(Real)) Row { std::array<Real, row_fields> field; };

template <class P> using Fields = std::array<P, row_fields>;

namespace detail {

// Transposes `rows`, W vectors of W numbers, for W = 4 or 8.
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

template <class P> void transpose8(std::array<P, 8>& r) {
    std::array<P, 8> t;
    for (std::size_t k = 0; k < 8; k += 2) {
        t[k] = __builtin_shufflevector(r[k], r[k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
        t[k + 1] = __builtin_shufflevector(r[k], r[k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
    for (std::size_t k = 0; k < 8; k += 4) {
        for (std::size_t odd = 0; odd < 2; ++odd) {
            const P a = t[k + odd];
            const P b = t[k + odd + 2];
            r[k + odd] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
            r[k + odd + 2] = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
        }
    }
    for (std::size_t k = 0; k < 4; ++k) {
        const P a = r[k];
        const P b = r[k + 4];
        r[k] = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
        r[k + 4] = __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

} // namespace detail

// The rows with the given W indices, field by field.
template <class Real, int W>
Fields<Pack<Real, W>> gather(const Row<Real>* rows, const std::uint32_t* indices) {
    Fields<Pack<Real, W>> out;
    if constexpr (W == 1) {
        out = rows[indices[0]].field;
    } else if constexpr (W == 8) {
        for (std::size_t lane = 0; lane < 8; ++lane) {
            out[lane] = load<Pack<Real, 8>>(rows[indices[lane]].field.data());
        }
        detail::transpose8(out);
    } else if constexpr (W == 4) {
        for (std::size_t half = 0; half < 2; ++half) {
            std::array<Pack<Real, 4>, 4> part;
            for (std::size_t lane = 0; lane < 4; ++lane) {
                part[lane] = load<Pack<Real, 4>>(rows[indices[lane]].field.data() + 4 * half);
            }
            detail::transpose4(part);
            std::copy(part.begin(), part.end(), out.begin() + static_cast<std::ptrdiff_t>(4 * half));
        }
    } else {
        for (std::size_t f = 0; f < row_fields; ++f) {
            for (int lane = 0; lane < W; ++lane) {
                out[f][lane] = rows[indices[lane]].field[f];
            }
        }
    }
    return out;
}

} // namespace slurry
