#include "solver/scene/resolved.hpp"

#include "solver/scene/parameters.hpp"

#include <fmt/format.h>

namespace slurry {

std::string resolved_text(const Scene& scene) {
    std::string text;
    for (const Section& section : sections()) {
        for (std::size_t index = 0; index < section.count(scene); ++index) {
            text += fmt::format("{}{}\n", text.empty() ? "" : "\n", section.heading());
            const std::string chosen = section.chosen(scene, index);
            for (const Parameter* parameter : parameters_of(section.name)) {
                if (parameter->belongs_to(chosen)) {
                    text += fmt::format("{} = {}\n", parameter->key,
                                        to_toml(parameter->get(scene, index), parameter->binding.kind));
                }
            }
        }
    }
    return text;
}

} // namespace slurry
