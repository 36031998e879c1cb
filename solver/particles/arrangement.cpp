#include "solver/particles/arrangement.hpp"

#include "solver/discs/clearance.hpp"
#include "solver/discs/disc_dummies.hpp"
#include "solver/discs/motion.hpp"
#include "solver/discs/placement.hpp"
#include "solver/kernels/quintic_spline.hpp"
#include "solver/loop/interactions.hpp"
#include "solver/particles/wall_impulse.hpp"
#include "solver/scene/start_velocity.hpp"
#include "solver/terms/equation_of_state.hpp"

#include <gsl/gsl_rng.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>

namespace slurry {

namespace {

// Moves every point by up to `jitter` spacings along each axis, less where that would bring it to a wall or
// disc.
void jitter_points(std::vector<Vector>& points, const Start& start, double spacing, const Region& region,
                   std::span<const Disc> discs) {
    const auto free_way = [&](const Vector& point) {
        return std::min(region.distance(point), clearance(discs, region.domain(), point));
    };
    const std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> random(gsl_rng_alloc(gsl_rng_mt19937),
                                                                   gsl_rng_free);
    gsl_rng_set(random.get(), static_cast<unsigned long>(start.seed));
    const double closest = 0.25 * spacing;
    for (Vector& point : points) {
        const double x = 2 * gsl_rng_uniform(random.get()) - 1;
        const double y = 2 * gsl_rng_uniform(random.get()) - 1;
        const Vector displacement = start.jitter * spacing * Vector(x, y);
        if (free_way(point + displacement) > std::min(closest, free_way(point))) {
            point += displacement;
        }
    }
}

void place_dummies(DummyParticles& dummies, const Scene& scene, const Region& region) {
    const auto by_wall = region.dummies(scene.numerics.wall_dummies, scene.numerics.particle_spacing,
                                        dummy_layers(scene.numerics));
    std::size_t count = 0;
    for (const auto& of_wall : by_wall) {
        count += of_wall.size();
    }
    dummies.resize(count);
    std::size_t d = 0;
    for (std::size_t w = 0; w < by_wall.size(); ++w) {
        dummies.wall_drift.push_back(region.walls()[w].displacement(1));
        for (const Dummy& dummy : by_wall[w]) {
            dummies.start_x[d] = dummy.position.x();
            dummies.start_y[d] = dummy.position.y();
            dummies.volume[d] = dummy.volume;
            const NearestPoint nearest = region.walls()[w].nearest(dummy.position);
            dummies.normal_x[d] = nearest.normal.x();
            dummies.normal_y[d] = nearest.normal.y();
            dummies.depth[d] = nearest.normal.dot(nearest.position - dummy.position);
            dummies.curvature[d] = nearest.curvature;
            dummies.solid_velocity_x[d] = region.walls()[w].velocity().x();
            dummies.solid_velocity_y[d] = region.walls()[w].velocity().y();
            dummies.wall[d] = static_cast<int>(w);
            ++d;
        }
    }
    dummies.first_of_discs = count;
    dummies.move_walls_to(0);
}

// Lets the background pressure even out the spacing, without inertia, against walls at rest. One iteration
// moves a particle by h^2 / (2 c^2) times its acceleration; the stiffest displacement of a lattice allows
// 0.69 h^2 / c^2.
void relax(Particles& particles, const Scene& scene) {
    constexpr int most_iterations = 1000;
    constexpr double still = 1e-4; // spacings per iteration
    Scene uniform = scene;
    uniform.numerics.background_pressure_ratio = 1;
    uniform.numerics.advection_tensor = false;
    const auto interactions = make_interactions(uniform);
    const double h = scene.numerics.smoothing_length();
    const double spacing = scene.numerics.particle_spacing;
    const double factor = 0.5 * std::pow(h / scene.numerics.sound_speed, 2);
    FluidParticles& fluid = particles.fluid;
    double largest = spacing;
    for (int k = 0; k < most_iterations && largest > still * spacing; ++k) {
        interactions->refresh_neighbours(particles);
        interactions->compute_volumes(particles);
        interactions->compute_forces(particles);
        largest = 0;
        for (std::size_t i = 0; i < fluid.size(); ++i) {
            const Vector wanted = factor * Vector(fluid.background_x[i], fluid.background_y[i]);
            const Vector moved = wanted * std::min(1.0, 0.1 * spacing / std::max(wanted.norm(), 1e-300));
            fluid.x[i] += moved.x();
            fluid.y[i] += moved.y();
            largest = std::max(largest, moved.norm());
        }
    }
}

// Along axes that are closed, the fluid starts with the pressure that holds it against its body force.
void balance_body_force(FluidParticles& fluid, const Scene& scene) {
    Vector force = scene.fluid.acceleration();
    for (const int axis : {0, 1}) {
        force[axis] *= scene.domain.periodic[static_cast<std::size_t>(axis)] ? 0 : 1;
    }
    if (force.isZero(0)) {
        return;
    }
    const EquationOfState equation_of_state{scene.fluid.density, scene.numerics.sound_speed};
    const Vector middle = (scene.domain.lower + scene.domain.upper) / 2;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const double potential = force.dot(Vector(fluid.x[i], fluid.y[i]) - middle);
        fluid.density[i] = equation_of_state.density(scene.fluid.density * potential);
    }
}

// An impulse moves a circular cylinder with twice the fluid's momentum over its mass and the added one.
void push_discs(std::span<Disc> discs, const Scene& scene, const WallImpulse& impulse) {
    for (Disc& disc : discs) {
        if (disc.free()) {
            const double fluid_mass = scene.fluid.density * disc.area();
            disc.velocity += 2 * fluid_mass / (disc.mass + fluid_mass) * impulse.velocity(disc.position);
        }
    }
}

void set_velocity(FluidParticles& fluid, const Scene& scene, const WallImpulse& impulse) {
    const Start& start = scene.start;
    const Domain& domain = scene.domain;
    const EquationOfState equation_of_state{scene.fluid.density, scene.numerics.sound_speed};
    const double peak_pressure = scene.fluid.density * start.speed * start.speed / 4;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const Vector position(fluid.x[i], fluid.y[i]);
        const Vector velocity = start_velocity(scene, position) + impulse.velocity(position);
        fluid.velocity_x[i] = velocity.x();
        fluid.velocity_y[i] = velocity.y();
        if (start.velocity == InitialVelocity::taylor_green) {
            const double x = 2 * std::numbers::pi * (fluid.x[i] - domain.lower.x()) / domain.size().x();
            const double y = 2 * std::numbers::pi * (fluid.y[i] - domain.lower.y()) / domain.size().x();
            // Without the vortices' pressure the start would be heard as sound for a long time.
            fluid.density[i] =
                equation_of_state.density(-peak_pressure * (std::cos(2 * x) + std::cos(2 * y)));
        }
    }
}

double fluid_area(const Region& region, std::span<const Disc> discs) {
    double area = region.fluid_area();
    for (const Disc& disc : discs) {
        area -= disc.area();
    }
    return area;
}

} // namespace

std::vector<Vector> fluid_points(const Scene& scene, const Region& region, std::span<const Disc> discs) {
    if (scene.start.arrangement == Arrangement::empty) {
        return {};
    }
    const double spacing = scene.numerics.particle_spacing;
    std::vector<Vector> points = region.lattice_points(spacing);
    std::erase_if(points, [&](const Vector& point) { return clearance(discs, scene.domain, point) <= 0; });
    if (scene.start.arrangement != Arrangement::lattice) {
        jitter_points(points, scene.start, spacing, region, discs);
    }
    return points;
}

int dummy_layers(const Numerics& numerics) {
    return static_cast<int>(std::ceil(QuinticSpline::support * numerics.smoothing_ratio - 1e-9));
}

Particles arrange_particles(const Scene& scene, const Region& region) {
    Particles particles;
    particles.discs = make_discs(place_discs(scene, region), scene.fluid);
    const WallImpulse impulse(scene, region, particles.discs);
    push_discs(particles.discs, scene, impulse);
    const double spacing = scene.numerics.particle_spacing;
    const std::vector<Vector> points = fluid_points(scene, region, particles.discs);
    FluidParticles& fluid = particles.fluid;
    fluid.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        fluid.x[i] = points[i].x();
        fluid.y[i] = points[i].y();
        fluid.density[i] = scene.fluid.density;
    }
    // A box without fluid has particles of a mass, too: none.
    fluid.mass = scene.fluid.density *
                 (points.empty() ? spacing * spacing
                                 : fluid_area(region, particles.discs) / static_cast<double>(points.size()));
    place_dummies(particles.dummies, scene, region);
    append_disc_dummies(particles, scene.numerics.disc_dummies, spacing, dummy_layers(scene.numerics));
    if (scene.start.arrangement == Arrangement::relaxed) {
        relax(particles, scene);
    }
    balance_body_force(fluid, scene);
    set_velocity(fluid, scene, impulse);
    return particles;
}

} // namespace slurry
