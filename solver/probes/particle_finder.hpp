#pragma once
// The fluid at one instant as the probes see it, and the search for particles near a point.
#include "solver/scene/scene.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace slurry {

// Fluid particles only; equal lengths; SI units; positions wrapped into the domain along its periodic axes.
struct FluidView {
    std::span<const double> x, y, velocity_x, velocity_y, pressure;
};

struct NearParticle {
    std::size_t index; // into the FluidView
    Vector offset;     // m, from the point asked about to the particle (the periodic image that was found)
};

// Cells of particles, independent of the solver's own neighbour search because probes reach further. Valid as
// long as what the view refers to.
class ParticleFinder {
  public:
    // particle_spacing in m. Throws std::invalid_argument when the spans differ in length.
    ParticleFinder(const FluidView& fluid, const Domain& domain, double particle_spacing);

    [[nodiscard]] const FluidView& fluid() const { return fluid_; }
    [[nodiscard]] double particle_spacing() const { return particle_spacing_; }

    // Every particle nearer than radius (m), in an order that depends on the particles alone. Every periodic
    // image counts, also when the domain is narrower than the radius. A particle without a finite position is
    // never near.
    [[nodiscard]] std::vector<NearParticle> near(const Vector& point, double radius) const;

  private:
    using Cell = std::array<std::ptrdiff_t, 2>;
    [[nodiscard]] std::size_t cell_of(std::size_t particle) const;
    void add_cell(const Cell& unwrapped, const Vector& point, double radius,
                  std::vector<NearParticle>& found) const;

    FluidView fluid_;
    Domain domain_;
    double particle_spacing_;
    Cell count_{};
    Vector cell_size_;
    std::vector<std::size_t> first_; // [cell]: where its particles start in particles_; one more than cells
    std::vector<std::size_t> particles_; // ordered by cell, then by index
};

} // namespace slurry
