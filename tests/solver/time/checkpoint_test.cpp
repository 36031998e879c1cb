// A run that goes on from a checkpoint comes to the same bits, and from what is not its own it does not go
// on.
#include "solver/time/checkpoint.hpp"

#include "tests/solver/time/resumable_run.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

constexpr long middle = 23; // the lists are some steps old then
constexpr long last = 60;

Scene without_walls() {
    Scene scene = doubly_periodic(12);
    jitter(scene, 0.2);
    scene.start.velocity = InitialVelocity::taylor_green;
    scene.start.speed = 1;
    return scene;
}

Scene discs_alone() {
    Scene scene = channel_with_discs();
    scene.start.arrangement = Arrangement::empty;
    return scene;
}

void write(const ResumableRun& run, const std::filesystem::path& path, const RunIdentity& identity) {
    PartialFile file(path);
    write_checkpoint(file, identity, run.state, "scene.toml");
    file.synchronise();
    file.commit();
}

class Checkpoint : public ::testing::Test {
  protected:
    // A run that was left alone, and its checkpoint on the way.
    std::vector<double> run_through(const Scene& scene) {
        ResumableRun run(scene, folder_.path() / "through");
        run.go_to(middle);
        write(run, path_, run_identity(scene));
        run.go_to(last);
        return run.numbers();
    }
    // What a run of the scene says to the checkpoint of another.
    std::string complaint(const RunIdentity& there, const RunIdentity& here) {
        ResumableRun run(without_walls(), folder_.path() / "run");
        run.go_to(1);
        write(run, path_, there);
        try {
            read_checkpoint(path_, here, run.state);
        } catch (const ReadError& error) {
            return error.what();
        }
        return "";
    }

    OwnFolder folder_;
    std::filesystem::path path_ = folder_.path() / "checkpoint.h5";
};

TEST_F(Checkpoint, LeadsToTheSameBits) {
    for (const Scene& scene : {channel_with_discs(), without_walls(), discs_alone()}) {
        const std::vector<double> expected = run_through(scene);
        ResumableRun resumed(scene, folder_.path() / "resumed");
        read_checkpoint(path_, run_identity(scene), resumed.state);
        EXPECT_EQ(resumed.step, middle);
        resumed.go_to(last);
        EXPECT_EQ(resumed.numbers(), expected);
    }
}

TEST_F(Checkpoint, WouldLeadToOtherBitsWithNewLists) {
    const Scene scene = channel_with_discs();
    const std::vector<double> expected = run_through(scene);
    ResumableRun resumed(scene, folder_.path() / "resumed");
    read_checkpoint(path_, run_identity(scene), resumed.state);
    EXPECT_LT(resumed.sums->list_origin().time, resumed.particles.time);
    const auto anew = make_interactions(scene);
    resumed.forces.interactions.restore_lists(resumed.particles, [&] {
        anew->refresh_neighbours(resumed.particles);
        return anew->list_origin();
    }());
    resumed.go_to(last);
    EXPECT_NE(resumed.numbers(), expected);
}

TEST_F(Checkpoint, TakesBackWhatWasRecorded) {
    const Scene scene = channel_with_discs();
    run_through(scene);
    ResumableRun resumed(scene, folder_.path() / "resumed");
    read_checkpoint(path_, run_identity(scene), resumed.state);
    resumed.go_to(last);
    resumed.result.finish();
    const Hdf5Reader reader(folder_.path() / "resumed" / "result.h5");
    EXPECT_EQ(reader.size("/series/time"), static_cast<std::size_t>(last));
    EXPECT_EQ(reader.size("/series/kinetic_energy"), static_cast<std::size_t>(last));
}

TEST_F(Checkpoint, CountsTheTimeSpentBefore) {
    const Scene scene = without_walls();
    run_through(scene);
    ResumableRun resumed(scene, folder_.path() / "resumed");
    read_checkpoint(path_, run_identity(scene), resumed.state);
    const Hdf5Reader reader(path_);
    EXPECT_GE(resumed.clock.elapsed(), reader.number("/clock", "elapsed"));
    EXPECT_EQ(resumed.clock.phases().size(), static_cast<std::size_t>(reader.number("/clock", "phases")));
}

TEST_F(Checkpoint, OfAnotherRunIsRefusedWithTheDifference) {
    const RunIdentity identity = run_identity(channel_with_discs());
    EXPECT_EQ(complaint(identity, identity), "");
    const auto expect = [&](auto&& change, const std::string& named) {
        RunIdentity here = identity;
        change(here);
        const std::string message = complaint(identity, here);
        EXPECT_NE(message.find(named), std::string::npos) << message;
        EXPECT_NE(message.find(path_.string()), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    };
    const auto replace = [](std::string& text, const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    expect([](RunIdentity& here) { here.version = "9.9"; }, "here 9.9");
    expect([](RunIdentity& here) { here.arithmetic = "double in 8 lanes"; }, "here double in 8 lanes");
    expect([](RunIdentity& here) { here.files = "0"; }, "CSV files");
    expect([&](RunIdentity& here) { replace(here.scene, "10.0", "20.0"); },
           "numerics.sound_speed = 10.0, here 20.0");
    expect([&](RunIdentity& here) { replace(here.scene, "[1.0, 0.0]", "[2.0, 0.0]"); },
           "walls.lid.velocity = [1.0, 0.0], here [2.0, 0.0]");
    expect([&](RunIdentity& here) { here.scene += "\n[[discs]]\nname = \"grain\"\n"; }, "discs.grain");
}

TEST_F(Checkpoint, WhateverItsSceneIsTheDifferenceIsNamedInOneLine) {
    const RunIdentity here = run_identity(channel_with_discs());
    for (const char* scene :
         {"", "[", "[[", "]", "[a", "name = ", "name = \"", "[walls]\nname = \"\x1b\r\""}) {
        RunIdentity there = here;
        there.scene = scene;
        const std::string found = difference(there, here);
        EXPECT_FALSE(found.empty()) << scene;
        EXPECT_EQ(found.find_first_of("\r\n\x1b"), std::string::npos) << found;
    }
}

TEST_F(Checkpoint, OfAnIntervalOfItsOwnIsTaken) {
    const RunIdentity identity = run_identity(channel_with_discs());
    RunIdentity here = identity;
    here.scene.replace(here.scene.find("600.0"), 5, "1.0");
    EXPECT_EQ(complaint(identity, here), "");
}

TEST_F(Checkpoint, OfOtherParticlesIsRefused) {
    const Scene scene = without_walls();
    run_through(scene);
    ResumableRun other(doubly_periodic(13), folder_.path() / "other");
    EXPECT_THROW(read_checkpoint(path_, run_identity(scene), other.state), ReadError);
}

TEST_F(Checkpoint, WithParticlesThatAreNoPermutationIsRefused) {
    const Scene scene = without_walls();
    for (const std::uint32_t wrong : {1000000U, 5U}) {
        ResumableRun run(scene, folder_.path() / "run");
        run.go_to(1);
        run.particles.fluid.identity[3] = wrong;
        run.particles.fluid.identity[4] = wrong;
        write(run, path_, run_identity(scene));
        EXPECT_THROW(read_checkpoint(path_, run_identity(scene), run.state), ReadError);
    }
}

// A table of what was recorded, changed as a program that is not ours could; `sizes` empty takes it away.
void reshape(const std::filesystem::path& path, const char* table, const std::vector<hsize_t>& sizes) {
    const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    ASSERT_GE(H5Ldelete(file.get(), table, H5P_DEFAULT), 0);
    if (sizes.empty()) {
        return;
    }
    std::vector<hsize_t> most = sizes;
    most.front() = H5S_UNLIMITED;
    const auto rank = static_cast<int>(sizes.size());
    const Hdf5Handle space(H5Screate_simple(rank, sizes.data(), most.data()), H5Sclose);
    const Hdf5Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    ASSERT_GE(H5Pset_chunk(layout.get(), rank, sizes.data()), 0);
    const Hdf5Handle dataset(
        H5Dcreate2(file.get(), table, H5T_NATIVE_DOUBLE, space.get(), H5P_DEFAULT, layout.get(), H5P_DEFAULT),
        H5Dclose);
    ASSERT_GE(dataset.get(), 0);
}

TEST_F(Checkpoint, WhoseTablesDoNotFitIsRefused) {
    const Scene scene = without_walls();
    const auto expect_refusal = [&](const char* table, const std::vector<hsize_t>& sizes,
                                    long resumed_until) {
        SCOPED_TRACE(table);
        run_through(scene);
        reshape(path_, table, sizes);
        ResumableRun resumed(scene, folder_.path() / "resumed");
        try {
            read_checkpoint(path_, run_identity(scene), resumed.state);
            EXPECT_EQ(resumed.step, resumed_until - 1) << "taken, but not before its next sample";
            resumed.go_to(resumed_until);
            FAIL();
        } catch (const ReadError& error) {
            EXPECT_NE(std::string(error.what()).find(path_.string() + ": "), std::string::npos);
            EXPECT_NE(std::string(error.what()).find("/series/"), std::string::npos) << error.what();
        }
    };
    expect_refusal("/result/series/kinetic_energy", {3}, 0);
    expect_refusal("/result/series/time", {}, 0);
    expect_refusal("/result/series/kinetic_energy", {middle, 2}, middle + 1);
    expect_refusal("/result/series/kinetic_energy", {}, middle + 1);
}

} // namespace
} // namespace slurry::testing
