#pragma once
// What walls that start at once give an incompressible fluid: a potential flow, from the first moment on.
#include "solver/geometry/region.hpp"
#include "solver/particles/disc.hpp"

#include <array>
#include <span>
#include <vector>

namespace slurry {

// Cells of a domain, row by row. The face that is across an axis and has a cell's index is the cell's lower
// one.
struct FaceGrid {
    FaceGrid(const Domain& covered, double particle_spacing);

    [[nodiscard]] int count() const { return cells[0] * cells[1]; }
    // Of a cell, at most one beyond the grid; -1 if that is beyond a side that is not periodic.
    [[nodiscard]] int index(int i, int j) const;
    // In units of cells from the lower left corner.
    [[nodiscard]] Vector place(double i, double j) const;

    Domain domain;
    std::array<int, 2> cells{};
    Vector size; // m, of a cell
};

// The change of velocity by the pressure's impulse (batchelor1967), the gradient of a potential: across their
// surfaces walls, and discs that are held, have the fluid's velocity. Free discs count as fluid. Solved by
// finite volumes with the particle spacing, whose faces are open as far as they are in the fluid (ng2009).
class WallImpulse {
  public:
    // None without fluid, where start.impulse is off, or where no wall moves against the fluid across its
    // surface.
    WallImpulse(const Scene& scene, const Region& region, std::span<const Disc> discs);

    [[nodiscard]] bool none() const { return faces_[0].empty(); }
    // Of the fluid at a place in the domain, m/s.
    [[nodiscard]] Vector velocity(const Vector& position) const;

  private:
    [[nodiscard]] double component(std::size_t axis, const Vector& position) const;

    FaceGrid grid_;
    std::array<std::vector<double>, 2> faces_; // m/s, across x and y, NaN where closed; empty: no impulse
};

} // namespace slurry
