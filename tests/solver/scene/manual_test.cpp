#include "solver/scene/manual.hpp"

#include "solver/scene/parameters.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace slurry::test {
namespace {

TEST(Manual, HasEverySectionKeyUnitRangeAndMeaning) {
    const std::string terminal = scene_manual();
    const std::string markdown = scene_manual_markdown();
    for (const std::string& text : {terminal, markdown}) {
        for (const Section& section : sections()) {
            EXPECT_NE(text.find(section.heading()), std::string::npos) << section.name;
        }
        for (const Parameter& parameter : parameters()) {
            for (const std::string& part :
                 {std::string(parameter.key), parameter.allowed_text(), std::string(parameter.meaning)}) {
                EXPECT_NE(text.find(part), std::string::npos) << parameter.address() << ": " << part;
            }
        }
    }
}

TEST(Manual, SaysWhichDefaultsDependOnTheScheme) {
    EXPECT_NE(scene_manual().find("0.2 (scheme wang2014: 0.0)"), std::string::npos);
    EXPECT_NE(scene_manual().find("\"curve\" (scheme wang2014: \"lattice\")"), std::string::npos);
}

TEST(Manual, HasTablesOfFourColumns) {
    const std::string markdown = scene_manual_markdown();
    for (std::size_t begin = 0; begin < markdown.size(); begin = markdown.find('\n', begin) + 1) {
        const std::string line = markdown.substr(begin, markdown.find('\n', begin) - begin);
        if (line.starts_with('|')) {
            EXPECT_EQ(std::ranges::count(line, '|'), 5) << line;
        }
    }
}

} // namespace
} // namespace slurry::test
