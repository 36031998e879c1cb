#pragma once
// The region that the fluid fills: the domain less what is behind its walls.
#include "solver/geometry/wall.hpp"

#include <array>
#include <vector>

namespace slurry {

class Region {
  public:
    // Builds the walls of the scene and checks them. Throws GeometryError: walls that cross, a domain side
    // that is neither periodic nor closed by a wall, a narrowest gap of fewer than 3 spacings, no fluid at
    // all.
    explicit Region(const Scene& scene);

    [[nodiscard]] const Domain& domain() const { return domain_; }
    [[nodiscard]] const std::vector<Wall>& walls() const { return walls_; }

    // Signed distance to the nearest wall at time 0 (positive in the fluid; infinite without walls).
    [[nodiscard]] double distance(const Vector& point) const;
    // The same at a later time, walls displaced.
    [[nodiscard]] double distance(const Vector& point, double time) const;
    // Area of the fluid, m2, by quadrature, relative error below 1e-8 (graphs) or exact (boxes of lines).
    [[nodiscard]] double fluid_area() const;
    // Smallest distance between two walls across the fluid, m (infinite with fewer than two walls).
    [[nodiscard]] double narrowest_gap() const;

    // Points of the lattice of cell centres that are in the fluid. The spacing per axis is the domain's size
    // divided by the nearest whole number of cells.
    [[nodiscard]] std::vector<Vector> lattice_points(double spacing) const;
    // Dummies of every wall; [w] belongs to walls()[w]. Those in the fluid, and those within half a spacing
    // of an earlier wall's, are left out.
    [[nodiscard]] std::vector<std::vector<Dummy>> dummies(DummyLayout layout, double spacing,
                                                          int layers) const;

  private:
    Domain domain_;
    std::vector<Wall> walls_;
};

} // namespace slurry
