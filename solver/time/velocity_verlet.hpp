#pragma once
// One time step of the modified velocity-Verlet scheme, Algorithm 1 and Eqs. 2.29 to 2.34 [wang2014,
// adami2013].
#include "solver/discs/contact.hpp"
#include "solver/loop/interactions.hpp"
#include "solver/output/phase_clock.hpp"
#include "solver/particles/particles.hpp"
#include "solver/scene/scene.hpp"

namespace slurry {

// What moves the particles.
struct Forces {
    Interactions& interactions;
    DiscContacts& contacts;
    Fluid fluid;
    double sound_speed; // m/s
    bool keep_mean_density = false;
};

// Accelerations of the start; needed once before the first step, which is to have this length, s.
void prepare_first_step(Particles& particles, Forces& forces, double time_step, PhaseClock& clock);

// Advances the particles by one step of the given length, s.
void advance(Particles& particles, Forces& forces, double time_step, PhaseClock& clock);

} // namespace slurry
