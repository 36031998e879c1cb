// There is always a good checkpoint, whatever happens to the others.
#include "solver/time/checkpoint_folder.hpp"

#include "solver/output/seal.hpp"
#include "tests/solver/time/resumable_run.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

namespace slurry::testing {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_bytes(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

TEST(FindCheckpoint, SaysWhenTheRunIsComplete) {
    const OwnFolder folder;
    const auto reason = [&] {
        try {
            return find_checkpoint(folder.path()).path.string();
        } catch (const ReadError& error) {
            return std::string(error.what());
        }
    };
    const std::string lacking = "no checkpoint to resume from";
    EXPECT_NE(reason().find(lacking), std::string::npos) << reason();
    const fs::path result = folder.path() / "result.h5";
    write_bytes(result, "whole");
    EXPECT_NE(
        reason().find("there is nothing to resume: the run is complete, its result is " + result.string()),
        std::string::npos)
        << reason();
    write_bytes(folder.path() / "result.h5.partial", "of a second run, killed before its first checkpoint");
    EXPECT_NE(reason().find(lacking), std::string::npos) << reason();
    fs::remove(folder.path() / "result.h5.partial");
    write_bytes(folder.path() / "checkpoint.previous.h5", "damaged");
    EXPECT_NE(reason().find(lacking), std::string::npos) << reason();
}

class CheckpointFolderTest : public ::testing::Test {
  protected:
    CheckpointFolderTest() { run_.go_to(1); }

    CheckpointFolder keeper(const fs::path& resumed_from = {}) {
        return {folder_.path(), 600, resumed_from, [this] { return now_; }};
    }
    void write_after_a_step(CheckpointFolder& keeper) {
        run_.go_to(run_.step + 1);
        keeper.write(run_identity(run_.scene), run_.state, "scene.toml");
    }
    [[nodiscard]] long step_in(const fs::path& path) const {
        return static_cast<long>(Hdf5Reader(path).number("/state", "step"));
    }

    OwnFolder folder_;
    fs::path current_ = folder_.path() / "checkpoint.h5";
    fs::path previous_ = folder_.path() / "checkpoint.previous.h5";
    ResumableRun run_{doubly_periodic(8), folder_.path()};
    double now_ = 1000;
};

TEST_F(CheckpointFolderTest, IsDueWheneverTheIntervalHasPassed) {
    CheckpointFolder folder = keeper();
    EXPECT_FALSE(folder.due());
    now_ += 599;
    EXPECT_FALSE(folder.due());
    now_ += 2;
    EXPECT_TRUE(folder.due());
    EXPECT_FALSE(folder.due());
    now_ += 601;
    EXPECT_TRUE(folder.due());
    EXPECT_FALSE(CheckpointFolder(folder_.path(), 0, "", [] { return 1e9; }).due());
}

TEST_F(CheckpointFolderTest, KeepsTheLastTwo) {
    CheckpointFolder folder = keeper();
    write_after_a_step(folder);
    EXPECT_EQ(find_checkpoint(folder_.path()).path, current_);
    EXPECT_FALSE(fs::exists(previous_));
    write_after_a_step(folder);
    write_after_a_step(folder);
    EXPECT_EQ(step_in(current_), run_.step);
    EXPECT_EQ(step_in(previous_), run_.step - 1);
    folder.remove();
    EXPECT_FALSE(fs::exists(current_) || fs::exists(previous_));
    EXPECT_THROW((void)find_checkpoint(folder_.path()), ReadError);
}

TEST_F(CheckpointFolderTest, DetectsAnyBitThatChanged) {
    CheckpointFolder folder = keeper();
    write_after_a_step(folder);
    const std::string good = bytes_of(current_);
    EXPECT_EQ(seal_fault(current_), "");
    std::mt19937 generator(1);
    std::vector<std::size_t> places{0, 60, seal_size - 1, seal_size, good.size() - 1};
    for (int k = 0; k < 200; ++k) {
        places.push_back(generator() % good.size());
    }
    for (const std::size_t place : places) {
        std::string bad = good;
        bad[place] = static_cast<char>(bad[place] ^ (1 << generator() % 8));
        write_bytes(current_, bad);
        EXPECT_NE(seal_fault(current_), "") << "byte " << place;
    }
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{100}, seal_size, good.size() / 2, good.size() - 1}) {
        write_bytes(current_, good.substr(0, size));
        EXPECT_NE(seal_fault(current_).find("cut short"), std::string::npos) << size;
    }
    write_bytes(current_, good + "x");
    EXPECT_NE(seal_fault(current_), "");
}

TEST_F(CheckpointFolderTest, TakesTheOneBeforeADamagedOneAndKeepsIt) {
    CheckpointFolder folder = keeper();
    write_after_a_step(folder);
    write_after_a_step(folder);
    write_bytes(current_, bytes_of(current_).substr(0, 2000));
    const FoundCheckpoint found = find_checkpoint(folder_.path());
    EXPECT_EQ(found.path, previous_);
    EXPECT_NE(found.warning.find(current_.string()), std::string::npos) << found.warning;
    CheckpointFolder resumed = keeper(found.path);
    write_after_a_step(resumed);
    EXPECT_EQ(step_in(current_), run_.step);
    EXPECT_EQ(step_in(previous_), run_.step - 2) << "the damaged one is not to take a good one's place";
    write_bytes(current_, "");
    write_bytes(previous_, "");
    EXPECT_THROW((void)find_checkpoint(folder_.path()), ReadError);
}

TEST_F(CheckpointFolderTest, TakesTheOneBeforeWhenTheLastIsMissing) {
    CheckpointFolder folder = keeper();
    write_after_a_step(folder);
    write_after_a_step(folder);
    fs::remove(current_); // killed between the two renames
    EXPECT_EQ(find_checkpoint(folder_.path()).path, previous_);
}

TEST_F(CheckpointFolderTest, ReplacesThoseOfAnEarlierRun) {
    CheckpointFolder folder = keeper();
    write_after_a_step(folder);
    write_after_a_step(folder);
    CheckpointFolder anew = keeper();
    EXPECT_TRUE(anew.has_foreign());
    EXPECT_FALSE(keeper(current_).has_foreign());
    write_after_a_step(anew);
    EXPECT_FALSE(anew.has_foreign());
    EXPECT_EQ(step_in(current_), run_.step);
    EXPECT_FALSE(fs::exists(previous_)) << "of another run";
}

} // namespace
} // namespace slurry::testing
