#pragma once
// What must hold between the values of a scene's discs.
#include "solver/scene/checks.hpp"

#include <string>
#include <vector>

namespace slurry {

// A disc of fewer particle spacings across is refused.
inline constexpr double fewest_spacings_across = 3;

// Between rims where repulsion begins, m.
[[nodiscard]] double contact_distance(const Scene& scene);

// Throws SceneError when so many discs, or the samples of so many, exceed scene.limits.
void check_disc_count(const Scene& scene, double count, const std::string& place);

// Throws SceneError: names that a random group gives its discs, too, more discs than scene.limits, groups
// with no or more than one of count, area_fraction and weight_fraction, keys that do not fit `sizes`, fixed
// discs that move, a contact distance below the particle spacing or of half a periodic side.
void check_discs(const Scene& scene, const Places& places);

// Warns of discs of few particle spacings across, and of repulsion that reaches beyond the smallest radius,
// one line each, and throws SceneError when there are too few
// of them, or when random discs may start so near that their repulsion throws them apart. For scenes whose
// files are loaded; the radii of a lognormal distribution are only known when drawn.
[[nodiscard]] std::vector<std::string> check_disc_sizes(const Scene& scene, const Places& places);

} // namespace slurry
