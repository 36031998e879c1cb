#include "solver/discs/contact.hpp"

#include "solver/particles/run_error.hpp"
#include "solver/scene/disc_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slurry {

namespace {

struct Place {
    std::size_t disc;
    Vector position;
};

// Centres in the domain, sorted by x; those within `reach` of a periodic lower side once more beyond the
// upper one.
std::vector<Place> sorted_places(std::span<const Disc> discs, const Domain& domain, double reach) {
    std::vector<Place> places;
    const Vector size = domain.size();
    for (std::size_t k = 0; k < discs.size(); ++k) {
        Vector position = discs[k].position;
        if (domain.periodic[0]) {
            position.x() -= std::floor((position.x() - domain.lower.x()) / size.x()) * size.x();
            if (position.x() < domain.lower.x() + reach) {
                places.push_back({k, position + Vector(size.x(), 0)});
            }
        }
        places.push_back({k, position});
    }
    std::ranges::sort(places, {}, [](const Place& place) { return place.position.x(); });
    return places;
}

// Calls visit(a, b, from a to b) once for every two discs whose centres are nearer than `reach`.
template <class Visit>
void for_near_pairs(std::span<const Disc> discs, const Domain& domain, double reach, Visit&& visit) {
    const auto places = sorted_places(discs, domain, reach);
    for (auto a = places.begin(); a != places.end(); ++a) {
        for (auto b = a + 1; b != places.end() && b->position.x() - a->position.x() < reach; ++b) {
            const bool copies = a->position.x() >= domain.upper.x() && domain.periodic[0];
            Vector offset = b->position - a->position;
            if (domain.periodic[1]) {
                offset.y() -= std::round(offset.y() / domain.size().y()) * domain.size().y();
            }
            if (a->disc != b->disc && !copies && offset.norm() < reach) {
                visit(a->disc, b->disc, offset);
            }
        }
    }
}

double largest_radius(std::span<const Disc> discs) {
    double largest = 0;
    for (const Disc& disc : discs) {
        largest = std::max(largest, disc.radius);
    }
    return largest;
}

double squared_frequency(double touch_force, double distance, double mass) {
    return 2 * touch_force / (distance * mass);
}

} // namespace

DiscContacts::DiscContacts(const Scene& scene, const Region& region)
    : domain_(scene.domain), region_(region), contact_(scene.contact),
      stopped_speed_(scene.numerics.sound_speed / 5),
      largest_overlap_(0.5 * scene.numerics.particle_spacing) {
    contact_.distance = contact_distance(scene);
}

// c / epsilon of Eq. 2.27. By default the work on the way from the first contact to touch is the kinetic
// energy of a speed that no disc should have.
double DiscContacts::touch_force(const Disc& a, const Disc& b) const {
    if (contact_.force_scale > 0) {
        return contact_.force_scale / contact_.stiffness;
    }
    const double inverse_mass = (a.free() ? 1 / a.mass : 0) + (b.free() ? 1 / b.mass : 0);
    return inverse_mass > 0 ? 1.5 * stopped_speed_ * stopped_speed_ /
                                  (inverse_mass * contact_.distance * contact_.stiffness)
                            : 0;
}

// The same: the way is half as long, since the mirror disc moves, too.
double DiscContacts::touch_force_at_wall(const Disc& disc) const {
    return contact_.force_scale > 0
               ? contact_.force_scale / contact_.stiffness
               : 3 * stopped_speed_ * stopped_speed_ * disc.mass / (contact_.distance * contact_.stiffness);
}

void DiscContacts::note_gap(const Particles& particles, std::size_t disc, double gap,
                            const std::string& other) {
    least_gap_ = std::min(least_gap_, gap);
    if (gap < -largest_overlap_) {
        const Disc& at = particles.discs[disc];
        throw RunError(
            fmt::format("time {:.6g} s: disc '{}' at ({:.6g}, {:.6g}) m overlaps {} by {:.3g} m; raise "
                        "contact.force_scale or contact.distance, or numerics.sound_speed to 10 times "
                        "the top speed",
                        particles.time, at.name, at.position.x(), at.position.y(), other, -gap));
    }
}

// Eq. 2.27
void DiscContacts::repel(Particles& particles, std::size_t a, std::size_t b, const Vector& a_to_b) {
    Disc& first = particles.discs[a];
    Disc& second = particles.discs[b];
    const double gap = a_to_b.norm() - first.radius - second.radius;
    note_gap(particles, a, gap, "disc '" + second.name + "'");
    const double depth = 1 - gap / contact_.distance;
    if (depth <= 0) {
        return;
    }
    if (first_contact_time_ < 0) {
        first_contact_time_ = particles.time;
    }
    const Vector force = touch_force(first, second) * depth * depth * a_to_b.normalized();
    first.contact_force -= force;
    second.contact_force += force;
}

// Eq. 2.28: the centre of the mirror disc is twice as far as the wall.
void DiscContacts::repel_from_wall(Particles& particles, std::size_t a, const Wall& wall) {
    Disc& disc = particles.discs[a];
    const NearestPoint nearest = wall.nearest(disc.position - wall.displacement(particles.time));
    const double gap = nearest.distance - disc.radius;
    if (gap > contact_.distance) {
        return;
    }
    note_gap(particles, a, gap, "wall '" + wall.name() + "'");
    const double depth = 1 - 2 * gap / contact_.distance;
    if (depth > 0) {
        disc.contact_force += touch_force_at_wall(disc) * depth * depth * nearest.normal;
    }
}

void DiscContacts::compute(Particles& particles) {
    for (Disc& disc : particles.discs) {
        disc.contact_force.setZero();
    }
    const double reach = 2 * largest_radius(particles.discs) + contact_.distance;
    for_near_pairs(particles.discs, domain_, reach, [&](std::size_t a, std::size_t b, const Vector& a_to_b) {
        repel(particles, a, b, a_to_b);
    });
    for (std::size_t k = 0; k < particles.discs.size(); ++k) {
        for (const Wall& wall : region_.walls()) {
            repel_from_wall(particles, k, wall);
        }
    }
}

double DiscContacts::highest_frequency(std::span<const Disc> discs) const {
    double squared = 0;
    for (const Disc& disc : discs) {
        if (disc.free()) { // two alike are the stiffest pair
            squared = std::max(
                {squared, squared_frequency(touch_force(disc, disc), contact_.distance, disc.mass / 2),
                 squared_frequency(2 * touch_force_at_wall(disc), contact_.distance, disc.mass)});
        }
    }
    return std::sqrt(squared);
}

} // namespace slurry
