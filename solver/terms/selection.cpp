#include "solver/terms/selection.hpp"

#include "solver/terms/density_diffusion.hpp"
#include "solver/terms/steady_frame.hpp"

#include <fmt/format.h>

namespace slurry {

TermSelection select_terms(const Scene& scene) {
    const Numerics& numerics = scene.numerics;
    TermSelection terms;
    terms.gradient_correction = numerics.gradient_correction;
    terms.density_diffusion = numerics.density_diffusion > 0;
    terms.hydrostatic_diffusion = terms.density_diffusion && scene.fluid.acceleration().squaredNorm() > 0;
    if (numerics.compressibility == Compressibility::steady_frame) {
        terms.pressure_frame = steady_frame(scene);
    }
    // Volumes that stay the same are those of one density, whose weights are equal.
    terms.density_weighted_pressure = numerics.pressure_mean == PressureMean::density_weighted &&
                                      numerics.particle_volume != ParticleVolume::constant;
    terms.viscosity = scene.fluid.dynamic_viscosity > 0;
    terms.transport_velocity = numerics.background_pressure_ratio > 0;
    terms.advection_tensor = terms.transport_velocity && numerics.advection_tensor;
    terms.discs = !scene.discs.empty();
    terms.walls = !scene.walls.empty() || terms.discs;
    return terms;
}

std::vector<TermReason> explain_terms(const Scene& scene) {
    const TermSelection terms = select_terms(scene);
    const Numerics& numerics = scene.numerics;
    return {
        {"continuity (2.14)", true, "always"},
        {"gradient correction (2.21, 2.22)", terms.gradient_correction,
         fmt::format("numerics.gradient_correction = {}", numerics.gradient_correction)},
        {"density diffusion (Molteni & Colagrossi 2009)", terms.density_diffusion,
         fmt::format("numerics.density_diffusion = {}, {:.3g} at this viscosity and spacing",
                     numerics.density_diffusion, effective_density_diffusion(scene.fluid, numerics))},
        {"hydrostatic part of the density diffusion", terms.hydrostatic_diffusion,
         terms.hydrostatic_diffusion ? "a body force acts on the fluid"
                                     : "no body force, or no density diffusion"},
        {"no compression by a pressure at rest in a frame", terms.pressure_frame.has_value(),
         terms.pressure_frame ? fmt::format("the frame moves with ({}, {}) m/s", terms.pressure_frame->x(),
                                            terms.pressure_frame->y())
         : numerics.compressibility == Compressibility::acoustic
             ? std::string("numerics.compressibility = acoustic")
             : std::string("rough walls that move apart, or discs: there is no such frame")},
        {"pressure force (2.15)", true, "always"},
        {"density weights of the mean pressure (2.15)", terms.density_weighted_pressure,
         terms.density_weighted_pressure ? "numerics.pressure_mean = density_weighted"
         : numerics.pressure_mean == PressureMean::density_weighted ? "numerics.particle_volume = constant"
                                                                    : "numerics.pressure_mean = plain"},
        {"viscous force (2.15)", terms.viscosity,
         fmt::format("fluid.dynamic_viscosity = {} Pa s", scene.fluid.dynamic_viscosity)},
        {"transport velocity (2.18, 2.19)", terms.transport_velocity,
         fmt::format("numerics.background_pressure_ratio = {}", numerics.background_pressure_ratio)},
        {"advection tensor (2.20)", terms.advection_tensor,
         terms.transport_velocity ? fmt::format("numerics.advection_tensor = {}", numerics.advection_tensor)
                                  : std::string("no transport velocity")},
        {numerics.wall_extrapolation == WallExtrapolation::fit ? "wall fit (in place of 2.16, 2.17)"
                                                               : "wall extrapolation (2.16, 2.17)",
         terms.walls,
         fmt::format("{} wall(s), {} disc(s) or groups of discs", scene.walls.size(), scene.discs.size())},
        {"rigid discs (2.23 to 2.28)", terms.discs,
         fmt::format("{} [[discs]]", scene.discs.empty() ? "no" : std::to_string(scene.discs.size()))},
    };
}

} // namespace slurry
