#pragma once
// The names of a row's fields in each pass, and what each pass gives back, in the units of
// solver/loop/units.hpp.
#include "solver/loop/row.hpp"

namespace slurry {

// Density rate (half step). fluid_volume is 0 for dummies: terms between fluid particles only are weighted
// with it.
template <class P> struct RateView {
    Fields<P> field;
    const P& x() const { return field[0]; }
    const P& y() const { return field[1]; }
    const P& velocity_x() const { return field[2]; }
    const P& velocity_y() const { return field[3]; }
    const P& volume() const { return field[4]; } // m / rho
    const P& density() const { return field[5]; }
    const P& fluid_volume() const { return field[6]; }
};
template <class P> struct Rate { P density_rate; };
template <class Real> struct RateCoefficients {
    Real diffusivity;     // delta h c
    Real density_slope_x; // hydrostatic: rho0 f / c^2
    Real density_slope_y;
};

// Volumes (full step).
template <class P> struct VolumeView {
    Fields<P> field;
    const P& x() const { return field[0]; }
    const P& y() const { return field[1]; }
    const P& weight() const { return field[2]; } // volume / particle_spacing^2 for dummies, 1 for fluid
};
template <class P> struct Volume { P volume; };
template <class Real> struct VolumeCoefficients {
    Real self_kernel; // W(0)
};

// Forces and wall extrapolation (full step).
template <class P> struct ForceView {
    Fields<P> field;
    const P& x() const { return field[0]; }
    const P& y() const { return field[1]; }
    const P& velocity_x() const { return field[2]; }
    const P& velocity_y() const { return field[3]; }
    const P& shift_momentum_x() const {
        return field[4];
    } // rho (advection velocity - velocity); 0 for dummies
    const P& shift_momentum_y() const { return field[5]; }
    const P& volume() const { return field[6]; }
    const P& pressure() const { return field[7]; }
};
template <class P> struct Acceleration {
    P x, y;                       // of the momentum equation
    P background_x, background_y; // by the background pressure
};
template <class Real> struct ForceCoefficients {
    Real inverse_mass;
    Real dynamic_viscosity;
    Real background_pressure;
};

// Wall fits. A dummy's row holds the nearest point of the wall, the frame there, and the wall's velocity; a
// fluid particle's row its velocity and pressure.
template <class P> struct WallView {
    Fields<P> field;
    const P& x() const { return field[0]; }
    const P& y() const { return field[1]; }
    const P& normal_x() const { return field[2]; } // into the fluid
    const P& normal_y() const { return field[3]; }
    const P& wall_velocity_x() const { return field[4]; }
    const P& wall_velocity_y() const { return field[5]; }
    const P& depth() const { return field[6]; }
    const P& half_curvature() const { return field[7]; }
    const P& velocity_x() const { return field[2]; }
    const P& velocity_y() const { return field[3]; }
    const P& pressure() const { return field[4]; }
};

// Extrapolation to dummies: v_f and p_f averaged with the kernel as weight.
template <class P> struct Extrapolation {
    P velocity_x, velocity_y; // Shepard mean of the fluid's velocity
    P pressure;
    P kernel_sum; // 0: no fluid within reach, and the means are 0
};
template <class Real> struct ExtrapolationCoefficients {
    Real mass;
    Real force_x, force_y; // f - a_wall
};

} // namespace slurry
