#pragma once
// The two sweeps over pairs of a time step, timed on one core: density rate and forces.
#include "solver/bench/fma_peak.hpp"

#include <string>
#include <vector>

namespace slurry {

struct PairSweepTime {
    std::string arithmetic; // "float" or "double"
    std::string sweep;
    double ns_per_particle; // filling the rows and making the lists not included
    double pairs_useful;    // per particle: nearer than the kernel's support
    double pairs_evaluated; // per particle: those, the skin's, and what pads the lists
    int flops_per_pair;     // counted, solver/bench/counted.hpp
    double useful_gflops;   // of the useful pairs
    double share_of_fma_peak;
    double share_of_port_bound; // the bound's time for the evaluated pairs over the time taken
};

// On a jittered, doubly periodic lattice; `peak` is one for Real.
template <class Real> std::vector<PairSweepTime> time_pair_sweeps(const FmaPeak& peak, bool quick);

} // namespace slurry
