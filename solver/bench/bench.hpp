#pragma once
// `slurry bench`: where this machine stands, and where the pair loops stand on it.
#include "solver/bench/fma_peak.hpp"
#include "solver/bench/pair_sweeps.hpp"
#include "solver/bench/search_times.hpp"

#include <string>
#include <vector>

namespace slurry {

struct BenchReport {
    std::string processor; // as /proc/cpuinfo has it, or "unknown"
    int cores;             // that this process may use
    FmaPeak float_peak, double_peak;
    std::vector<PairSweepTime> pair_sweeps;
    std::vector<SearchTime> searches;
};

// `quick`: too short to be accurate; shows that everything works.
BenchReport measure_machine(bool quick);
std::string bench_text(const BenchReport& report);
std::string bench_json(const BenchReport& report);

} // namespace slurry
