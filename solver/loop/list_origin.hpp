#pragma once
#include <vector>

namespace slurry {

// What the neighbour lists were made from. With the particles' order, which stays until the next rebuild, it
// decides what is in the lists, in which order, and when they are made anew: the bits of every later sum.
struct ListOrigin {
    std::vector<double> x, y;               // m, of the fluid, then of the dummies
    std::vector<double> normal_x, normal_y; // of the dummies
    double time = 0;                        // s
    long rebuilds = 0;                      // since the start, this one included
};

} // namespace slurry
