#pragma once
// Motion of the discs by Newton's law (Eqs. 2.24, 2.25) within the velocity-Verlet scheme of the fluid.
#include "solver/particles/particles.hpp"

namespace slurry {

// The discs as the scene wants them at the start; see place_discs().
struct PlacedDisc;
std::vector<Disc> make_discs(const std::vector<PlacedDisc>& placed, const Fluid& fluid);

// Half a step of velocity and spin by the forces of now; of free discs only.
void kick_discs(Particles& particles, double time);
// Half a step of position and angle; moves the discs' particles, too.
void drift_discs(Particles& particles, double time);

// Force and torque of each disc from those on its particles.
void sum_disc_forces(Particles& particles, const Fluid& fluid);

} // namespace slurry
