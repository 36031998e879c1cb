#include "solver/loop/neighbourhood.hpp"

#include "solver/loop/cell_grid.hpp"
#include "solver/particles/run_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slurry {

namespace {

// Extra reach of the neighbour lists, in particle spacings: a longer skin means fewer rebuilds and longer
// lists.
constexpr double skin_ratio = 0.35;

// At least `least`; of a periodic axis, the length over a whole number.
double cell_size(double least, double length, bool periodic) {
    return periodic ? length / std::max(1.0, std::floor(length / least)) : least;
}

} // namespace

Neighbourhood::Neighbourhood(const Scene& scene, double support, double wall_support, int width,
                             std::size_t row_bytes)
    : domain_(scene.domain), walls_(!scene.walls.empty() || !scene.discs.empty()),
      wall_points_(scene.numerics.wall_extrapolation == WallExtrapolation::fit),
      spacing_(scene.numerics.particle_spacing), skin_(skin_ratio * spacing_),
      longest_way_(skin_ + scene.numerics.smoothing_length()),
      support_(support * scene.numerics.smoothing_length()),
      wall_support_(wall_support * scene.numerics.smoothing_length()),
      fluid_list_(width, scene.numerics.neighbour_search, row_bytes),
      dummy_list_(width, scene.numerics.neighbour_search, row_bytes),
      disc_list_(width, scene.numerics.neighbour_search, row_bytes) {}

void Neighbourhood::refresh(Particles& particles) {
    if (rebuilds_ > 0) {
        const double displacement = watch_.largest(particles);
        if (displacement < skin_) {
            return;
        }
        refuse_flight(particles, displacement);
    }
    periodic_.rebuild(particles, domain_, cell().y(), reach_beyond_sides(particles.dummies));
    make_lists(particles);
    ++rebuilds_;
}

double Neighbourhood::reach() const {
    return std::max(support_, wall_support_) + skin_;
}

// The wall point of a dummy beside a periodic side may lie beyond it, by as much as the dummy is deep.
double Neighbourhood::reach_beyond_sides(const DummyParticles& dummies) const {
    const auto& depths = dummies.depth;
    return reach() + (wall_points_ && !depths.empty() ? *std::max_element(depths.begin(), depths.end()) : 0);
}

// Wide cells make long runs of particles. Particles sorted by the search's rows are found in order.
Vector Neighbourhood::cell() const {
    return {cell_size(2 * reach(), domain_.size().x(), domain_.periodic[0]),
            cell_size(CellGrid::row_height(reach()), domain_.size().y(), domain_.periodic[1])};
}

void Neighbourhood::make_lists(const Particles& particles) {
    const DummyParticles& dummies = particles.dummies;
    normal_x_ = dummies.normal_x;
    normal_y_ = dummies.normal_y;
    list_time_ = particles.time;
    watch_.start(particles, periodic_.x(), periodic_.y(), domain_, cell());
    fluid_list_.build(periodic_.x(), periodic_.y(), periodic_.all_rows(), 0, periodic_.fluid_count(),
                      periodic_.padding(), support_ + skin_, cell().y());
    if (walls_) {
        build_dummy_list(dummies);
    }
    if (!particles.discs.empty()) {
        disc_list_.build(periodic_.x(), periodic_.y(), periodic_.fluid_rows(),
                         periodic_.fluid_count() + dummies.first_of_discs, periodic_.particle_count(),
                         periodic_.padding(), support_ + skin_);
    }
}

ListOrigin Neighbourhood::origin() const {
    const auto count = static_cast<std::ptrdiff_t>(periodic_.particle_count());
    const auto x = periodic_.x().begin();
    const auto y = periodic_.y().begin();
    return {{x, x + count}, {y, y + count}, normal_x_, normal_y_, list_time_, rebuilds_};
}

void Neighbourhood::restore(const Particles& particles, const ListOrigin& origin) {
    Particles then = particles;
    const auto fluid = static_cast<std::ptrdiff_t>(then.fluid.size());
    then.fluid.x.assign(origin.x.begin(), origin.x.begin() + fluid);
    then.fluid.y.assign(origin.y.begin(), origin.y.begin() + fluid);
    then.dummies.x.assign(origin.x.begin() + fluid, origin.x.end());
    then.dummies.y.assign(origin.y.begin() + fluid, origin.y.end());
    then.dummies.normal_x = origin.normal_x;
    then.dummies.normal_y = origin.normal_y;
    then.time = origin.time;
    periodic_.take(then, domain_, reach_beyond_sides(then.dummies));
    make_lists(then);
    rebuilds_ = origin.rebuilds;
}

// A fit asks for the fluid around the wall point of a dummy, a mean for that around the dummy.
void Neighbourhood::build_dummy_list(const DummyParticles& dummies) {
    std::vector<double> x(periodic_.x().begin(), periodic_.x().end());
    std::vector<double> y(periodic_.y().begin(), periodic_.y().end());
    for (std::size_t d = 0; wall_points_ && d < dummies.size(); ++d) {
        x[periodic_.fluid_count() + d] += dummies.depth[d] * dummies.normal_x[d];
        y[periodic_.fluid_count() + d] += dummies.depth[d] * dummies.normal_y[d];
    }
    dummy_list_.build(x, y, periodic_.fluid_rows(), periodic_.fluid_count(), periodic_.particle_count(),
                      periodic_.padding(), wall_support_ + skin_);
}

// Lists are looked at twice a step, and nobody was farther than the skin: the rest of the way took half a
// step, in which sound gets less than half a smoothing length far. Who is faster than that is not simulated
// any more. Discs alone have no neighbours.
void Neighbourhood::refuse_flight(const Particles& particles, double displacement) const {
    if (displacement > longest_way_ && particles.fluid.size() > 0) {
        throw RunError(fmt::format("time {:.6g} s: {}; reduce numerics.acoustic_cfl, or raise "
                                   "numerics.sound_speed to 10 times the top speed",
                                   particles.time, periodic_.farthest_moved(particles)));
    }
}

ListStatistics Neighbourhood::statistics() const {
    return {rebuilds_, fluid_list_.pairs(), fluid_list_.evaluated(), 0,
            fluid_list_.bytes() + dummy_list_.bytes() + disc_list_.bytes() + periodic_.bytes()};
}

} // namespace slurry
