// What the fuzzers have kept, tried again: their findings stay mended without a fuzzer.
#include "tests/fuzz/checkpoint_target.hpp"
#include "tests/fuzz/scene_grammar.hpp"
#include "tests/fuzz/targets.hpp"

#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <iterator>

namespace slurry::fuzz {
namespace {

std::string content(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void replay(const std::string& folder, const std::function<void(std::string_view)>& target) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator("tests/fuzz/corpus/" + folder)) {
        SCOPED_TRACE(entry.path());
        EXPECT_NO_THROW(target(content(entry.path())));
        ++files;
    }
    EXPECT_GT(files, 1);
}

TEST(Corpus, ScenesAreReadOrRefused) {
    replay("scene", try_scene);
}

TEST(Corpus, ProfilesAreReadOrRefused) {
    replay("profile", try_profile);
}

TEST(Corpus, CheckpointsAreReadOrRefused) {
    CheckpointTarget target;
    replay("checkpoint", [&](std::string_view input) { target(input); });
}

TEST(Corpus, ChangedCheckpointsAreReadOrRefused) {
    CheckpointTarget target;
    RandomSource random(1);
    for (int k = 0; k < 300; ++k) {
        std::string input(1 + random.below(40), '\0');
        for (char& byte : input) {
            byte = static_cast<char>(random.below(256));
        }
        ASSERT_NO_THROW(target(input)) << k;
    }
}

TEST(Corpus, ChangedScenesAreReadOrRefused) {
    RandomSource random(1);
    std::string text = content("tests/fuzz/corpus/scene/full.toml");
    for (int k = 0; k < 2000; ++k) {
        if (k % 20 == 0) {
            text = content("tests/fuzz/corpus/scene/full.toml");
        }
        text = changed_scene(text, random);
        ASSERT_NO_THROW(try_scene(text)) << text;
    }
}

TEST(Corpus, ARefusalWithoutPlaceOrReasonIsAFault) {
    EXPECT_NO_THROW(demand_reason("tests/fuzz/corpus/scene.toml:3:1: found x, allowed y"));
    for (const char* message :
         {"", "found x, allowed y", "tests/fuzz/corpus/scene.toml: found x, allowed y",
          "other.toml:3:1: found x, allowed y", "tests/fuzz/corpus/scene.toml:3:1: wrong",
          "tests/fuzz/corpus/scene.toml:3:1: found x,\n allowed y"}) {
        EXPECT_THROW(demand_reason(message), std::logic_error) << message;
    }
}

} // namespace
} // namespace slurry::fuzz
