#include "solver/bench/fma_peak.hpp"

#include "solver/loop/pack.hpp"
#include "solver/output/phase_clock.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace slurry {

namespace {

// Independent chains, each waiting for its own last result only: two units with a latency of four cycles need
// eight. With the factor they fit into 16 registers.
constexpr std::size_t chains = 12;

// The chains' sum, so that the work is needed. Every number goes towards 1.
template <class Real> Real multiply_and_add(std::int64_t rounds, Real half) {
    using P = Pack<Real, native_lanes<Real>>;
    std::array<P, chains> chain{};
    for (std::size_t k = 0; k < chains; ++k) {
        chain[k] += static_cast<Real>(k); // or all chains would be the same
    }
    for (std::int64_t round = 0; round < rounds; ++round) {
        for (P& link : chain) {
            link = link * half + half;
        }
    }
    Real total = 0;
    for (const P& link : chain) {
        std::array<Real, native_lanes<Real>> lanes{};
        store(lanes.data(), link);
        for (const Real lane : lanes) {
            total += lane;
        }
    }
    return total;
}

template <class Real> double gigaflops(int threads, std::int64_t rounds) {
    const volatile Real unknown = Real{0.5}; // or the compiler may calculate with it
    const Real half = unknown;
    Real total = 0;
    const double start = steady_seconds();
#pragma omp parallel num_threads(threads) reduction(+ : total)
    total += multiply_and_add<Real>(rounds, half);
    const double seconds = steady_seconds() - start;
    const double flops = 2.0 * static_cast<double>(rounds) * chains * native_lanes<Real> * threads;
    return total > 0 ? flops / seconds * 1e-9 : 0;
}

} // namespace

template <class Real> FmaPeak measure_fma_peak(int cores, bool quick) {
    const std::int64_t rounds = quick ? 20'000 : 2'000'000;
    const int repetitions = quick ? 3 : 20;
    FmaPeak best{0, 0};
    for (int repetition = 0; repetition < repetitions; ++repetition) {
        best.one_core = std::max(best.one_core, gigaflops<Real>(1, rounds));
        best.all_cores = std::max(best.all_cores, gigaflops<Real>(cores, rounds));
    }
    return best;
}

template FmaPeak measure_fma_peak<float>(int cores, bool quick);
template FmaPeak measure_fma_peak<double>(int cores, bool quick);

} // namespace slurry
