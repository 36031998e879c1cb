#pragma once
// A rigid disc (Sec. 2.5.1) as a point mass with an orientation; its particles are among the dummies.
#include "solver/scene/scene.hpp"

#include <numbers>
#include <string>

namespace slurry {

struct Disc {
    std::string name;
    DiscMotion motion = DiscMotion::free;
    double radius = 0;              // m
    double mass = 0;                // kg/m
    double moment_of_inertia = 0;   // kg m, about the centre
    Vector weight = Vector::Zero(); // N/m: by gravity, less buoyancy where the fluid's pressure has none

    Vector position = Vector::Zero(); // m, of the centre, never wrapped
    double angle = 0;                 // rad, anticlockwise, since the start
    Vector velocity = Vector::Zero(); // m/s
    double spin = 0;                  // rad/s

    Vector force = Vector::Zero();         // N/m, by the fluid (Eq. 2.24)
    double torque = 0;                     // N, by the fluid (Eq. 2.25)
    Vector contact_force = Vector::Zero(); // N/m, by discs and walls (Eqs. 2.27, 2.28)

    [[nodiscard]] double area() const { return std::numbers::pi * radius * radius; } // m2
    [[nodiscard]] bool free() const { return motion == DiscMotion::free; }
    [[nodiscard]] Vector acceleration() const {
        return free() ? Vector((force + contact_force + weight) / mass) : Vector::Zero();
    }
    [[nodiscard]] double angular_acceleration() const { return free() ? torque / moment_of_inertia : 0; }
};

} // namespace slurry
