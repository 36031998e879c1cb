#include "solver/converge/shell_command.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace slurry {
namespace {

std::string shell_word(const std::string& word) {
    const auto plain = [](char sign) {
        return std::isalnum(static_cast<unsigned char>(sign)) != 0 ||
               std::string_view("_-+=./:,%@").find(sign) != std::string_view::npos;
    };
    if (!word.empty() && std::ranges::all_of(word, plain)) {
        return word;
    }
    std::string quoted = "'";
    for (const char sign : word) {
        if (sign == '\'') {
            quoted += "'\\'"; // ends the quotes, and a quote of its own begins them again
        }
        quoted += sign;
    }
    quoted += '\'';
    return quoted;
}

} // namespace

std::string shell_command(std::span<const std::string> words) {
    std::string command;
    for (const std::string& word : words) {
        if (!command.empty()) {
            command += ' ';
        }
        command += shell_word(word);
    }
    return command;
}

} // namespace slurry
