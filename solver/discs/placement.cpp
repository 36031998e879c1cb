#include "solver/discs/placement.hpp"

#include "solver/discs/crowd.hpp"
#include "solver/discs/groups.hpp"
#include "solver/geometry/geometry_error.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numbers>

namespace slurry {
namespace {

constexpr double rounding = 1e-9; // radii that a rim may be behind a wall that it touches
// Places tried for the random discs in all. Random places one after another fill 0.547 of the plane at most;
// this many tries fill more than half of it.
constexpr std::size_t tries_at_least = 100'000;
constexpr std::size_t tries_per_disc = 1'000;

// One disc of a group.
struct Member {
    const DiscGroup* group;
    Rim rim;
    std::string name;
};

std::vector<Member> members_of(const std::vector<DiscGroup>& groups) {
    std::vector<Member> members;
    for (const DiscGroup& group : groups) {
        const auto* single = std::get_if<SingleDisc>(&group.scene->placement);
        for (std::size_t i = 0; i < group.radii.size(); ++i)
            members.push_back(
                {&group,
                 {single != nullptr ? single->position : Vector(Vector::Zero()), group.radii[i],
                  group.least_distance},
                 single != nullptr ? group.scene->name : fmt::format("{}_{}", group.scene->name, i + 1)});
    }
    return members;
}

Crowd crowd_for(const Domain& domain, const std::vector<Member>& members) {
    double radius = 0;
    double distance = 0;
    for (const Member& member : members) {
        radius = std::max(radius, member.rim.radius);
        distance = std::max(distance, member.rim.least_distance);
    }
    return {domain, radius, distance};
}

// Gives the discs their places one after another.
class Placement {
  public:
    Placement(const Region& region, std::vector<Member>& members)
        : region_(region), domain_(region.domain()), members_(members), crowd_(crowd_for(domain_, members)) {}

    void place() {
        std::vector<std::size_t> random;
        for (std::size_t m = 0; m < members_.size(); ++m) {
            check_own_image(members_[m]);
            if (members_[m].group->generator != nullptr)
                random.push_back(m);
            else
                place_single(m);
        }
        // The large ones find no room between the small ones.
        std::ranges::stable_sort(random, std::ranges::greater{},
                                 [&](std::size_t m) { return members_[m].rim.radius; });
        tries_left_ = tries_at_least + tries_per_disc * random.size();
        for (const std::size_t m : random)
            place_random(m, random.size());
    }

  private:
    void check_own_image(const Member& member) const {
        const double needed = 2 * member.rim.radius + member.rim.least_distance;
        for (const int axis : {0, 1}) {
            const double period = domain_.size()[axis];
            if (domain_.periodic[static_cast<std::size_t>(axis)] && !(needed <= period))
                throw GeometryError(fmt::format(
                    "disc '{}' meets its own image: the domain is periodic along {} and {:.4g} m long "
                    "there, the disc and least_distance need {:.4g} m; widen the domain, or make the "
                    "disc smaller",
                    member.name, axis == 0 ? 'x' : 'y', period, needed));
        }
    }

    void add(std::size_t m) {
        crowd_.add(members_[m].rim);
        placed_.push_back(m);
    }

    // Sides that are not periodic are behind walls: the region sees to that.
    [[nodiscard]] bool has_room(const Rim& rim) const {
        return !crowd_.too_near(rim) &&
               region_.distance(rim.centre) >= rim.radius * (1 - rounding) + rim.least_distance;
    }

    void place_single(std::size_t m) {
        const Member& member = members_[m];
        const Rim& rim = member.rim;
        const std::string disc =
            fmt::format("disc '{}' at ({:.4g}, {:.4g}) m", member.name, rim.centre.x(), rim.centre.y());
        if (!((rim.centre - domain_.lower).minCoeff() >= 0 && (domain_.upper - rim.centre).minCoeff() >= 0))
            throw GeometryError(fmt::format("{}: its centre is outside the domain: move it in", disc));
        if (const auto other = crowd_.too_near(rim))
            throw GeometryError(
                fmt::format("{} overlaps disc '{}' by {:.4g} m: move them apart, or make them smaller", disc,
                            members_[placed_[*other]].name, -crowd_.gap(rim, *other)));
        for (const Wall& wall : region_.walls())
            if (const double gap = wall.nearest(rim.centre).distance - rim.radius;
                !(gap >= -rounding * rim.radius))
                throw GeometryError(fmt::format(
                    "{}: its rim is {:.4g} m behind wall '{}': move it into the fluid, or make it "
                    "smaller",
                    disc, -gap, wall.name()));
        add(m);
    }

    void place_random(std::size_t m, std::size_t wanted) {
        Rim& rim = members_[m].rim;
        gsl_rng* generator = members_[m].group->generator.get();
        for (; tries_left_ > 0; --tries_left_) {
            const double x = gsl_rng_uniform(generator);
            const double y = gsl_rng_uniform(generator);
            rim.centre = domain_.lower + Vector(x, y).cwiseProduct(domain_.size());
            if (has_room(rim)) {
                add(m);
                return;
            }
        }
        refuse_crowd(members_[m], wanted);
    }

    [[noreturn]] void refuse_crowd(const Member& member, std::size_t wanted) const {
        double area = 0;
        std::size_t random = 0;
        for (const std::size_t m : placed_) {
            area += std::numbers::pi * members_[m].rim.radius * members_[m].rim.radius;
            random += members_[m].group->generator != nullptr ? 1 : 0;
        }
        throw GeometryError(fmt::format(
            "discs '{}': {} of {} random discs have a place after {} tries, and there is no room for "
            "one of radius {:.4g} m; all discs have an area fraction of {:.3g}. Ask for fewer or "
            "smaller discs, or a smaller least_distance: at random places discs fill about half of an "
            "area at most, half of least_distance around each of them counted",
            member.group->scene->name, random, wanted, tries_at_least + tries_per_disc * wanted,
            member.rim.radius, area / region_.fluid_area()));
    }

    const Region& region_;
    const Domain& domain_;
    std::vector<Member>& members_;
    Crowd crowd_;
    std::vector<std::size_t> placed_; // in the order of the crowd
    std::size_t tries_left_ = 0;
};

} // namespace

double PlacedDisc::mass() const {
    return density * std::numbers::pi * radius * radius;
}

double PlacedDisc::moment_of_inertia() const {
    return mass() * radius * radius / 2;
}

std::vector<PlacedDisc> place_discs(const Scene& scene, const Region& region) {
    const std::vector<DiscGroup> groups = draw_groups(scene, region.fluid_area());
    std::vector<Member> members = members_of(groups);
    Placement(region, members).place();
    std::vector<PlacedDisc> discs;
    for (const Member& member : members) {
        const DiscScene& from = *member.group->scene;
        discs.push_back({member.name, member.rim.centre, member.rim.radius, from.density, from.motion,
                         from.velocity, from.spin});
    }
    return discs;
}

} // namespace slurry
