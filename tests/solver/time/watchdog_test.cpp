// A run that goes wrong is stopped, with a message that says where.
#include "solver/time/watchdog.hpp"

#include "solver/discs/clearance.hpp"
#include "solver/time/time_step.hpp"
#include "solver/time/velocity_verlet.hpp"
#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace slurry::testing {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t culprit = 57;

struct Watched {
    Scene scene = flat_channel(12);
    Region region{scene};
    Particles particles = arrange_particles(scene, region);

    Watched() {
        particles.time = 0.125;
        particles.fluid.identity[culprit] = 4711;
        particles.fluid.x[culprit] = 0.25;
        particles.fluid.y[culprit] = 0.75;
    }
    void check() const { check_particles(particles, region, scene, 89); }
    [[nodiscard]] std::string complaint() const {
        try {
            check();
        } catch (const RunError& error) {
            return error.what();
        }
        return "";
    }
};

// One line that names step, time, particle, place and cause.
void expect_complaint(const Watched& watched, const std::string& place, const std::string& cause) {
    const std::string message = watched.complaint();
    for (const std::string& part :
         {std::string("step 89"), std::string("0.125 s"), std::string("particle 4711"), place, cause}) {
        EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
    }
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(Watchdog, LetsAHealthyStatePass) {
    EXPECT_NO_THROW(Watched().check());
}

TEST(Watchdog, StopsAtANumberThatIsNotFiniteInAnyPartOfTheState) {
    for (const double bad : {not_a_number, std::numeric_limits<double>::infinity()}) {
        for (auto array :
             {&FluidParticles::velocity_x, &FluidParticles::velocity_y, &FluidParticles::density}) {
            Watched watched;
            (watched.particles.fluid.*array)[culprit] = bad;
            expect_complaint(watched, "(0.25, 0.75)", "not a finite number");
        }
        Watched lost;
        lost.particles.fluid.x[culprit] = bad;
        expect_complaint(lost, "0.75", "not a finite number");
    }
}

TEST(Watchdog, StopsWhenADensityIsMoreThanTenPercentOff) {
    for (const double density : {890.0, 1110.0}) {
        Watched watched;
        watched.particles.fluid.density[culprit] = density;
        expect_complaint(watched, "(0.25, 0.75)", "density");
    }
    Watched within;
    within.particles.fluid.density[culprit] = 1095;
    EXPECT_NO_THROW(within.check());
}

TEST(Watchdog, StopsWhenAParticleIsBehindAWall) {
    Watched watched;
    watched.particles.fluid.y[culprit] = 1.25; // the lid is at 1.2, half a spacing is 0.042
    expect_complaint(watched, "(0.25, 1.25)", "behind a wall");
    watched.particles.fluid.y[culprit] = 1.24;
    EXPECT_NO_THROW(watched.check());
}

// Puts a particle anywhere in the domain, a thousand times: the watchdog has to stop just where `wrong` is
// true.
template <class Wrong>
void expect_stops_where(const Scene& scene, const Particles& particles, const std::string& cause,
                        Wrong&& wrong) {
    const Region region(scene);
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> share(0, 1);
    std::uniform_int_distribution<std::size_t> anyone(0, particles.fluid.size() - 1);
    const Vector size = scene.domain.size();
    for (int k = 0; k < 1000; ++k) {
        Particles moved = particles;
        const std::size_t i = anyone(generator);
        const Vector place =
            scene.domain.lower + Vector(share(generator) * size.x(), share(generator) * size.y());
        moved.fluid.x[i] = place.x();
        moved.fluid.y[i] = place.y();
        std::string message;
        try {
            check_particles(moved, region, scene, 1);
        } catch (const RunError& error) {
            message = error.what();
        }
        EXPECT_EQ(message.find(cause) != std::string::npos, wrong(place))
            << place.transpose() << ": " << message;
    }
}

TEST(Watchdog, StopsWhereverAParticleIsInADiscByMoreThanHalfASpacing) {
    Scene scene = doubly_periodic(24);
    DiscScene small = middle_disc();
    small.name = "small";
    small.placement = SingleDisc{0.1, {0.6, 0.3}};
    scene.discs = {middle_disc(), small};
    Particles particles = arrange(scene);
    particles.discs[1].position += Vector(3, -2); // discs drift out of the domain, and are not wrapped
    expect_stops_where(scene, particles, "it is in a disc", [&](const Vector& place) {
        return clearance(particles.discs, scene.domain, place) < -0.5 * scene.numerics.particle_spacing;
    });
}

TEST(Watchdog, StopsWhereverAParticleIsBehindAWallByMoreThanHalfASpacing) {
    Scene scene = core_scene({0, 0}, {3, 2}, {true, false}, 0.1);
    scene.walls = {{"lid", LineShape{{0, 2}, {3, 2}}, FluidSide::below, {0, 0}},
                   {"pad", CosineShape{0.6, 0.5, 3, 0}, FluidSide::above, {0, 0}}};
    const Region region(scene);
    const Particles particles = arrange(scene);
    expect_stops_where(scene, particles, "it is behind a wall", [&](const Vector& place) {
        return region.distance(place) < -0.5 * scene.numerics.particle_spacing;
    });
}

TEST(Watchdog, FollowsWallsThatMove) {
    Scene scene = core_scene({0, 0}, {3, 2}, {true, false}, 0.2);
    scene.walls = {{"lid", LineShape{{0, 2}, {3, 2}}, FluidSide::below, {0, 0}},
                   {"pad", CosineShape{0.5, 0.2, 3, 0}, FluidSide::above, {1, 0}}};
    const Region region(scene);
    Particles particles = arrange_particles(scene, region);
    EXPECT_NO_THROW(check_particles(particles, region, scene, 1));
    particles.time = 1.5; // half a period later the crest is where the trough was
    EXPECT_THROW(check_particles(particles, region, scene, 2), RunError);
}

// The steps of a run of 230 after which a fault in the particle does not pass.
std::vector<long> seen_at(const Watched& watched) {
    std::vector<long> seen;
    for (long step = 1; step <= 230; ++step) {
        try {
            watch(watched.particles, watched.region, watched.scene, step, 230);
        } catch (const RunError&) {
            seen.push_back(step);
        }
    }
    return seen;
}

TEST(Watchdog, LooksAtStatesEarlyAndOftenAndAtPlacesSeldomAndAtTheEnd) {
    Watched dense;
    dense.particles.fluid.density[culprit] = 1110;
    EXPECT_EQ(seen_at(dense), (std::vector<long>{1,  2,   4,   8,   16,  20,  32,  40,  60,  64,
                                                 80, 100, 120, 128, 140, 160, 180, 200, 220, 230}));
    Watched leaked;
    leaked.particles.fluid.y[culprit] = 1.25;
    EXPECT_EQ(seen_at(leaked), (std::vector<long>{200, 230}));
}

// Five steps after a fault was planted in one particle: the machinery in between survives, and the watchdog
// sees it.
void run_with_fault(std::vector<double> FluidParticles::*array, double bad) {
    const Scene scene = flat_channel(12);
    const Region region(scene);
    Particles particles = arrange_particles(scene, region);
    const auto interactions = make_interactions(scene);
    PhaseClock clock;
    DiscContacts contacts(scene, region);
    Forces forces{*interactions, contacts, scene.fluid, scene.numerics.sound_speed};
    prepare_first_step(particles, forces, largest_time_step(scene), clock);
    (particles.fluid.*array)[culprit] = bad;
    for (int step = 0; step < 5; ++step) {
        advance(particles, forces, largest_time_step(scene), clock);
    }
    check_particles(particles, region, scene, 5);
}

TEST(Watchdog, SeesANumberThatIsNotFiniteSomeStepsLater) {
    for (const double bad : {not_a_number, std::numeric_limits<double>::infinity()}) {
        for (const auto array : {&FluidParticles::velocity_x, &FluidParticles::y, &FluidParticles::density}) {
            EXPECT_THROW(run_with_fault(array, bad), RunError) << bad;
        }
    }
}

TEST(Watchdog, SeesAParticleThatFliesOffSomeStepsLater) {
    EXPECT_THROW(run_with_fault(&FluidParticles::velocity_x, 1e6), RunError);
}

} // namespace
} // namespace slurry::testing
