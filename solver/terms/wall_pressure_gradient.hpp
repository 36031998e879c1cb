#pragma once
// Gradient of the pressure at a wall. Fluid at a wall without slip moves with it, and walls do not
// accelerate, so that the momentum balance along the wall's normal n is dp/dn = rho f . n + mu d2 (v . n) /
// dn2.
#include "solver/scene/scene.hpp"

namespace slurry {

// Pa/m, along the normal into the fluid. `normal_curvature`: d2 (v . n) / dn2, 1/(m s).
inline double wall_pressure_gradient(const Fluid& fluid, const Vector& normal, double normal_curvature) {
    return fluid.density * fluid.acceleration().dot(normal) + fluid.dynamic_viscosity * normal_curvature;
}

} // namespace slurry
