#include "solver/converge/shell_command.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace slurry {
namespace {

TEST(ShellCommand, PlainWordsStayAsTheyAre) {
    const std::vector<std::string> words{"slurry", "converge", "my/scene.toml", "--set", "fluid.density=1e3"};
    EXPECT_EQ(shell_command(words), "slurry converge my/scene.toml --set fluid.density=1e3");
}

TEST(ShellCommand, WhatAShellWouldReadIsQuoted) {
    const std::vector<std::string> words{"a b", "walls.pad.velocity=[1, 0]", "it's", "", "$HOME"};
    EXPECT_EQ(shell_command(words), R"('a b' 'walls.pad.velocity=[1, 0]' 'it'\''s' '' '$HOME')");
}

} // namespace
} // namespace slurry
