#include "solver/discs/crowd.hpp"

#include "solver/discs/nearest_image.hpp"

#include <algorithm>
#include <cmath>

namespace slurry {
namespace {

constexpr double overlap_rounding = 1e-9; // radii that discs placed side by side may overlap by
constexpr double most_cells = 1000;       // along an axis: enough for the discs that a scene may have

} // namespace

Crowd::Crowd(const Domain& domain, double largest_radius, double largest_distance) : domain_(domain) {
    const double reach = 2 * largest_radius + largest_distance;
    for (int axis = 0; axis < 2; ++axis)
        cells_[static_cast<std::size_t>(axis)] =
            static_cast<int>(std::clamp(std::floor(domain.size()[axis] / reach), 1.0, most_cells));
    members_.resize(static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]));
}

std::array<int, 2> Crowd::cell_of(const Vector& centre) const {
    std::array<int, 2> cell{};
    for (int axis = 0; axis < 2; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double share = (centre[axis] - domain_.lower[axis]) / domain_.size()[axis];
        cell[a] = static_cast<int>(std::clamp(share * cells_[a], 0.0, cells_[a] - 1.0));
    }
    return cell;
}

void Crowd::add(const Rim& rim) {
    const auto [i, j] = cell_of(rim.centre);
    members_[static_cast<std::size_t>(j * cells_[0] + i)].push_back(rims_.size());
    rims_.push_back(rim);
}

double Crowd::gap(const Rim& one, std::size_t other) const {
    return nearest_image(rims_[other].centre - one.centre, domain_).norm() - one.radius - rims_[other].radius;
}

std::optional<std::size_t> Crowd::too_near(const Rim& rim) const {
    const auto [columns, rows] = cells_;
    const auto [column, row] = cell_of(rim.centre);
    // The cell and those next to it, each once; beyond sides that are not periodic they are only far away.
    for (int dj = 0; dj < std::min(rows, 3); ++dj)
        for (int di = 0; di < std::min(columns, 3); ++di) {
            const int i = (column + columns - 1 + di) % columns;
            const int j = (row + rows - 1 + dj) % rows;
            for (const std::size_t other : members_[static_cast<std::size_t>(j * columns + i)]) {
                const double least = std::max(rim.least_distance, rims_[other].least_distance);
                if (!(gap(rim, other) >= least - overlap_rounding * rim.radius))
                    return other;
            }
        }
    return std::nullopt;
}

} // namespace slurry
