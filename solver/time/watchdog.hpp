#pragma once
// Stops a run that goes wrong before its numbers are taken for an answer.
#include "solver/geometry/region.hpp"
#include "solver/particles/particles.hpp"
#include "solver/particles/run_error.hpp"
#include "solver/scene/scene.hpp"

namespace slurry {

// Throws RunError when a fluid particle's state is not finite, its density is off by more than 10 %, or it is
// more than half a spacing behind a wall. The region is the scene's.
void check_particles(const Particles& particles, const Region& region, const Scene& scene, long step);

} // namespace slurry
