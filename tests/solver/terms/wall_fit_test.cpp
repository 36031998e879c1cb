// The polynomials that dummies continue through their wall.
#include "solver/terms/wall_fit.hpp"

#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace slurry::testing {
namespace {

// Velocity less the wall's n (b0 + b1 s + b2 n), pressure c0 + c1 s + g n, in the (parabolic) coordinates of
// the wall at the point nearest to one dummy, in smoothing lengths.
struct Polynomials {
    Vector b0, b1, b2;
    double c0, c1, g;

    [[nodiscard]] Vector velocity(double s, double n) const { return n * (b0 + s * b1 + n * b2); }
    [[nodiscard]] double pressure(double s, double n) const { return c0 + c1 * s + g * n; }
};

double nearest_image(double offset, double length) {
    return offset - std::round(offset / length) * length;
}

// Gives the fluid the polynomials about dummy d; periodic images as near to the dummy as they come.
void set_fluid(Particles& particles, const Scene& scene, std::size_t d, const Polynomials& polynomials) {
    FluidParticles& fluid = particles.fluid;
    const DummyParticles& dummies = particles.dummies;
    const double h = scene.numerics.smoothing_length();
    const Vector normal(dummies.normal_x[d], dummies.normal_y[d]);
    const Vector wall_point = Vector(dummies.x[d], dummies.y[d]) + dummies.depth[d] * normal;
    const Vector wall_velocity(dummies.solid_velocity_x[d], dummies.solid_velocity_y[d]);
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        Vector offset = Vector(fluid.x[i], fluid.y[i]) - wall_point;
        offset.x() = nearest_image(offset.x(), scene.domain.size().x());
        const double along = offset.dot(Vector(normal.y(), -normal.x()));
        const double across = offset.dot(normal) - dummies.curvature[d] * along * along / 2;
        const Vector velocity = wall_velocity + polynomials.velocity(along / h, across / h);
        fluid.velocity_x[i] = velocity.x();
        fluid.velocity_y[i] = velocity.y();
        fluid.pressure[i] = polynomials.pressure(along / h, across / h);
    }
}

// Of the pressure per smoothing length, by the momentum balance at a wall that does not accelerate: the
// velocity along it grows by n s b1, so that the one across it is -n^2 / 2 of that.
double balancing_gradient(const Scene& scene, const DummyParticles& dummies, std::size_t d,
                          const Vector& b1) {
    const Vector normal(dummies.normal_x[d], dummies.normal_y[d]);
    const double h = scene.numerics.smoothing_length();
    const double curvature = -b1.dot(Vector(normal.y(), -normal.x())) / (h * h);
    return h * (scene.fluid.density * scene.fluid.body_force.dot(normal) +
                scene.fluid.dynamic_viscosity * curvature);
}

void expect_exact_continuation(Scene scene) {
    jitter(scene, 0.3);
    scene.fluid.body_force = {0.3, -9.81};
    Particles particles = arrange(scene);
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    const DummyParticles& dummies = particles.dummies;
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto random = [&] { return uniform(generator); };
    const auto random_vector = [&] {
        const double x = random();
        return Vector(x, random());
    };
    ASSERT_GE(dummies.size(), 2 * 3 * 12U);
    std::size_t where_all_is_known = 0;
    for (std::size_t d = 0; d < dummies.size(); ++d) {
        SCOPED_TRACE("dummy " + std::to_string(d));
        Polynomials polynomials{random_vector(), random_vector(), random_vector(),
                                1000 * random(), 1000 * random(), 0};
        polynomials.g = balancing_gradient(scene, dummies, d, polynomials.b1);
        set_fluid(particles, scene, d, polynomials);
        interactions->extrapolate_to_walls(particles);
        const double n = -dummies.depth[d] / scene.numerics.smoothing_length();
        const Vector expected =
            Vector(dummies.solid_velocity_x[d], dummies.solid_velocity_y[d]) + polynomials.velocity(0, n);
        const double pressure = polynomials.pressure(0, n);
        EXPECT_NEAR(dummies.pressure[d], pressure, 1e-9 * std::abs(pressure));
        const double full = moment_before_curve(dummies.curvature[d] * scene.numerics.smoothing_length() / 2);
        if (known_curvature(dummies.fluid_share[d] / full) == 1) {
            ++where_all_is_known;
            EXPECT_NEAR(dummies.velocity_x[d], expected.x(), 1e-9 * expected.norm());
            EXPECT_NEAR(dummies.velocity_y[d], expected.y(), 1e-9 * expected.norm());
        }
    }
    EXPECT_GE(where_all_is_known, dummies.size() / 2);
}

TEST(WallFit, ContinuesItsPolynomialsThroughAFlatMovingWall) {
    expect_exact_continuation(flat_channel(12, 0.7));
}

TEST(WallFit, ContinuesItsPolynomialsThroughACurvedWall) {
    for (const double amplitude : {0.1, -0.1}) { // steepest where it crosses the periodic side
        Scene scene = flat_channel(12, 0.7);
        scene.walls[0].shape = CosineShape{0.35, amplitude, 1, -0.05};
        scene.walls[0].velocity = {-0.4, 0};
        expect_exact_continuation(scene);
    }
}

TEST(WallFit, ContinuesItsPolynomialsToDummiesOnALattice) {
    Scene scene = flat_channel(12, 0.7);
    scene.walls[0].shape = CosineShape{0.35, 0.1, 1, -0.05};
    scene.numerics.wall_dummies = DummyLayout::lattice;
    expect_exact_continuation(scene);
}

// One row of fluid, half a spacing above the floor of a channel; the lid is out of its reach.
Particles single_row(const Scene& scene) {
    Particles particles = arrange(scene);
    const double spacing = scene.numerics.particle_spacing;
    FluidParticles& fluid = particles.fluid;
    fluid.resize(12);
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        fluid.x[i] = scene.domain.lower.x() + (static_cast<double>(i) + 0.5) * spacing;
        fluid.y[i] = scene.domain.lower.y() + 0.5 * spacing;
    }
    return particles;
}

void fit_to_walls(const Scene& scene, Particles& particles) {
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    interactions->extrapolate_to_walls(particles);
}

// Of the weights times the distance from a wall, over the half-plane before it, the part within `thickness`
// smoothing lengths of it.
double share_of_film(double thickness) {
    return 1 - std::pow(1 - thickness * thickness / 9, 3.5);
}

TEST(KnownVelocity, IsNothingInAFilmAndAllFromTwoSmoothingLengthsOn) {
    EXPECT_EQ(known_velocity(0), 0);
    EXPECT_EQ(known_velocity(share_of_film(1)), 0);
    EXPECT_EQ(known_velocity(share_of_film(2)), 1);
    EXPECT_EQ(known_velocity(1.1), 1); // particles closer than on average
}

TEST(KnownCurvature, IsNothingInThinFilmsAndAllInThoseThatFillTheReach) {
    EXPECT_EQ(known_curvature(0.0), 0);
    EXPECT_EQ(known_curvature(share_of_film(1.75)), 0);
    EXPECT_EQ(known_curvature(share_of_film(2.4)), 1);
    EXPECT_EQ(known_curvature(1.1), 1);
}

TEST(KnownGradient, IsNothingInAFilmAndAllFromALittleMoreThanOneSmoothingLengthOn) {
    EXPECT_EQ(known_gradient(0), 0);
    EXPECT_EQ(known_gradient(share_of_film(0.8)), 0);
    EXPECT_EQ(known_gradient(share_of_film(1.1)), 1);
    EXPECT_EQ(known_gradient(1.1), 1);
}

template <class Known> void expect_no_jump(const Known& known) {
    double before = 0;
    for (double share = 0; share < 1; share += 1e-3) {
        EXPECT_GE(known(share), before);
        EXPECT_LT(known(share), before + 0.02);
        before = known(share);
    }
}

TEST(WallFit, ForgetsWithoutAJump) {
    expect_no_jump(known_curvature<double>);
    expect_no_jump(known_velocity);
    expect_no_jump(known_gradient);
}

// So that fluid in a trough, or over a crest, is no film.
TEST(WallFit, KnowsHowMuchRoomIsBeforeACurvedWall) {
    Scene scene = flat_channel(24, 0.7);
    scene.walls[0].shape = CosineShape{0.35, 0.05, 1, -0.05};
    Particles particles = arrange(scene);
    fit_to_walls(scene, particles);
    const DummyParticles& dummies = particles.dummies;
    double largest_difference = 0;
    for (std::size_t d = 0; d < dummies.size(); ++d) {
        const double full = moment_before_curve(dummies.curvature[d] * scene.numerics.smoothing_length() / 2);
        EXPECT_NEAR(dummies.fluid_share[d] / full, 1, 0.05);
        largest_difference = std::max(largest_difference, std::abs(full - 1));
    }
    EXPECT_GT(largest_difference, 0.05);
}

TEST(WallFit, KnowsFilmsFromFluidThatFillsTheRoomBeforeAWall) {
    const Scene scene = flat_channel(12, 0.7);
    Particles full = arrange(scene);
    fit_to_walls(scene, full);
    for (const double share : full.dummies.fluid_share) {
        EXPECT_NEAR(share, 1, 0.05);
    }
    Particles film = single_row(scene);
    fit_to_walls(scene, film);
    for (const double share : film.dummies.fluid_share) {
        EXPECT_LT(share, 0.45);
    }
}

// A parabola through so few rows makes viscosity stiffer than the time step is for.
TEST(WallFit, ContinuesAStraightLineBehindAFilm) {
    const Scene scene = flat_channel(12, 0.7);
    const double spacing = scene.numerics.particle_spacing;
    Particles film = single_row(scene);
    FluidParticles& fluid = film.fluid;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const double away = i % 2 == 0 ? 0.5 : 0.6; // spacings
        fluid.y[i] = scene.domain.lower.y() + away * spacing;
        fluid.velocity_x[i] = away * away;
    }
    fit_to_walls(scene, film);
    const DummyParticles& dummies = film.dummies;
    std::size_t behind_the_film = 0;
    for (std::size_t d = 0; d < dummies.size(); ++d) {
        if (dummies.fluid_share[d] > 0) {
            ++behind_the_film;
            const double slope = -dummies.velocity_x[d] / dummies.depth[d] * spacing;
            EXPECT_GT(slope, 0.5);
            EXPECT_LT(slope, 0.6);
        }
    }
    EXPECT_EQ(behind_the_film, 3 * 12U);
}

std::vector<double> density_rate(const Scene& scene, Particles particles) {
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    interactions->extrapolate_to_walls(particles);
    interactions->compute_density_rate(particles);
    return particles.fluid.density_rate;
}

// In a film the continued velocity is flow through the wall.
TEST(WallFit, KeepsToTheWallsOwnVelocityInAFilm) {
    Scene fitted = flat_channel(12, 0.7);
    fitted.numerics.wall_continuity = WallContinuity::solenoidal;
    Scene own = fitted;
    own.numerics.wall_continuity = WallContinuity::wall_velocity;
    Particles film = single_row(fitted);
    disorder(film, fitted);
    EXPECT_EQ(density_rate(fitted, film), density_rate(own, film));
    Particles full = arrange(fitted);
    disorder(full, fitted);
    EXPECT_NE(density_rate(fitted, full), density_rate(own, full));
}

TEST(WallFit, FallsBackToAStraightLineBesideASingleRow) {
    Scene scene = flat_channel(12, 0.7);
    scene.walls[0].velocity = {-0.3, 0};
    Particles particles = single_row(scene);
    FluidParticles& fluid = particles.fluid;
    std::fill(fluid.velocity_x.begin(), fluid.velocity_x.end(), 0.4);
    std::fill(fluid.velocity_y.begin(), fluid.velocity_y.end(), -0.1);
    std::fill(fluid.pressure.begin(), fluid.pressure.end(), 123.0);
    fit_to_walls(scene, particles);
    const DummyParticles& dummies = particles.dummies;
    for (std::size_t d = 0; d < dummies.size(); ++d) {
        if (dummies.wall[d] == 0) { // antisymmetric about the wall's velocity at the depth of the row
            const double ratio = dummies.depth[d] / (0.5 * scene.numerics.particle_spacing);
            EXPECT_NEAR(dummies.velocity_x[d], -0.3 - ratio * 0.7, 1e-12);
            EXPECT_NEAR(dummies.velocity_y[d], ratio * 0.1, 1e-12);
            EXPECT_NEAR(dummies.pressure[d], 123, 1e-10);
        }
    }
}

TEST(WallFit, StaysFiniteBesideASingleDisorderedRow) {
    const Scene scene = flat_channel(12, 0.7);
    Particles particles = single_row(scene);
    disorder(particles, scene);
    fit_to_walls(scene, particles);
    const DummyParticles& dummies = particles.dummies;
    const double deepest = *std::max_element(dummies.depth.begin(), dummies.depth.end());
    const double ratio = deepest / (0.5 * scene.numerics.particle_spacing);
    for (const auto* values : {&dummies.velocity_x, &dummies.velocity_y}) {
        EXPECT_LE(largest(*values), ratio * (1 + 1e-12)); // a line through the wall and a mean of the row
    }
    EXPECT_LE(largest(dummies.pressure), largest(particles.fluid.pressure) * (1 + 1e-12));
}

TEST(WallFit, LeavesTheWallsVelocityAndNoPressureWithoutFluidInReach) {
    const Scene scene = flat_channel(12, 0.7);
    Particles particles = single_row(scene);
    disorder(particles, scene);
    std::fill(particles.dummies.pressure.begin(), particles.dummies.pressure.end(), 5.0);
    fit_to_walls(scene, particles);
    const DummyParticles& dummies = particles.dummies;
    std::size_t of_lid = 0;
    for (std::size_t d = 0; d < dummies.size(); ++d) {
        if (dummies.wall[d] == 1) {
            EXPECT_EQ(dummies.velocity_x[d], 0.7);
            EXPECT_EQ(dummies.velocity_y[d], 0);
            EXPECT_EQ(dummies.pressure[d], 0);
            ++of_lid;
        }
    }
    EXPECT_EQ(of_lid, 3 * 12U);
}

} // namespace
} // namespace slurry::testing
