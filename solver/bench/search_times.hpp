#pragma once
// How long the neighbour searches take, against the number of points.
#include <cstddef>
#include <string>
#include <vector>

namespace slurry {

struct SearchTime {
    std::string search, set; // as in a scene; uniform or clustered
    std::size_t points;
    int threads;
    double seconds; // for one build of all lists
};

// Every search on both sets, from 1e3 to 4e6 points (`quick`: 1e3 only), with one thread; the solver's own
// search also with `cores` threads. The plane sweep stops at 1e6: it takes ten times as long.
std::vector<SearchTime> time_searches(int cores, bool quick);

} // namespace slurry
