#pragma once
// What this machine can do at most: fused multiply-adds on registers, measured.

namespace slurry {

struct FmaPeak {
    double one_core, all_cores; // Gflop/s
};

// With the vectors that this program was built for, as float or double; best of several repetitions.
// `cores`: number of threads for all_cores.
template <class Real> FmaPeak measure_fma_peak(int cores, bool quick);

} // namespace slurry
