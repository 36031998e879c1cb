#pragma once
// Discs that have their places, to be searched for those near one more.
#include "solver/scene/scene.hpp"

#include <array>
#include <optional>
#include <vector>

namespace slurry {

// What the search has to know of a disc.
struct Rim {
    Vector centre;         // m, in the domain
    double radius;         // m
    double least_distance; // m, from other rims; of two discs the larger one counts
};

class Crowd {
  public:
    // For discs whose radii and least distances are at most these, m.
    Crowd(const Domain& domain, double largest_radius, double largest_distance);

    void add(const Rim& rim);
    // The first disc found that is nearer than it may be, by its number in the order of add(). Distances are
    // to the nearest periodic image.
    [[nodiscard]] std::optional<std::size_t> too_near(const Rim& rim) const;
    // Between the rims, negative where they overlap, m.
    [[nodiscard]] double gap(const Rim& one, std::size_t other) const;

  private:
    [[nodiscard]] std::array<int, 2> cell_of(const Vector& centre) const;

    Domain domain_;
    std::array<int, 2> cells_{};
    std::vector<Rim> rims_;
    std::vector<std::vector<std::size_t>> members_; // of each cell
};

} // namespace slurry
