#include "solver/discs/groups.hpp"

#include "solver/geometry/geometry_error.hpp"
#include "solver/scene/disc_checks.hpp"

#include <fmt/core.h>
#include <gsl/gsl_randist.h>

#include <cmath>
#include <numbers>

namespace slurry {
namespace {

double area_of(const std::vector<double>& radii) {
    double area = 0;
    for (const double radius : radii)
        area += std::numbers::pi * radius * radius;
    return area;
}

double draw_radius(const RandomDiscs& random, gsl_rng* generator) {
    switch (random.sizes) {
    case SizeDistribution::constant:
        return random.radius;
    case SizeDistribution::uniform:
        return random.radius * (1 + random.spread * (2 * gsl_rng_uniform(generator) - 1));
    case SizeDistribution::lognormal:
        return random.radius * std::exp(gsl_ran_gaussian(generator, random.spread));
    case SizeDistribution::file:
        return random.radii[gsl_rng_uniform_int(generator, random.radii.size())];
    }
    return {};
}

std::string place_of(const DiscGroup& group) {
    return fmt::format("discs '{}'", group.scene->name);
}

// Draws radii until enough(the next one) says that it is one too many.
template <class Enough> void draw_until(DiscGroup& group, const Scene& scene, Enough enough) {
    const double spacing = scene.numerics.particle_spacing;
    const auto& random = std::get<RandomDiscs>(group.scene->placement);
    for (;;) {
        const double radius = draw_radius(random, group.generator.get());
        if (enough(radius))
            return;
        if (!(2 * radius >= fewest_spacings_across * spacing * (1 - 1e-9)))
            throw GeometryError(
                fmt::format("discs '{}': a radius of {:.4g} m was drawn, {:.3g} particle spacings across: "
                            "needs {:g} or more, "
                            "so less spread, larger discs or a particle_spacing of at most {:.4g} m",
                            group.scene->name, radius, 2 * radius / spacing, fewest_spacings_across,
                            2 * radius / fewest_spacings_across));
        group.radii.push_back(radius);
        check_disc_count(scene, static_cast<double>(group.radii.size()), place_of(group));
    }
}

void fill_area(DiscGroup& group, const Scene& scene, double wanted) {
    double area = 0;
    draw_until(group, scene, [&](double radius) {
        const double next = std::numbers::pi * radius * radius;
        if (!(area + next / 2 <= wanted))
            return true;
        area += next;
        return false;
    });
    if (group.radii.empty())
        throw GeometryError(
            fmt::format("discs '{}': the fraction is an area of {:.4g} m2, less than half a disc: "
                        "ask for a larger fraction, or smaller discs",
                        group.scene->name, wanted));
}

bool is_weighed(const DiscGroup& group) {
    const auto* random = std::get_if<RandomDiscs>(&group.scene->placement);
    return random != nullptr && random->weight_fraction > 0;
}

// Area of discs over mass of fluid (m3/kg) that gives them their fraction of the mass of both.
double area_per_fluid(const DiscGroup& group) {
    const double fraction = std::get<RandomDiscs>(group.scene->placement).weight_fraction;
    return fraction / (1 - fraction) / group.scene->density;
}

// The fluid that remains has the mass F = density * (area - sum of all discs' areas), and each weighed group
// the area F * area_per_fluid: linear in F.
void fill_weighed(std::vector<DiscGroup>& groups, const Scene& scene, double area) {
    double per_fluid = 1 / scene.fluid.density;
    for (const DiscGroup& group : groups) {
        area -= area_of(group.radii);
        per_fluid += is_weighed(group) ? area_per_fluid(group) : 0;
    }
    for (DiscGroup& group : groups)
        if (is_weighed(group))
            fill_area(group, scene, area / per_fluid * area_per_fluid(group));
}

// Out of reach of the repulsion, unless said otherwise: it would throw discs apart at the start.
double least_distance(const Scene& scene, const DiscScene& disc, const RandomDiscs& random) {
    return random.least_distance > 0 || disc.motion != DiscMotion::free ? random.least_distance
                                                                        : contact_distance(scene);
}

DiscGroup start_group(const Scene& all, const DiscScene& scene) {
    DiscGroup group{&scene, 0, {}, {nullptr, gsl_rng_free}};
    if (const auto* random = std::get_if<RandomDiscs>(&scene.placement)) {
        group.least_distance = least_distance(all, scene, *random);
        group.generator.reset(gsl_rng_alloc(gsl_rng_mt19937));
        gsl_rng_set(group.generator.get(), static_cast<unsigned long>(random->seed));
    } else {
        group.radii = {std::get<SingleDisc>(scene.placement).radius};
    }
    return group;
}

} // namespace

std::vector<DiscGroup> draw_groups(const Scene& scene, double area) {
    std::vector<DiscGroup> groups;
    for (const DiscScene& disc : scene.discs) {
        DiscGroup& group = groups.emplace_back(start_group(scene, disc));
        const auto* random = std::get_if<RandomDiscs>(&disc.placement);
        if (random != nullptr && random->count > 0)
            draw_until(group, scene,
                       [&](double) { return group.radii.size() == static_cast<std::size_t>(random->count); });
        else if (random != nullptr && random->area_fraction > 0)
            fill_area(group, scene, random->area_fraction * area);
    }
    fill_weighed(groups, scene, area);
    double total = 0;
    for (const DiscGroup& group : groups) {
        total += static_cast<double>(group.radii.size());
        check_disc_count(scene, total, place_of(group));
    }
    return groups;
}

} // namespace slurry
