#include "solver/scene/wall_checks.hpp"

#include "solver/scene/refusal.hpp"

#include <fmt/format.h>
#include <string_view>

namespace slurry {
namespace {

constexpr double rounding = 1e-9; // relative

// A length of a wall's shape and how much of the domain's width it may take.
class WidthCheck {
  public:
    WidthCheck(const Scene& scene, const WallScene& wall, std::string_view key, double length,
               const Places& places)
        : address_(fmt::format("walls.{}.{}", wall.name, key)), length_(length),
          width_(scene.domain.size().x()), place_(places.of(address_)) {}

    void require(double share, std::string_view reason) const {
        if (!fits(share)) {
            refuse(place_, fmt::format("{} = {}", address_, length_),
                   fmt::format("at most {:.4g} (m), {}", share * width_, reason));
        }
    }
    void advise(double share, std::string_view reason, std::vector<std::string>& warnings) const {
        if (!fits(share)) {
            warnings.push_back(fmt::format("{}: found {} = {} (m), advised at most {:.4g}, {}", place_,
                                           address_, length_, share * width_, reason));
        }
    }

  private:
    [[nodiscard]] bool fits(double share) const { return length_ <= share * width_ * (1 + rounding); }

    std::string address_;
    double length_, width_; // m
    const std::string& place_;
};

// The paper's widest asperity has a standard deviation of a quarter of its domain: at the seam it is still a
// seventh of its height.
void check_gaussian(const WidthCheck& check, bool periodic, std::vector<std::string>& warnings) {
    if (!periodic) {
        check.advise(1, "the domain's width: a wider bump is all but flat in it", warnings);
        return;
    }
    check.require(1, "the width of the periodic domain: a wider bump is flat in it");
    check.advise(0.25,
                 "a quarter of the periodic domain's width: a wider bump is cut off, with a kink where the "
                 "domain repeats",
                 warnings);
}

// The second harmonic of a random profile has exp(-3 (pi l / L)^2) of the first one's variance: a third at
// l = L / 5, a hundredth at 2 L / 5, nothing at l = L.
void check_random(const WidthCheck& check, std::vector<std::string>& warnings) {
    check.require(1, "the domain's width: a longer one leaves one cosine, and nothing random but its place");
    check.advise(0.2, "a fifth of the domain's width: the longer it is, the more the profile is one cosine",
                 warnings);
}

} // namespace

std::vector<std::string> check_wall_shapes(const Scene& scene, const Places& places) {
    std::vector<std::string> warnings;
    for (const WallScene& wall : scene.walls) {
        if (const auto* gaussian = std::get_if<GaussianShape>(&wall.shape)) {
            check_gaussian({scene, wall, "width", gaussian->width, places}, scene.domain.periodic[0],
                           warnings);
        } else if (const auto* random = std::get_if<RandomShape>(&wall.shape)) {
            check_random({scene, wall, "correlation_length", random->correlation_length, places}, warnings);
        }
    }
    return warnings;
}

} // namespace slurry
