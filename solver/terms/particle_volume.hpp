#pragma once
// Volume of a fluid particle, m2: m / rho0, m / rho, or 1 / sum W (below Eq. 2.8 [wang2014, hu2006]; its sum
// is solver/terms/number_density.hpp), as the scene says.
#include "solver/particles/particles.hpp"
#include "solver/scene/scene.hpp"

namespace slurry {

inline double particle_volume(const FluidParticles& fluid, std::size_t i, ParticleVolume kind,
                              double reference_density) {
    switch (kind) {
    case ParticleVolume::constant:
        return fluid.mass / reference_density;
    case ParticleVolume::mass_over_density:
        return fluid.mass / fluid.density[i];
    case ParticleVolume::number_density:
        break;
    }
    return fluid.number_density_volume[i];
}

} // namespace slurry
