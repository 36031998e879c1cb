#pragma once
// Which spacing, and how much time, a wanted error needs.
#include "solver/converge/study.hpp"

#include <string>
#include <vector>

namespace slurry {

struct Requirement {
    double spacing = 0;            // m; 0 when no smaller spacing is known to be enough
    double sound_speed_factor = 1; // times the scene's
};

// For a band of `error` (in the quantity's unit): half of it at most is left to the sound speed, whose error
// goes like 1 / c^2, the rest to the spacing. A quantity whose band is small enough already is not given a
// spacing beyond the coarsest that was run.
[[nodiscard]] Requirement requirement(const Assessment& quantity, double error);

struct Plan {
    double error = 0;                      // wanted, relative to the largest of its kind
    Requirement needs;                     // the strictest of those that can be met
    std::string strictest;                 // whose it is: "place name"
    std::vector<std::string> out_of_reach; // whom no spacing is known to bring there
    double particles = 0, steps = 0;
    double wall_seconds = 0; // s, with as many threads as the study had
};

// What all quantities together need. The wall time is that of the finest run times the ratios of its
// particles (fluid as 1 / spacing^2, dummies as 1 / spacing) and of the time steps of Eq. 2.35: 1 / spacing^3
// where sound limits the step, 1 / spacing^4 where viscosity does.
[[nodiscard]] Plan plan_for(const Study& study, double error);

} // namespace slurry
