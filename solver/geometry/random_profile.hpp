#pragma once
// A random rough profile, the same on every machine.
#include "solver/scene/scene.hpp"

#include <vector>

namespace slurry {

struct Harmonic {
    double wavenumber; // 1/m
    double amplitude;  // m
    double phase;      // rad
};

// The heights' harmonics over a period (m): mean_height + sum of amplitude cos(wavenumber (x - x0) + phase).
//
// The amplitudes are those of the correlation rms_height^2 exp(-(r / correlation_length)^2), scaled to
// exactly the RMS height over the period; the phases are random, from SplitMix64 (steele2014), whose
// integers do not depend on a library.
std::vector<Harmonic> harmonics(const RandomShape& shape, double period);

} // namespace slurry
