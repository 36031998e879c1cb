#include "solver/scene/stability_checks.hpp"

#include "solver/scene/fluid_time_step.hpp"
#include "solver/scene/refusal.hpp"
#include "solver/scene/start_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <variant>

namespace slurry {
namespace {

// Limits for particles one smoothing length apart. Of sound and viscosity: linear stability of the scheme. Of
// the density diffusion: a jittered Couette flow runs with 0.45 and diverges with 0.6. Of extrapolated
// velocities in the continuity equation: a curved wall took 0.6, not 0.75. The background pressure has none:
// it is limited as the time step asks (solver/terms/background_pressure.hpp).
constexpr double largest_acoustic = 2.3;     // c dt / h
constexpr double largest_viscous = 0.5;      // nu dt / h^2
constexpr double largest_diffusion = 0.5;    // delta c dt / h
constexpr double largest_extrapolated = 0.5; // c dt / h
// Start-up Couette flow over ten spacings (verification/stability/cell_reynolds) is 0.1 % off at a cell
// Reynolds number of 50, 2.8 % at 70 and 3.7 % at 100, where it is no longer quiet.
constexpr double largest_cell_reynolds = 50;
// Neighbours of opposite density feel the fourth-order diffusion so much less than the same of second order.
constexpr double fourth_order_relief = 0.55;

void check_extrapolation(const Scene& scene, double acoustic, const Places& places) {
    if (scene.numerics.wall_continuity != WallContinuity::extrapolated) {
        return;
    }
    const std::string& place = places.of("numerics.wall_continuity");
    const std::string others = R"("solenoidal" or "wall_velocity")";
    if (std::ranges::any_of(scene.discs, [](const auto& disc) { return disc.motion == DiscMotion::free; })) {
        refuse(place, R"(numerics.wall_continuity = "extrapolated" with discs that are free)",
               others + ": discs and fluid would drive each other");
    }
    if (!scene.walls.empty() && !(acoustic < largest_extrapolated)) {
        refuse(place,
               fmt::format(R"(numerics.wall_continuity = "extrapolated" with a time step of {:.3g} h / c)",
                           acoustic),
               fmt::format("{}, or a numerics.acoustic_cfl of less than {}", others, largest_extrapolated));
    }
}

void check_time_step(const Scene& scene, const Places& places) {
    const Numerics& numerics = scene.numerics;
    const double h = numerics.smoothing_length();
    const double step = largest_time_step(scene);
    const double acoustic = numerics.sound_speed * step / h;
    const double viscous = scene.fluid.kinematic_viscosity() * (step / h) / h;
    if (!(acoustic < largest_acoustic)) {
        refuse(places.of("numerics.acoustic_cfl"),
               fmt::format("numerics.acoustic_cfl = {}, a time step of {:.3g} h / c", numerics.acoustic_cfl,
                           acoustic),
               fmt::format("less than {}, where sound grows without end", largest_acoustic));
    }
    if (!(viscous < largest_viscous)) {
        refuse(places.of("numerics.viscous_cfl"),
               fmt::format("numerics.viscous_cfl = {}, a time step of {:.3g} h^2 / nu", numerics.viscous_cfl,
                           viscous),
               fmt::format("less than {}, where viscosity makes every disturbance grow", largest_viscous));
    }
    check_extrapolation(scene, acoustic, places);
    const double of_neighbours = 1 - fourth_order_relief * numerics.fourth_order_diffusion_share;
    if (const double most = largest_diffusion / (acoustic * of_neighbours);
        !(numerics.density_diffusion < most)) {
        refuse(places.of("numerics.density_diffusion"),
               fmt::format("numerics.density_diffusion = {} with a time step of {:.3g} h / c",
                           numerics.density_diffusion, acoustic),
               fmt::format("less than {:.3g}, or a smaller numerics.acoustic_cfl: the density would swing "
                           "from step to step",
                           most));
    }
}

// The vortices' period is the domain's width along both axes.
void check_vortices(const Scene& scene, const Places& places) {
    if (scene.start.velocity != InitialVelocity::taylor_green || !scene.domain.periodic[1]) {
        return;
    }
    const Vector size = scene.domain.size();
    const double periods = size.y() / size.x();
    if (std::round(periods) < 1 || std::abs(periods - std::round(periods)) > 1e-6) {
        refuse(places.of("start.velocity"),
               fmt::format(R"("taylor_green" in a domain of {:.4g} x {:.4g} (m) that is periodic along y)",
                           size.x(), size.y()),
               "a height that is a whole multiple of the width, or the velocity jumps across the upper side");
    }
}

// The largest radius, as far as the scene's file says: that of a lognormal distribution is the median, and
// files of radii are read later (0).
double largest_radius(const DiscScene& disc) {
    const auto* random = std::get_if<RandomDiscs>(&disc.placement);
    if (random == nullptr) {
        return std::get<SingleDisc>(disc.placement).radius;
    }
    return random->sizes == SizeDistribution::uniform ? random->radius * (1 + random->spread)
                                                      : random->radius;
}

// A disc whose rim starts at a speed U against the fluid compresses what is in its way by U / c. Where random
// discs will be is not known: they are taken to go with the flow.
void check_disc_speeds(const Scene& scene, const Places& places) {
    const double most = 0.1 * scene.numerics.sound_speed;
    for (const DiscScene& disc : scene.discs) {
        const bool moves = disc.velocity != Vector::Zero();
        const auto* single = std::get_if<SingleDisc>(&disc.placement);
        const double against = single != nullptr
                                   ? (disc.velocity - start_velocity(scene, single->position)).norm()
                                   : std::max(0.0, disc.velocity.norm() - std::abs(scene.start.speed));
        const double turning = std::abs(disc.spin) * largest_radius(disc);
        const double speed = (moves ? against : 0) + turning;
        if (!(speed <= most * (1 + 1e-9))) {
            const bool by_spin = turning > speed / 2;
            refuse(places.of(fmt::format("discs.{}.{}", disc.name, by_spin ? "spin" : "velocity")),
                   fmt::format(R"(a disc "{}" {} at {:.4g} (m/s) against the fluid)", disc.name,
                               turning > 0 ? "whose rim starts" : "that starts", speed),
                   fmt::format("at most {:.4g}, a tenth of numerics.sound_speed: the start compresses the "
                               "fluid in its way",
                               most));
        }
    }
}

} // namespace

void check_stability(const Scene& scene, const Places& places) {
    if (scene.start.arrangement == Arrangement::empty) {
        return;
    }
    check_time_step(scene, places);
    check_vortices(scene, places);
    check_disc_speeds(scene, places);
}

std::vector<std::string> check_cell_reynolds(const Scene& scene, const Places& places) {
    double speed = 0;
    for (const WallScene& wall : scene.walls) {
        speed = std::max(speed, wall.velocity.norm());
    }
    const double viscosity = scene.fluid.kinematic_viscosity();
    const double spacing = scene.numerics.particle_spacing;
    const double reynolds = speed * spacing / viscosity;
    if (scene.start.arrangement == Arrangement::empty || !(reynolds > largest_cell_reynolds * (1 + 1e-9))) {
        return {};
    }
    return {
        fmt::format("{}: found numerics.particle_spacing = {} with a wall at {:.4g} (m/s), a cell Reynolds "
                    "number of {:.3g}, advised at most {}: a particle_spacing of at most {:.4g} (m), or the "
                    "layers along walls are not resolved",
                    places.of("numerics.particle_spacing"), spacing, speed, reynolds, largest_cell_reynolds,
                    largest_cell_reynolds * viscosity / speed)};
}

} // namespace slurry
