#include "solver/time/step_count.hpp"

#include "solver/discs/contact.hpp"
#include "solver/scene/refusal.hpp"
#include "solver/time/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace slurry {

long step_count(const Scene& scene, double time_step) {
    const double steps = std::ceil(scene.output.end_time / time_step * (1 - 1e-12));
    if (!(steps <= scene.limits.steps)) {
        refuse(printable_path(scene.path),
               fmt::format("{:.4g} steps of {:.4g} s to output.end_time = {} (s)", steps, time_step,
                           scene.output.end_time),
               limit_text(scene.limits, &Limits::steps, steps));
    }
    return std::max(1L, static_cast<long>(steps));
}

long step_count(const Scene& scene, const Region& region, std::span<const Disc> discs) {
    return step_count(scene,
                      largest_time_step(scene, discs, DiscContacts(scene, region).highest_frequency(discs)));
}

} // namespace slurry
