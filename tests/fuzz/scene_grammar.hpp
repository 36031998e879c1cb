#pragma once
// Scenes out of the parameter table: the grammar of the fuzzer.
#include "solver/scene/parameters.hpp"
#include "tests/fuzz/random_source.hpp"

#include <string>

namespace slurry::fuzz {

// A value as TOML that the parameter allows.
[[nodiscard]] std::string allowed_value(const Parameter& parameter, RandomSource& random);

// Any value as TOML: allowed, at an edge of what is allowed or of numbers, or of another type.
[[nodiscard]] std::string any_value(const Parameter& parameter, RandomSource& random);

// A table with its heading and the keys that have no default, some of the others and now and then one too
// few.
[[nodiscard]] std::string random_table(RandomSource& random);

// The text of a scene with one change that the grammar knows: another value for a key, a key more or less, a
// table more, a line twice.
[[nodiscard]] std::string changed_scene(const std::string& text, RandomSource& random);

} // namespace slurry::fuzz
