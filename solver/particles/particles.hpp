#pragma once
// State of a run, one array per quantity, in double precision and SI units.
#include "solver/particles/disc.hpp"
#include "solver/vector.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace slurry {

struct FluidParticles {
    double mass = 0;       // kg/m, of every particle
    double shift_time = 0; // s, half a time step: see shift()
    std::vector<double> x, y;
    std::vector<double> velocity_x, velocity_y;
    std::vector<double> acceleration_x, acceleration_y; // dv~/dt of Eq. 2.20
    std::vector<double> background_x, background_y;     // f_pb of Eq. 2.30, times -1 (an acceleration)
    std::vector<double> density, density_rate, pressure;
    std::vector<double> number_density_volume; // m2, of scenes that ask for it: see particle_volume()
    std::vector<std::uint32_t> identity; // position in the start's order; sorting moves particles, not this

    [[nodiscard]] std::size_t size() const { return x.size(); }
    // Eq. 2.30: how much faster than the fluid the particles move, v~ - v.
    [[nodiscard]] double shift_x(std::size_t i) const { return shift_time * background_x[i]; }
    [[nodiscard]] double shift_y(std::size_t i) const { return shift_time * background_y[i]; }
    void resize(std::size_t count);
    // Calls visit(vector) for every array of doubles that a step needs of the one before.
    template <class Visit> void each_array(Visit&& visit) { each_array_of(*this, visit); }
    [[nodiscard]] std::size_t bytes() const;

  private:
    template <class Self, class Visit> static void each_array_of(Self& self, Visit&& visit) {
        for (auto* array : {&self.x, &self.y, &self.velocity_x, &self.velocity_y, &self.acceleration_x,
                            &self.acceleration_y, &self.background_x, &self.background_y, &self.density,
                            &self.density_rate, &self.pressure}) {
            visit(*array);
        }
    }
};

// Particles of the walls (Sec. 2.3), then those of the discs (Sec. 2.5.1).
struct DummyParticles {
    std::vector<double> x, y;             // now
    std::vector<double> start_x, start_y; // of a wall's: at time 0; of a disc's: what wrapping has added
    std::vector<double> volume;           // m2, does not change
    std::vector<double> velocity_x, velocity_y; // extrapolated, Eq. 2.16
    std::vector<double> pressure;               // extrapolated, Eq. 2.17
    std::vector<double> normal_velocity;        // m/s, against the solid: see WallContinuity::solenoidal
    std::vector<double> fluid_share;            // see Extrapolation
    std::vector<double> solid_velocity_x, solid_velocity_y; // of the wall or disc, there (Eq. 2.26)
    std::vector<double> normal_x, normal_y; // of the surface at the nearest point, unit, into the fluid
    std::vector<double> start_normal_x, start_normal_y; // of a disc's, at angle 0
    std::vector<double> depth;                          // m, behind the surface
    std::vector<double> curvature;  // 1/m, of the surface there, positive towards the fluid
    std::vector<int> wall;          // index into the region's walls; beyond them, of a disc
    std::vector<Vector> wall_drift; // per wall, m/s: 0 where a wall slides along itself between fixed ends
    std::size_t first_of_discs = 0; // those before are of walls
    std::vector<double> force_x, force_y, twist; // of the discs' alone: by the fluid, N/m and N

    [[nodiscard]] std::size_t size() const { return x.size(); }
    [[nodiscard]] bool of_disc(std::size_t d) const { return d >= first_of_discs; }
    // Index of the disc that the dummy d belongs to.
    [[nodiscard]] std::size_t disc(std::size_t d) const {
        return static_cast<std::size_t>(wall[d]) - wall_drift.size();
    }
    void resize(std::size_t count);
    // Calls visit(array) for every array with an entry per dummy.
    template <class Visit> void each_array(Visit&& visit) { each_array_of(*this, visit); }
    // Puts every dummy of a wall where its wall has carried it.
    void move_walls_to(double time);
    [[nodiscard]] std::size_t bytes() const;

  private:
    template <class Self, class Visit> static void each_array_of(Self& self, Visit&& visit) {
        for (auto* array : {&self.x, &self.y, &self.start_x, &self.start_y, &self.volume, &self.velocity_x,
                            &self.velocity_y, &self.pressure, &self.normal_velocity, &self.fluid_share,
                            &self.solid_velocity_x, &self.solid_velocity_y, &self.normal_x, &self.normal_y,
                            &self.start_normal_x, &self.start_normal_y, &self.depth, &self.curvature}) {
            visit(*array);
        }
        visit(self.wall);
    }
};

struct Particles {
    FluidParticles fluid;
    DummyParticles dummies;
    std::vector<Disc> discs;
    double time = 0;
};

} // namespace slurry
