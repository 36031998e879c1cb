#pragma once
// Stops a run that goes wrong before its numbers are taken for an answer.
#include "solver/geometry/region.hpp"
#include "solver/particles/particles.hpp"
#include "solver/particles/run_error.hpp"
#include "solver/scene/scene.hpp"

namespace slurry {

// Throws RunError when a fluid particle's or a disc's state is not finite, a density is off by more than 10
// %, or a fluid particle is more than half a spacing behind a wall or in a disc. The region is the scene's.
void check_particles(const Particles& particles, const Region& region, const Scene& scene, long step);

// Does so after a step of the run if that is due: finite states and densities often, and after steps 1, 2, 4
// and so on for a start that overshoots, all of it seldom. By the step alone, so that a resumed run ends
// where one left alone would.
void watch(const Particles& particles, const Region& region, const Scene& scene, long step, long steps);

} // namespace slurry
