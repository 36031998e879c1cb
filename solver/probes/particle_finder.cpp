#include "solver/probes/particle_finder.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace slurry {

namespace {

constexpr double cell_in_spacings = 2.5; // half of the widest search: five cells across cover it

// Also for what is not a number: that ends in cell 0, and no distance to it is ever small.
std::ptrdiff_t clamped_cell(double cells_from_lower, std::ptrdiff_t count) {
    if (!(cells_from_lower > 0)) {
        return 0;
    }
    return static_cast<std::ptrdiff_t>(std::min(cells_from_lower, static_cast<double>(count - 1)));
}

std::ptrdiff_t floor_quotient(std::ptrdiff_t number, std::ptrdiff_t divisor) {
    return number / divisor - (number % divisor < 0 ? 1 : 0);
}

} // namespace

ParticleFinder::ParticleFinder(const FluidView& fluid, const Domain& domain, double particle_spacing)
    : fluid_(fluid), domain_(domain), particle_spacing_(particle_spacing) {
    const std::size_t count = fluid.x.size();
    for (const auto& values : {fluid.y, fluid.velocity_x, fluid.velocity_y, fluid.pressure}) {
        if (values.size() != count) {
            throw std::invalid_argument("the fluid's quantities differ in length");
        }
    }
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double size = domain.size()[static_cast<Eigen::Index>(axis)];
        count_[axis] = std::max<std::ptrdiff_t>(
            1, static_cast<std::ptrdiff_t>(size / (cell_in_spacings * particle_spacing)));
        cell_size_[static_cast<Eigen::Index>(axis)] = size / static_cast<double>(count_[axis]);
    }
    std::vector<std::size_t> cells(count);
    first_.assign(static_cast<std::size_t>(count_[0] * count_[1]) + 1, 0);
    for (std::size_t i = 0; i < count; ++i) {
        cells[i] = cell_of(i);
        ++first_[cells[i] + 1];
    }
    for (std::size_t cell = 1; cell < first_.size(); ++cell) {
        first_[cell] += first_[cell - 1];
    }
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    particles_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        particles_[next[cells[i]]++] = i;
    }
}

std::size_t ParticleFinder::cell_of(std::size_t particle) const {
    const std::ptrdiff_t column =
        clamped_cell((fluid_.x[particle] - domain_.lower.x()) / cell_size_.x(), count_[0]);
    const std::ptrdiff_t row =
        clamped_cell((fluid_.y[particle] - domain_.lower.y()) / cell_size_.y(), count_[1]);
    return static_cast<std::size_t>(row * count_[0] + column);
}

std::vector<NearParticle> ParticleFinder::near(const Vector& point, double radius) const {
    Cell from{};
    Cell to{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const auto component = static_cast<Eigen::Index>(axis);
        const double centre = point[component] - domain_.lower[component];
        const double size = cell_size_[component];
        from[axis] = static_cast<std::ptrdiff_t>(std::floor((centre - radius) / size));
        to[axis] = static_cast<std::ptrdiff_t>(std::floor((centre + radius) / size));
        if (!domain_.periodic[axis]) {
            from[axis] = std::clamp<std::ptrdiff_t>(from[axis], 0, count_[axis] - 1);
            to[axis] = std::clamp<std::ptrdiff_t>(to[axis], 0, count_[axis] - 1);
        }
    }
    std::vector<NearParticle> found;
    for (std::ptrdiff_t row = from[1]; row <= to[1]; ++row) {
        for (std::ptrdiff_t column = from[0]; column <= to[0]; ++column) {
            add_cell({column, row}, point, radius, found);
        }
    }
    return found;
}

void ParticleFinder::add_cell(const Cell& unwrapped, const Vector& point, double radius,
                              std::vector<NearParticle>& found) const {
    const Cell image{floor_quotient(unwrapped[0], count_[0]), floor_quotient(unwrapped[1], count_[1])};
    const std::ptrdiff_t column = unwrapped[0] - image[0] * count_[0];
    const std::ptrdiff_t row = unwrapped[1] - image[1] * count_[1];
    const auto cell = static_cast<std::size_t>(row * count_[0] + column);
    const Vector shift =
        domain_.size().cwiseProduct(Vector(static_cast<double>(image[0]), static_cast<double>(image[1]))) -
        point;
    for (std::size_t k = first_[cell]; k < first_[cell + 1]; ++k) {
        const std::size_t i = particles_[k];
        const Vector offset = Vector(fluid_.x[i], fluid_.y[i]) + shift;
        if (offset.squaredNorm() < radius * radius) {
            found.push_back({i, offset});
        }
    }
}

} // namespace slurry
