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
template <class P> struct Rate {
    P density_rate;
    P gradient_x, gradient_y; // of the density
};
template <class Real> struct RateCoefficients {
    Real diffusivity;      // delta h c
    Real diffusion_moment; // m of the fourth-order diffusion times its share
    Real density_slope_x;  // hydrostatic: rho0 f / c^2
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
    P twist; // of a disc's particle: torque per mass beyond that of the force at its place
};
template <class Real> struct ForceCoefficients {
    Real inverse_mass;
    Real dynamic_viscosity;
    Real background_pressure;
};

// Wall fits. A dummy's row holds the nearest point of the wall, the frame there, and the wall's velocity; a
// fluid particle's row is that of the forces.
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
    const P& pressure() const { return field[7]; }
};

// The same where solids turn: the row of a dummy has its depth as a vector along the normal, to make room for
// the spin.
template <class P> struct SpinningWallView : WallView<P> {
    P normal_x() const { return this->field[2] * inverse_depth(); }
    P normal_y() const { return this->field[3] * inverse_depth(); }
    P depth() const {
        return (this->field[2] * this->field[2] + this->field[3] * this->field[3]) * inverse_depth();
    }
    P inverse_depth() const {
        return inverse_square_root(P(this->field[2] * this->field[2] + this->field[3] * this->field[3]));
    }
    const P& spin() const { return this->field[6]; }
};

// Kernel means. A dummy's row holds the force per mass that the fluid feels in the frame of the solid there;
// a fluid particle's row is that of the forces.
template <class P> struct MeanView {
    Fields<P> field;
    const P& x() const { return field[0]; }
    const P& y() const { return field[1]; }
    const P& velocity_x() const { return field[2]; }
    const P& velocity_y() const { return field[3]; }
    const P& force_x() const { return field[2]; } // f - a_wall
    const P& force_y() const { return field[3]; }
    const P& volume() const { return field[6]; }
    const P& pressure() const { return field[7]; }
};

// Extrapolation to dummies: v_f and p_f averaged with the kernel as weight.
template <class P> struct Extrapolation {
    P velocity_x, velocity_y; // Shepard mean of the fluid's velocity
    P pressure;               // by a fit: of the fluid at the distance pressure_lever from the dummy
    P pressure_lever;         // along the normal, to the dummy: negative
    P pressure_gradient;      // along the normal, fitted
    P normal_curvature;       // second derivative, across the wall, of the velocity across it
    P fluid_share;            // of the room in front of a flat wall what fluid fills, weighted by distance
};
template <class Real> struct ExtrapolationCoefficients { Real mass; };

} // namespace slurry
