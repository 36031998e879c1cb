#pragma once
// State of a run, one array per quantity, in double precision and SI units.
#include "solver/vector.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace slurry {

struct FluidParticles {
    double mass = 0; // kg/m, of every particle
    std::vector<double> x, y;
    std::vector<double> velocity_x, velocity_y;
    std::vector<double> shift_x, shift_y;               // advection velocity less velocity, v~ - v
    std::vector<double> acceleration_x, acceleration_y; // dv~/dt of Eq. 2.20
    std::vector<double> background_x, background_y;     // f_pb of Eq. 2.30, times -1 (an acceleration)
    std::vector<double> density, density_rate, pressure, volume;
    std::vector<std::uint32_t> identity; // position in the start's order; sorting moves particles, not this

    [[nodiscard]] std::size_t size() const { return x.size(); }
    void resize(std::size_t count);
    // Calls visit(vector) for every array of doubles.
    template <class Visit> void each_array(Visit&& visit) {
        for (auto* array :
             {&x, &y, &velocity_x, &velocity_y, &shift_x, &shift_y, &acceleration_x, &acceleration_y,
              &background_x, &background_y, &density, &density_rate, &pressure, &volume}) {
            visit(*array);
        }
    }
};

// Particles of the walls (Sec. 2.3).
struct DummyParticles {
    std::vector<double> x, y;                   // now
    std::vector<double> start_x, start_y;       // at time 0 (wrapped since, where that axis is periodic)
    std::vector<double> volume;                 // m2, does not change
    std::vector<double> velocity_x, velocity_y; // extrapolated, Eq. 2.16
    std::vector<double> pressure;               // extrapolated, Eq. 2.17
    std::vector<double> normal_x, normal_y;     // of the wall at the nearest point, unit, into the fluid
    std::vector<double> depth;                  // m, behind the wall
    std::vector<double> curvature;              // 1/m, of the wall there, positive towards the fluid
    std::vector<int> wall;                      // index into the region's walls
    std::vector<Vector> wall_velocity;          // per wall, m/s
    std::vector<Vector> wall_drift; // per wall, m/s: 0 where a wall slides along itself between fixed ends

    [[nodiscard]] std::size_t size() const { return x.size(); }
    void resize(std::size_t count);
    // Calls visit(vector) for every array with an entry per dummy.
    template <class Visit> void each_array(Visit&& visit) {
        for (auto* array : {&x, &y, &start_x, &start_y, &volume, &velocity_x, &velocity_y, &pressure,
                            &normal_x, &normal_y, &depth, &curvature}) {
            visit(*array);
        }
        visit(wall);
    }
    // Puts every dummy where its wall has carried it.
    void move_to(double time);
};

struct Particles {
    FluidParticles fluid;
    DummyParticles dummies;
    double time = 0;
};

} // namespace slurry
