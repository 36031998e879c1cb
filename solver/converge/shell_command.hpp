#pragma once
// A command line as a user can give it to a shell again.
#include <span>
#include <string>

namespace slurry {

// The words with blanks between them, in quotes where a shell would make something else of a word.
[[nodiscard]] std::string shell_command(std::span<const std::string> words);

} // namespace slurry
