#pragma once
// Small weighted least-squares fits, many at once: one in each lane of P.
#include "solver/loop/pack.hpp"

#include <array>
#include <cstddef>

namespace slurry {

// Sums of a fit of N functions, and its solution.
template <class P, std::size_t N> struct NormalEquations {
    std::array<P, N*(N + 1) / 2> products{}; // sum weight f_i f_j, j <= i

    static constexpr std::size_t at(std::size_t i, std::size_t j) { return i * (i + 1) / 2 + j; }

    // Returns weight f_i, of which the right sides are made.
    std::array<P, N> add(const P& weight, const std::array<P, N>& functions) {
        std::array<P, N> weighted;
        for (std::size_t i = 0; i < N; ++i) {
            weighted[i] = weight * functions[i];
            for (std::size_t j = 0; j <= i; ++j) {
                products[at(i, j)] += weighted[i] * functions[j];
            }
        }
        return weighted;
    }
};

// The equations as L D L^T. Functions come in the order of their importance: one that those before it
// explain, as where too few particles are in reach, has no pivot and gets the coefficient 0.
template <class P, std::size_t N> class FactoredEquations {
  public:
    explicit FactoredEquations(const NormalEquations<P, N>& equations) {
        using Equations = NormalEquations<P, N>;
        constexpr auto least_pivot = static_cast<Element<P>>(1e-3);
        const P zero{};
        std::array<P, N> pivots{};
        for (std::size_t k = 0; k < N; ++k) {
            const P square = equations.products[Equations::at(k, k)];
            P pivot = square;
            for (std::size_t j = 0; j < k; ++j) {
                pivot -= lower_[k][j] * lower_[k][j] * pivots[j];
            }
            const auto independent = pivot > least_pivot * square;
            pivots[k] = independent ? pivot : zero;
            inverse_[k] = independent ? 1 / pivot : zero;
            for (std::size_t i = k + 1; i < N; ++i) {
                P sum = equations.products[Equations::at(i, k)];
                for (std::size_t j = 0; j < k; ++j) {
                    sum -= lower_[i][j] * lower_[k][j] * pivots[j];
                }
                lower_[i][k] = sum * inverse_[k];
            }
        }
    }

    // Coefficients for the right sides sum weight f_i value.
    [[nodiscard]] std::array<P, N> solve(std::array<P, N> right) const {
        for (std::size_t i = 0; i < N; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                right[i] -= lower_[i][j] * right[j];
            }
        }
        for (std::size_t i = N; i-- > 0;) {
            right[i] *= inverse_[i];
            for (std::size_t j = i + 1; j < N; ++j) {
                right[i] -= lower_[j][i] * right[j];
            }
        }
        return right;
    }

  private:
    std::array<std::array<P, N>, N> lower_{};
    std::array<P, N> inverse_{};
};

} // namespace slurry
