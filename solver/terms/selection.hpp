#pragma once
// Which terms a scene needs. The loops are composed from these at compile time
// (solver/loop/pair_interactions.hpp).
#include "solver/scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace slurry {

struct TermSelection {
    bool gradient_correction = false;
    bool density_diffusion = false;
    bool hydrostatic_diffusion = false;
    std::optional<Vector> pressure_frame; // velocity, m/s
    bool density_weighted_pressure = false;
    bool viscosity = false;
    bool transport_velocity = false;
    bool advection_tensor = false;
    bool walls = false; // or discs: dummies
    bool discs = false;
};

struct TermReason {
    std::string term;
    bool runs;
    std::string reason;
};

TermSelection select_terms(const Scene& scene);
// One entry per term, for `slurry info`.
std::vector<TermReason> explain_terms(const Scene& scene);

} // namespace slurry
