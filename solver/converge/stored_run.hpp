#pragma once
// What a finished run has stored, as one number over time for each quantity that may converge.
#include "solver/scene/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace slurry {

// Errors are told in percent of the largest value of their kind: a force that ought to be 0 has no percent of
// its own.
enum class Kind : std::uint8_t { energy, momentum, pressure, shear, velocity, spin, force, torque, position };

struct Quantity {
    std::string place; // "flow", the name of a probe or disc, or "discs" for the mean of many
    std::string name;  // "kinetic_energy", "shear_max", ...
    std::string unit;
    Kind kind;
    std::vector<double> time;  // s
    std::vector<double> value; // in the unit
};

struct RunCost {
    double fluid_particles = 0;
    double dummy_particles = 0;
    double steps = 0;
    double time_step = 0;    // s
    double wall_seconds = 0; // s
    [[nodiscard]] double particle_steps() const { return (fluid_particles + dummy_particles) * steps; }
};

struct StoredRun {
    RunCost cost;
    std::vector<Quantity> quantities;
};

// Whether there is such a file, a result or a checkpoint, and it is of a run of this very scene.
[[nodiscard]] bool is_file_of(const std::filesystem::path& file, const Scene& scene);

// Reads the result.h5 of a run of the scene. Pressures are what exceeds the fluid's mean (an incompressible
// pressure has no zero of its own), and a wall's largest and smallest are told from the wall's mean. Throws
// ReadError.
[[nodiscard]] StoredRun read_run(const std::filesystem::path& result, const Scene& scene);

} // namespace slurry
