#pragma once
// What must hold between the values of a scene's discs.
#include "solver/scene/checks.hpp"

#include <string>
#include <vector>

namespace slurry {

// More are taken for a mistake.
inline constexpr int most_discs = 100'000;
// A disc of fewer particle spacings across is refused.
inline constexpr double fewest_spacings_across = 3;

// Throws SceneError: names that a random group gives its discs, too, more discs than most_discs, groups with
// no or more than one of count, area_fraction and weight_fraction, keys that do not fit `sizes`, fixed discs
// that move, a contact distance below the particle spacing.
void check_discs(const Scene& scene, const Places& places);

// Warns of discs of few particle spacings across, one line each, and throws SceneError when there are too few
// of them. For scenes whose files are loaded; the radii of a lognormal distribution are only known when
// drawn.
[[nodiscard]] std::vector<std::string> check_disc_sizes(const Scene& scene, const Places& places);

} // namespace slurry
