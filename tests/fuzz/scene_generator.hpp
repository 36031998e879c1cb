#pragma once
// Small scenes that make physical sense: flows well below the speed of sound, between walls of every shape,
// with discs.
#include "tests/fuzz/random_source.hpp"

#include <string>

namespace slurry::fuzz {

// How far the keys of [numerics] and [start] may stray: within what the manual recommends, or to any value
// that it allows.
enum class NumericsRange : unsigned char { recommended, allowed };

// The text of a scene of some hundred particles. Its geometry may turn out impossible, which is then refused.
[[nodiscard]] std::string random_flow(RandomSource& random,
                                      NumericsRange numerics = NumericsRange::recommended);

} // namespace slurry::fuzz
