#pragma once
// A scene that runs step by step.
#include "solver/time/time_step.hpp"
#include "solver/time/velocity_verlet.hpp"

#include "tests/solver/scenes_for_tests.hpp"

namespace slurry::testing {

struct Flow {
    Scene scene;
    Region region;
    Particles particles;
    std::unique_ptr<Interactions> interactions;
    DiscContacts contacts;
    PhaseClock clock;

    explicit Flow(const Scene& of, Particles start)
        : scene(of), region(of), particles(std::move(start)), interactions(make_interactions(of)),
          contacts(of, region) {
        Forces acting = forces();
        prepare_first_step(particles, acting, largest_time_step(scene), clock);
    }
    explicit Flow(const Scene& of) : Flow(of, arrange(of)) {}

    void run(int steps, double time_step) {
        Forces acting = forces();
        for (int step = 0; step < steps; ++step) {
            advance(particles, acting, time_step, clock);
        }
    }
    [[nodiscard]] Forces forces() {
        return {*interactions, contacts, scene.fluid, scene.numerics.sound_speed};
    }
};

} // namespace slurry::testing
