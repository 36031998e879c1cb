#pragma once
// How far particles have moved against those near them since the neighbour lists were made. Only that makes a
// list incomplete: a shear flow carries distant particles apart at once, and near ones hardly.
#include "solver/particles/particles.hpp"
#include "solver/scene/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace slurry {

class DisplacementWatch {
  public:
    // Starts anew from the positions x, y (fluid, then dummies; wrapped into the domain; they must outlive
    // the watch). Pairs in the same cell or in two that touch are watched; of a dummy also those of its wall
    // point. Cells are counted from (0, 0), and a period is a whole number of them. Particles should be
    // sorted by their rows: those of a cell are then looked at together.
    void start(const Particles& particles, std::span<const double> x, std::span<const double> y,
               const Domain& domain, const Vector& cell_size);

    // Upper bound on the largest displacement of two near particles against each other since the start, m.
    [[nodiscard]] double largest(const Particles& particles) const;

  private:
    struct Box { // of displacements; empty at first
        double low_x, high_x, low_y, high_y;
        void include(const Box& other);
        [[nodiscard]] double squared_diagonal_with(const Box& other) const;
    };
    struct Run { // fluid particles in one cell, one after the other in memory
        std::uint32_t first, last, cell;
    };
    struct DiscPoint { // a particle of a disc, or its nearest point of the rim
        std::uint32_t cell;
        std::size_t dummy;
        double depth; // 0 for the particle itself
        Vector start;
    };
    struct WallCell {
        std::uint32_t cell;
        int wall;
        auto operator<=>(const WallCell&) const = default;
    };

    [[nodiscard]] std::uint32_t cell_of(double x, double y) const;
    [[nodiscard]] Box displacements(const FluidParticles& fluid, const Run& run) const;
    [[nodiscard]] double largest_squared_beside(std::span<const Box> cells, std::ptrdiff_t column,
                                                std::ptrdiff_t row) const;

    std::span<const double> start_x_, start_y_;
    double start_time_ = 0;
    Vector size_ = Vector::Ones(); // of a cell
    std::ptrdiff_t first_column_ = 0, first_row_ = 0, columns_ = 1, rows_ = 1;
    bool periodic_x_ = false, periodic_y_ = false;
    std::vector<Run> runs_;
    std::vector<WallCell> wall_cells_;
    std::vector<DiscPoint> disc_points_;
};

} // namespace slurry
