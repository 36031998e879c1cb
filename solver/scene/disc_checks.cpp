#include "solver/scene/disc_checks.hpp"

#include "solver/scene/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <string_view>

namespace slurry {
namespace {

constexpr double enough_spacings_across = 6;

std::string address(const DiscScene& disc, std::string_view key) {
    return fmt::format("discs.{}.{}", disc.name, key);
}

// name_1, name_2, ... whatever the count, which may follow from an area.
bool is_member_name(std::string_view name, std::string_view group) {
    if (!name.starts_with(group) || name.substr(group.size()).size() < 2 || name[group.size()] != '_') {
        return false;
    }
    return name.find_first_not_of("0123456789", group.size() + 1) == std::string_view::npos;
}

void check_names(const Scene& scene, const Places& places) {
    for (const DiscScene& group : scene.discs) {
        if (!std::holds_alternative<RandomDiscs>(group.placement)) {
            continue;
        }
        for (const DiscScene& disc : scene.discs) {
            if (is_member_name(disc.name, group.name)) {
                refuse(
                    places.of(address(disc, "name")), fmt::format("the name \"{}\"", disc.name),
                    fmt::format("others: the random discs \"{0}\" are named {0}_1, {0}_2, ...", group.name));
            }
        }
    }
}

void check_count(const Scene& scene, const Places& places) {
    double count = 0;
    for (const DiscScene& disc : scene.discs) {
        const auto* random = std::get_if<RandomDiscs>(&disc.placement);
        count += random == nullptr ? 1 : random->count;
        check_disc_count(scene, count, places.of(address(disc, "count")));
    }
}

void check_amount(const DiscScene& disc, const RandomDiscs& random, bool empty, const Places& places) {
    const int given = (random.count > 0 ? 1 : 0) + (random.area_fraction > 0 ? 1 : 0) +
                      (random.weight_fraction > 0 ? 1 : 0);
    if (given != 1) {
        refuse(
            places.of("discs." + disc.name),
            fmt::format("count = {}, area_fraction = {} and weight_fraction = {} of the random discs \"{}\"",
                        random.count, random.area_fraction, random.weight_fraction, disc.name),
            "exactly one of the three that is not 0");
    }
    if (random.weight_fraction == 1 || (random.weight_fraction > 0 && empty)) {
        refuse(places.of(address(disc, "weight_fraction")),
               fmt::format("{} = {}{}", address(disc, "weight_fraction"), random.weight_fraction,
                           empty ? " in a scene without fluid" : ""),
               empty ? "0; say count or area_fraction" : "less than 1: the rest is fluid");
    }
}

void check_size_keys(const DiscScene& disc, const RandomDiscs& random, const Places& places) {
    const auto refuse_key = [&](std::string_view key, const std::string& value, std::string_view allowed) {
        refuse(places.of(address(disc, key)), fmt::format("{} = {}", address(disc, key), value), allowed);
    };
    const bool from_file = random.sizes == SizeDistribution::file;
    if (from_file != (random.radius == 0)) {
        refuse_key("radius", fmt::format("{}", random.radius),
                   from_file ? R"(0 with sizes = "file": the radii are the file's)"
                             : R"(a number > 0 (m); 0 only with sizes = "file")");
    }
    if (from_file == random.file.empty()) {
        refuse_key("file", fmt::format("\"{}\"", printable(random.file.string())),
                   from_file ? R"(the name of a CSV file with sizes = "file")"
                             : R"("" unless sizes = "file")");
    }
    const bool uniform = random.sizes == SizeDistribution::uniform;
    const bool spread = uniform || random.sizes == SizeDistribution::lognormal;
    if (spread != (random.spread > 0) || (uniform && !(random.spread < 1))) {
        refuse_key("spread", fmt::format("{}", random.spread),
                   uniform  ? R"(> 0 and < 1 with sizes = "uniform")"
                   : spread ? R"(> 0 with sizes = "lognormal")"
                            : R"(0 unless sizes = "uniform" or "lognormal")");
    }
}

void check_motion(const DiscScene& disc, const Places& places) {
    const bool moves = disc.velocity != Vector::Zero();
    if (disc.motion == DiscMotion::fixed && (moves || disc.spin != 0)) {
        const std::string key = address(disc, moves ? "velocity" : "spin");
        refuse(places.of(key), fmt::format("{} of a fixed disc that is not 0", key),
               R"(0 with motion = "fixed"; for another "free" or "prescribed")");
    }
}

void check_contact(const Scene& scene, const Places& places) {
    const double distance = scene.contact.distance;
    const double spacing = scene.numerics.particle_spacing;
    if (distance != 0 && distance < spacing) {
        refuse(places.of("contact.distance"), fmt::format("contact.distance = {}", distance),
               fmt::format("0, for two particle spacings, or at least one: {} (m)", spacing));
    }
    for (const int axis : {0, 1}) {
        const double half = scene.domain.size()[axis] / 2;
        if (!scene.discs.empty() && scene.domain.periodic[static_cast<std::size_t>(axis)] &&
            !(distance < half)) {
            refuse(places.of("contact.distance"), fmt::format("contact.distance = {}", distance),
                   fmt::format("less than {:.4g} (m), half the domain along {}, which is periodic: a disc "
                               "would be pushed by another from both sides",
                               half, axis == 0 ? 'x' : 'y'));
        }
    }
}

// The smallest radius and the key that it comes from.
std::pair<double, std::string> smallest_radius(const DiscScene& disc) {
    const auto* random = std::get_if<RandomDiscs>(&disc.placement);
    if (random == nullptr) {
        return {std::get<SingleDisc>(disc.placement).radius, address(disc, "radius")};
    }
    if (random->sizes == SizeDistribution::file) {
        return {*std::ranges::min_element(random->radii), address(disc, "file")};
    }
    const double least = random->sizes == SizeDistribution::uniform ? 1 - random->spread : 1;
    return {random->radius * least, address(disc, "radius")};
}

// Repulsion that begins at the distance d and is F at touch throws two discs of mass m that start with a gap
// g apart at the relative speed u (1 - g / d)^(3/2), where u^2 = 4 F d / (3 m); by default u is a fifth of
// the sound speed (Eq. 2.27).
void check_start_distance(const Scene& scene, const DiscScene& disc, double radius, const Places& places) {
    const auto* random = std::get_if<RandomDiscs>(&disc.placement);
    const bool thrown = disc.motion == DiscMotion::free && scene.start.arrangement != Arrangement::empty;
    if (random == nullptr || !thrown || random->least_distance == 0) {
        return;
    }
    const double distance = contact_distance(scene);
    const double mass = disc.density * std::numbers::pi * radius * radius;
    const Contact& contact = scene.contact;
    const double touch_speed = contact.force_scale > 0
                                   ? std::sqrt(4 * contact.force_scale * distance / (3 * mass))
                                   : scene.numerics.sound_speed / 5;
    const double most = 0.1 * scene.numerics.sound_speed * std::sqrt(contact.stiffness) / touch_speed;
    const double least = distance * (1 - std::pow(most, 2.0 / 3));
    if (!(random->least_distance >= least)) {
        refuse(places.of(address(disc, "least_distance")),
               fmt::format("{} = {}", address(disc, "least_distance"), random->least_distance),
               fmt::format(
                   "at least {:.4g} (m), or 0 for contact.distance: discs that start nearer are thrown apart "
                   "faster than a tenth of numerics.sound_speed",
                   least));
    }
}

} // namespace

double contact_distance(const Scene& scene) {
    return scene.contact.distance > 0 ? scene.contact.distance : 2 * scene.numerics.particle_spacing;
}

void check_disc_count(const Scene& scene, double count, const std::string& place) {
    constexpr double values_per_disc = 11; // of a sample
    if (!(count <= scene.limits.discs)) {
        refuse(place, fmt::format("{:.0f} discs", count), limit_text(scene.limits, &Limits::discs, count));
    }
    const double values = values_per_disc * count * scene.output.series_samples;
    if (!(values <= scene.limits.series_values)) {
        refuse(place,
               fmt::format("{:.0f} discs with output.series_samples = {}, {:.3g} values", count,
                           scene.output.series_samples, values),
               limit_text(scene.limits, &Limits::series_values, values));
    }
}

void check_discs(const Scene& scene, const Places& places) {
    check_names(scene, places);
    check_count(scene, places);
    for (const DiscScene& disc : scene.discs) {
        if (const auto* random = std::get_if<RandomDiscs>(&disc.placement)) {
            check_amount(disc, *random, scene.start.arrangement == Arrangement::empty, places);
            check_size_keys(disc, *random, places);
        }
        check_motion(disc, places);
    }
    check_contact(scene, places);
}

std::vector<std::string> check_disc_sizes(const Scene& scene, const Places& places) {
    std::vector<std::string> warnings;
    double smallest = std::numeric_limits<double>::infinity();
    for (const DiscScene& disc : scene.discs) {
        const auto [radius, key] = smallest_radius(disc);
        smallest = std::min(smallest, radius);
        check_start_distance(scene, disc, radius, places);
        const double across = 2 * radius / scene.numerics.particle_spacing;
        const std::string found = fmt::format(
            "a disc \"{}\" of radius {:.4g} (m), {:.3g} particle spacings across", disc.name, radius, across);
        if (!(across >= fewest_spacings_across * (1 - 1e-9))) {
            refuse(places.of(key), found,
                   fmt::format("at least {}: a larger radius, or a particle_spacing of at most {:.4g} (m)",
                               fewest_spacings_across, 2 * radius / fewest_spacings_across));
        }
        if (const double ratio = scene.numerics.smoothing_ratio;
            ratio > 1 && !(across >= fewest_spacings_across * ratio * (1 - 1e-9))) {
            refuse(places.of("numerics.smoothing_ratio"),
                   fmt::format("numerics.smoothing_ratio = {} with {}", ratio, found),
                   fmt::format(
                       "at most {:.4g}: fluid beside a disc of less than {} smoothing lengths across gets "
                       "into it",
                       across / fewest_spacings_across, fewest_spacings_across));
        }
        if (!(across >= enough_spacings_across * (1 - 1e-9))) {
            warnings.push_back(fmt::format(
                "{}: found {}, advised at least {}: a particle_spacing of at most {:.4g} (m)", places.of(key),
                found, enough_spacings_across, 2 * radius / enough_spacings_across));
        }
    }
    if (scene.contact.distance > smallest * (1 + 1e-9)) {
        warnings.push_back(
            fmt::format("{}: found contact.distance = {} (m), advised at most {:.4g}, the radius "
                        "of the smallest disc: discs repel each other before they are near",
                        places.of("contact.distance"), scene.contact.distance, smallest));
    }
    return warnings;
}

} // namespace slurry
