// Any scene that is accepted runs; any other is refused with a reason. SLURRY_FLOWS=1000 tries more of them,
// SLURRY_FLOWS_SEED others, and SLURRY_FLOWS_ALLOWED=1 any numbers that [numerics] and [start] allow.
#include "solver/discs/motion.hpp"
#include "solver/discs/placement.hpp"
#include "solver/geometry/geometry_error.hpp"
#include "solver/loop/interactions.hpp"
#include "solver/particles/arrangement.hpp"
#include "solver/particles/run_error.hpp"
#include "solver/scene/read_scene.hpp"
#include "solver/time/simulation.hpp"
#include "solver/time/time_step.hpp"
#include "tests/fuzz/scene_generator.hpp"

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <optional>
#include <unistd.h>

namespace slurry::fuzz {
namespace {

constexpr int steps = 100;

int setting(const char* name, int fallback) {
    const char* text = std::getenv(name);
    return text == nullptr ? fallback : std::atoi(text);
}

std::filesystem::path output_folder() {
    return std::filesystem::temp_directory_path() / ("slurry_flows_" + std::to_string(getpid()));
}

// What `slurry check` does; empty when it refuses, and then with a reason.
std::optional<Scene> accepted(const std::string& text) {
    try {
        std::vector<std::string> overrides;
        if (!is_built(KernelShape::fitted_quintic)) {
            overrides.emplace_back("numerics.kernel=quintic");
        }
        Scene scene = parse_scene(text, "flow.toml", overrides);
        const Region region(scene);
        const std::vector<Disc> discs = make_discs(place_discs(scene, region), scene.fluid);
        static_cast<void>(fluid_points(scene, region, discs));
        scene.output.end_time = steps * largest_time_step(scene, discs, 0);
        return scene;
    } catch (const SceneError& error) {
        EXPECT_NE(std::string(error.what()).find(": found "), std::string::npos) << error.what();
    } catch (const GeometryError& error) {
        EXPECT_GT(std::string(error.what()).size(), 20U) << error.what();
    }
    return std::nullopt;
}

// Vortices five times as fast as sound: a run that goes wrong is seen.
TEST(RandomFlows, OneThatBreaksIsSeen) {
    const std::string text = R"([domain]
lower = [0, 0]
upper = [0.16, 0.16]
periodic = "xy"
[fluid]
density = 1000
dynamic_viscosity = 0.01
[numerics]
particle_spacing = 0.01
sound_speed = 0.1
[start]
velocity = "taylor_green"
speed = 0.5
[output]
end_time = 1
)";
    std::optional<Scene> scene = accepted(text);
    ASSERT_TRUE(scene);
    EXPECT_THROW(run_scene(*scene, {output_folder(), 1, true, true}), RunError);
    std::filesystem::remove_all(output_folder());
}

TEST(RandomFlows, RunOrAreRefusedWithAReason) {
    const int wanted = setting("SLURRY_FLOWS", 24);
    const int seed = setting("SLURRY_FLOWS_SEED", 1);
    const auto numerics =
        setting("SLURRY_FLOWS_ALLOWED", 0) != 0 ? NumericsRange::allowed : NumericsRange::recommended;
    int ran = 0;
    for (int k = 0; k < wanted; ++k) {
        RandomSource random(static_cast<std::uint64_t>(seed + k));
        const std::string text = random_flow(random, numerics);
        SCOPED_TRACE("seed " + std::to_string(seed + k) + "\n" + text);
        if (const std::optional<Scene> scene = accepted(text)) {
            EXPECT_NO_THROW(run_scene(*scene, {output_folder(), 1, true, true}));
            ++ran;
        }
    }
    std::filesystem::remove_all(output_folder());
    RecordProperty("ran", ran);
    EXPECT_GE(3 * ran, wanted) << "most were refused: the generator has to be mended";
}

} // namespace
} // namespace slurry::fuzz
