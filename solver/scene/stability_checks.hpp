#pragma once
// Numerics that cannot end well, whatever the flow.
#include "solver/scene/checks.hpp"

#include <string>
#include <vector>

namespace slurry {

// Throws SceneError where the time step (Eq. 2.35) is beyond the limit of the explicit scheme for sound,
// viscosity, density diffusion or extrapolated velocities, vortices do not fit into
// their periodic domain, or a disc starts so fast that the fluid in its way is compressed beyond what the
// watchdog lets pass.
void check_stability(const Scene& scene, const Places& places);

// One line where the cell Reynolds number, fastest wall * particle_spacing / kinematic viscosity, is more
// than what is known to be accurate; none where no wall moves.
[[nodiscard]] std::vector<std::string> check_cell_reynolds(const Scene& scene, const Places& places);

} // namespace slurry
