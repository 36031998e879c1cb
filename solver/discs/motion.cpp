#include "solver/discs/motion.hpp"

#include "solver/discs/disc_dummies.hpp"
#include "solver/discs/placement.hpp"

namespace slurry {

std::vector<Disc> make_discs(const std::vector<PlacedDisc>& placed, const Fluid& fluid) {
    std::vector<Disc> discs;
    for (const PlacedDisc& from : placed) {
        Disc disc;
        disc.name = from.name;
        disc.motion = from.motion;
        disc.radius = from.radius;
        disc.mass = from.mass();
        disc.moment_of_inertia = from.moment_of_inertia();
        disc.position = from.centre;
        disc.velocity = from.velocity;
        disc.spin = from.spin;
        const double displaced = fluid.hydrostatics == Hydrostatics::full ? 0 : fluid.density * disc.area();
        disc.weight = (disc.mass - displaced) * fluid.gravity;
        discs.push_back(std::move(disc));
    }
    return discs;
}

void kick_discs(Particles& particles, double time) {
    for (Disc& disc : particles.discs) {
        disc.velocity += time * disc.acceleration();
        disc.spin += time * disc.angular_acceleration();
    }
}

void drift_discs(Particles& particles, double time) {
    for (Disc& disc : particles.discs) {
        disc.position += time * disc.velocity;
        disc.angle += time * disc.spin;
    }
    move_disc_dummies(particles);
}

void sum_disc_forces(Particles& particles, const Fluid& fluid) {
    for (Disc& disc : particles.discs) {
        disc.force.setZero();
        if (particles.fluid.size() == 0) {
            disc.torque = 0;
            continue;
        }
        // Eq. 2.15 diffuses each component of the velocity: its traction is eta dv/dn. What the rest of the
        // stress, eta (grad v)^T . n, does to a body that does not slip follows from its spin alone: no net
        // force, and this torque. Without it a free disc in a shear flow turns at twice the right rate.
        disc.torque = -2 * fluid.dynamic_viscosity * disc.area() * disc.spin;
    }
    const DummyParticles& dummies = particles.dummies;
    for (std::size_t d = dummies.first_of_discs; d < dummies.size(); ++d) {
        Disc& disc = particles.discs[dummies.disc(d)];
        const std::size_t k = d - dummies.first_of_discs;
        const double distance = disc.radius - dummies.depth[d];
        disc.force += Vector(dummies.force_x[k], dummies.force_y[k]);
        disc.torque +=
            distance * (dummies.normal_x[d] * dummies.force_y[k] - dummies.normal_y[d] * dummies.force_x[k]) +
            dummies.twist[k];
    }
}

} // namespace slurry
