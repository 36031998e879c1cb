#include "solver/discs/placement.hpp"
#include <numbers>
namespace slurry {
double PlacedDisc::mass() const {
    return density * std::numbers::pi * radius * radius;
}
double PlacedDisc::moment_of_inertia() const {
    return mass() * radius * radius / 2;
}
std::vector<PlacedDisc> place_discs(const Scene& scene, const Region&) {
    std::vector<PlacedDisc> placed;
    for (const DiscScene& disc : scene.discs) {
        const auto& one = std::get<SingleDisc>(disc.placement);
        placed.push_back(
            {disc.name, one.position, one.radius, disc.density, disc.motion, disc.velocity, disc.spin});
    }
    return placed;
}
} // namespace slurry
