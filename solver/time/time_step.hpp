#pragma once
// Largest stable time step with discs.
#include "solver/particles/disc.hpp"
#include "solver/scene/fluid_time_step.hpp"

#include <cmath>
#include <numbers>
#include <span>

namespace slurry {

// That of Eq. 2.35 and of the discs, s. A contact of the given angular frequency (rad/s; 0: none) is
// resolved, and so is what a disc lighter than the fluid does: coupled explicitly, its drag and the fluid's
// stiffness act on its own small mass. The two factors are those up to which discs of 3 to 8 smoothing
// lengths and a hundredth to a third of the fluid's density ran quietly. The rate of the drag adds to the
// fluid's own: discs of 1.6 to 2.6 smoothing lengths and 0.6 to 2 times the fluid's density diverged from
// nu dt / h^2 = 1 / (1.1 + 5.7 / inertia) on, of which 0.8 are taken.
inline TimeStepBound time_step_bound(const Scene& scene, std::span<const Disc> discs,
                                     double contact_frequency) {
    constexpr double share_of_period = 1.0 / 12;
    constexpr double drag_factor = 0.14;
    constexpr double own_rate = 0.19; // of the fluid, over that of the drag at inertia 1
    constexpr double stiffness_factor = 1;
    const double h = scene.numerics.smoothing_length();
    const double viscosity = scene.fluid.kinematic_viscosity();
    TimeStepBound least = time_step_bound(scene);
    const auto bound_by = [&](double step, const char* cause) {
        if (step < least.step) {
            least = {step, cause};
        }
    };
    if (contact_frequency > 0) {
        bound_by(
            share_of_period * 2 * std::numbers::pi / contact_frequency,
            "the stiffest contact: a twelfth of its period; see contact.force_scale and contact.stiffness");
    }
    if (scene.start.arrangement == Arrangement::empty) {
        return least;
    }
    for (const Disc& disc : discs) {
        if (disc.free()) {
            const double inertia = disc.mass / (scene.fluid.density * disc.area()) * disc.radius / h;
            const double stiff = stiffness_factor * std::sqrt(inertia) * h / scene.numerics.sound_speed;
            const double dragged = drag_factor * inertia / (1 + own_rate * inertia) * h * h / viscosity;
            bound_by(stiff, "a light disc: its own mass against the fluid's stiffness");
            if (viscosity > 0) {
                bound_by(dragged, "a light or small disc: its own mass against the fluid's drag");
            }
        }
    }
    return least;
}

inline double largest_time_step(const Scene& scene, std::span<const Disc> discs, double contact_frequency) {
    return time_step_bound(scene, discs, contact_frequency).step;
}

} // namespace slurry
