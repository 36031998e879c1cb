// Scenes of verification/, as a user would run them, for some steps on two threads: what the sanitizers look
// at.
#include "solver/loop/interactions.hpp"
#include "solver/scene/read_scene.hpp"
#include "solver/time/simulation.hpp"

#include <filesystem>
#include <gtest/gtest.h>
#include <omp.h>
#include <unistd.h>

namespace slurry::testing {
namespace {

void run_shortly(const std::string& scene, std::vector<std::string> overrides) {
    if (!is_built(KernelShape::fitted_quintic)) {
        overrides.emplace_back("numerics.kernel=quintic");
    }
    const auto folder = std::filesystem::temp_directory_path() / ("slurry_short_" + std::to_string(getpid()));
    const int threads_before = omp_get_max_threads();
    const RunSummary summary =
        run_scene(read_scene("verification/" + scene + "/scene.toml", overrides), {folder, 2, true, true});
    omp_set_num_threads(threads_before);
    EXPECT_GT(summary.steps, 5);
    EXPECT_TRUE(std::filesystem::exists(summary.result));
    std::filesystem::remove_all(folder);
}

TEST(ShortScenes, RoughChannel) {
    run_shortly("rough_channel",
                {"numerics.particle_spacing=5e-7", "output.end_time=4e-7", "output.snapshot_times=[]"});
}

TEST(ShortScenes, DiscPair) {
    run_shortly("disc_pair", {"numerics.particle_spacing=4e-4", "contact.distance=4e-4",
                              "output.end_time=2e-3", "output.snapshot_times=[]"});
}

} // namespace
} // namespace slurry::testing
