#pragma once
// What the viscous forces on the particles of a disc add to its torque because each acts half-way between two
// particles, not at the disc's: -1/2 sum_j r_ij x f_ij. The other forces act along r_ij and add nothing.
#include "solver/terms/pressure_force.hpp"

namespace slurry {

struct ViscousTwist {
    template <class P> struct Sums { P twist{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const ForceView<P>& i, const ForceView<P>& j) {
        sums.twist += force_weight(pair, i, j) * (pair.dx * (i.velocity_y() - j.velocity_y()) -
                                                  pair.dy * (i.velocity_x() - j.velocity_x()));
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const ForceView<P>& /*unused*/,
                       const ForceCoefficients<Real>& coefficients, Acceleration<P>& result) {
        result.twist -= Real{0.5} * coefficients.dynamic_viscosity * coefficients.inverse_mass * sums.twist;
    }
};

} // namespace slurry
