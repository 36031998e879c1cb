#pragma once
// Tait's equation of state, Eq. 2.11 [wang2014], gamma = 7.
#include <cmath>

namespace slurry {

struct EquationOfState {
    double reference_density; // kg/m3
    double sound_speed;       // m/s

    static constexpr int gamma = 7;

    [[nodiscard]] double stiffness() const { return reference_density * sound_speed * sound_speed / gamma; }

    [[nodiscard]] double pressure(double density) const {
        const double ratio = density / reference_density;
        const double cube = ratio * ratio * ratio;
        return stiffness() * (cube * cube * ratio - 1);
    }
    [[nodiscard]] double density(double pressure) const {
        return reference_density * std::pow(pressure / stiffness() + 1, 1.0 / gamma);
    }
};

} // namespace slurry
