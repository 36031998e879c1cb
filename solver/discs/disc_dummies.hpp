#pragma once
// The particles of the discs: where they lie in a disc, and where it has carried them (Eq. 2.26).
#include "solver/particles/particles.hpp"

#include <vector>

namespace slurry {

// A particle of a disc, seen from its centre at angle 0.
struct DiscPoint {
    Vector position; // m
    double volume;   // m2
};

// Particles down to `layers` spacings beneath the rim: deeper ones are out of the fluid's reach. On rings,
// each of whole spacings nearly, their volumes add up to the area that they stand for; on a lattice about the
// centre, as the paper has it, each has the square of a spacing. Adapted: rings for discs so small that the
// squares' area is more than 10 % off theirs, where fluid would come into holes of the rim; else the lattice,
// whose torque is nearer to the truth (verification/accuracy.md).
std::vector<DiscPoint> disc_points(double radius, DiscDummies arrangement, double particle_spacing,
                                   int layers);

// Appends the particles of all discs to the dummies, in the order of the discs, and moves them to their
// places.
void append_disc_dummies(Particles& particles, DiscDummies arrangement, double particle_spacing, int layers);

// Eq. 2.26: places, normals and velocities of the discs' particles from the discs'.
void move_disc_dummies(Particles& particles);

} // namespace slurry
