#pragma once
// How long a neighbour search takes, on points as a solver would hold them.
#include "solver/scene/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace slurry {

// A lattice of spacing 1, each point displaced; or clusters on as large a plane, more crowded, but not the
// more so the more points. Both are sorted as the solver sorts its particles.
enum class PointSet : std::uint8_t { uniform, clustered };

// The kernel's reach and the lists' skin, in particle spacings.
inline constexpr double search_timing_cutoff = 3.35;

struct TimingPoints {
    std::vector<double> x, y;
};
TimingPoints timing_points(PointSet set, std::size_t count);

// Seconds for one build of the neighbour lists of all points for the solver's pair loop, with as many threads
// as OpenMP gives: the median of the repetitions, after one that allocates. Throws std::invalid_argument if
// there are none.
double time_search(NeighbourSearch search, std::size_t points, PointSet set, int repetitions);

} // namespace slurry
