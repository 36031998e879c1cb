#include "solver/particles/wall_impulse.hpp"

#include "solver/discs/clearance.hpp"
#include "solver/particles/start_jump.hpp"
#include "solver/scene/start_velocity.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <tuple>

namespace slurry {

FaceGrid::FaceGrid(const Domain& covered, double particle_spacing) : domain(covered), size(covered.size()) {
    constexpr double most_cells = 2.5e5; // a few seconds; the flow is smoother than particles are small
    const double wanted = std::max(particle_spacing, std::sqrt(size.prod() / most_cells));
    for (const int axis : {0, 1}) {
        int& along = cells[static_cast<std::size_t>(axis)];
        along = std::max(1, static_cast<int>(std::lround(size[axis] / wanted)));
        size[axis] /= along;
    }
}

int FaceGrid::index(int i, int j) const {
    std::array<int, 2> at{i, j};
    for (const std::size_t axis : {0U, 1U}) {
        if (domain.periodic[axis]) {
            at[axis] = (at[axis] + cells[axis]) % cells[axis];
        } else if (at[axis] < 0 || at[axis] >= cells[axis]) {
            return -1;
        }
    }
    return at[1] * cells[0] + at[0];
}

Vector FaceGrid::place(double i, double j) const {
    return domain.lower + Vector(i * size.x(), j * size.y());
}

namespace {

// Share of a face in the fluid, from the distances of its ends to the nearest solid (m, negative in it).
double open_share(double from, double to) {
    const double larger = std::max(from, to);
    const double smaller = std::min(from, to);
    return larger <= 0 ? 0 : smaller >= 0 ? 1 : larger / (larger - smaller);
}

// Of the wall, or the disc that is held, m/s. A disc's spin takes nothing across its rim.
Vector velocity_of_nearest(const Region& region, std::span<const Disc> held, const Vector& place) {
    Vector nearest = Vector::Zero();
    double least = std::numeric_limits<double>::infinity();
    for (const Wall& wall : region.walls()) {
        if (const double distance = wall.nearest(place).distance; distance < least) {
            least = distance;
            nearest = wall.velocity();
        }
    }
    for (const Disc& disc : held) {
        if (const double distance = clearance({&disc, 1}, region.domain(), place); distance < least) {
            least = distance;
            nearest = disc.velocity;
        }
    }
    return nearest;
}

// Distances from the corners of the cells to the nearest solid, m: one more a row, and a column, than cells.
Eigen::ArrayXXd corner_distances(const FaceGrid& grid, const Region& region, std::span<const Disc> held) {
    Eigen::ArrayXXd distances(grid.cells[0] + 1, grid.cells[1] + 1);
    for (int j = 0; j <= grid.cells[1]; ++j) {
        for (int i = 0; i <= grid.cells[0]; ++i) {
            const Vector corner = grid.place(i, j);
            distances(i, j) = std::min(region.distance(corner), clearance(held, grid.domain, corner));
        }
    }
    return distances;
}

// As much fluid leaves a cell as enters it: over its faces, sum open length * n . (grad phi + u - U) = 0,
// where u is of the start and U of the solid that is nearest to the cell.
class Potential {
  public:
    Potential(const FaceGrid& grid, const Scene& scene, const Region& region, std::span<const Disc> held)
        : grid_(grid), scene_(scene), solids_(static_cast<std::size_t>(grid.count()), Vector::Zero()),
          outflow_(Eigen::VectorXd::Zero(grid.count())) {
        const Eigen::ArrayXXd distances = corner_distances(grid, region, held);
        for (int j = 0; j < grid.cells[1]; ++j) {
            for (int i = 0; i < grid.cells[0]; ++i) {
                if (distances.block<2, 2>(i, j).minCoeff() < grid.size.norm()) {
                    solids_[static_cast<std::size_t>(grid.index(i, j))] =
                        velocity_of_nearest(region, held, grid.place(i + 0.5, j + 0.5));
                }
            }
        }
        for (int j = 0; j < grid.cells[1]; ++j) {
            for (int i = 0; i < grid.cells[0]; ++i) {
                const double corner = distances(i, j);
                add_face(0, grid.index(i - 1, j), grid.index(i, j), grid.place(i, j + 0.5),
                         open_share(corner, distances(i, j + 1)));
                add_face(1, grid.index(i, j - 1), grid.index(i, j), grid.place(i + 0.5, j),
                         open_share(corner, distances(i + 1, j)));
            }
        }
    }

    // Its gradient across the open faces, by axis and index, m/s.
    [[nodiscard]] std::array<std::vector<double>, 2> gradient() {
        const Eigen::VectorXd potential = solve();
        std::array<std::vector<double>, 2> gradients;
        gradients.fill(std::vector<double>(solids_.size(), std::numeric_limits<double>::quiet_NaN()));
        for (const Face& face : faces_) {
            gradients[face.axis][static_cast<std::size_t>(face.upper)] =
                (potential[face.upper] - potential[face.lower]) / grid_.size[static_cast<int>(face.axis)];
        }
        return gradients;
    }

  private:
    struct Face { // an open one, between two cells
        std::size_t axis;
        int lower, upper;
    };

    void add_face(std::size_t axis, int lower, int upper, const Vector& centre, double share) {
        constexpr double least_share = 1e-3; // what flows through less would ask for too exact a potential
        if (share < least_share || lower < 0) {
            return;
        }
        faces_.push_back({axis, lower, upper});
        const auto along = static_cast<int>(axis);
        const double length = share * grid_.size[1 - along];
        const Vector fluid = start_velocity(scene_, centre);
        for (const auto& [cell, other, outward] :
             {std::tuple(lower, upper, 1.0), std::tuple(upper, lower, -1.0)}) {
            const Vector solid = solids_[static_cast<std::size_t>(cell)];
            outflow_[cell] += outward * length * (fluid - solid)[along];
            const double coefficient = length / grid_.size[along];
            coefficients_.emplace_back(cell, cell, coefficient);
            coefficients_.emplace_back(cell, other, -coefficient);
        }
    }

    [[nodiscard]] Eigen::VectorXd solve() {
        // A trace of compressibility: the potential has an arbitrary constant, and none in cells without a
        // face.
        constexpr double trace = 1e-9;
        for (int cell = 0; cell < grid_.count(); ++cell) {
            coefficients_.emplace_back(cell, cell, trace);
        }
        Eigen::SparseMatrix<double> matrix(grid_.count(), grid_.count());
        matrix.setFromTriplets(coefficients_.begin(), coefficients_.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
        return solver.solve(outflow_);
    }

    const FaceGrid& grid_;
    const Scene& scene_;
    std::vector<Vector> solids_; // their velocities by cell; 0 where none is near, and all would cancel
    std::vector<Face> faces_;
    std::vector<Eigen::Triplet<double>> coefficients_;
    Eigen::VectorXd outflow_; // m2/s, by cell
};

} // namespace

WallImpulse::WallImpulse(const Scene& scene, const Region& region, std::span<const Disc> discs)
    : grid_(scene.domain, scene.numerics.particle_spacing) {
    constexpr double trifle = 1e-9; // of the sound speed: rounding
    if (!scene.start.impulse || scene.start.arrangement == Arrangement::empty ||
        largest_jump_across(scene, region.walls()).speed <= trifle * scene.numerics.sound_speed) {
        return;
    }
    std::vector<Disc> held;
    std::ranges::copy_if(discs, std::back_inserter(held), std::not_fn(&Disc::free));
    faces_ = Potential(grid_, scene, region, held).gradient();
}

Vector WallImpulse::velocity(const Vector& position) const {
    return none() ? Vector::Zero() : Vector(component(0, position), component(1, position));
}

// Linear between the four nearest faces, less those that are closed.
double WallImpulse::component(std::size_t axis, const Vector& position) const {
    Vector at = (position - grid_.domain.lower).cwiseQuotient(grid_.size);
    at[axis == 0 ? 1 : 0] -= 0.5;
    const Vector corner = at.array().floor();
    double total = 0;
    double weights = 0;
    for (const int i : {0, 1}) {
        for (const int j : {0, 1}) {
            const int index = grid_.index(static_cast<int>(corner.x()) + i, static_cast<int>(corner.y()) + j);
            const double velocity = index < 0 ? std::numeric_limits<double>::quiet_NaN()
                                              : faces_[axis][static_cast<std::size_t>(index)];
            if (!std::isnan(velocity)) {
                const Vector apart = (at - corner - Vector(i, j)).cwiseAbs();
                const double weight = (1 - apart.x()) * (1 - apart.y());
                total += weight * velocity;
                weights += weight;
            }
        }
    }
    return weights > 0 ? total / weights : 0;
}

} // namespace slurry
