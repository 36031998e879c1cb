#pragma once
// The start of a scene: where the particles are and how they move.
#include "solver/geometry/region.hpp"
#include "solver/particles/particles.hpp"
#include "solver/scene/scene.hpp"

#include <span>
#include <vector>

namespace slurry {

// Fluid particles on a lattice, jittered or relaxed as the scene says, at the reference density, and the
// dummies of all walls and discs. All fluid particles have the same mass, so that their sum is the fluid's.
// Throws GeometryError (see place_discs).
Particles arrange_particles(const Scene& scene, const Region& region);

// Where the fluid's particles start: points of the lattice in the fluid and not in a disc, jittered if the
// scene says so; none in an empty box.
std::vector<Vector> fluid_points(const Scene& scene, const Region& region, std::span<const Disc> discs);

// Layers of dummies that complete the kernel's support: the first fluid row is half a spacing from the wall,
// and so is the first layer.
int dummy_layers(const Numerics& numerics);

} // namespace slurry
