// Sizes are bounded before anything is allocated, and whoever runs a scene can allow more.
#include "solver/scene/limits.hpp"

#include "solver/time/simulation.hpp"
#include "tests/solver/scene/scene_folder.hpp"

#include <fmt/format.h>

namespace slurry::test {
namespace {

class SizeLimits : public SceneFolder {
  protected:
    [[nodiscard]] std::string refused(const std::vector<std::string>& overrides,
                                      const std::string& limit = "") {
        Limits limits;
        if (!limit.empty()) {
            set_limit(limits, limit);
        }
        write("scene.toml", full_scene);
        try {
            return "ACCEPTED " + read_scene(path("scene.toml"), overrides, limits).title;
        } catch (const SceneError& error) {
            return error.what();
        }
    }
};

struct Excess {
    std::vector<std::string> overrides;
    std::string name;
};

TEST_F(SizeLimits, AreSaidWithTheOptionThatLiftsThem) {
    for (const Excess& excess :
         {Excess{{"numerics.particle_spacing=5e-4"}, "particles"},
          Excess{{"discs.random.count=1000000"}, "discs"},
          Excess{{"probes.grid.points=[9999, 9999]"}, "probe_values"},
          Excess{{"output.series_samples=1000000", "discs.random.count=1000"}, "series_values"},
          Excess{{"numerics.particle_spacing=1e-3", "output.snapshot_times=[0, 0.1, 0.2, 0.3]"},
                 "snapshot_particles=6e7"}}) {
        const bool lowered = excess.name.find('=') != std::string::npos;
        const std::string message = refused(excess.overrides, lowered ? excess.name : "");
        const std::size_t option = message.find("--limit ");
        ASSERT_NE(option, std::string::npos) << message;
        const std::string advised = message.substr(option + 8, message.find(' ', option + 8) - option - 8);
        const std::string name = excess.name.substr(0, excess.name.find('='));
        EXPECT_TRUE(advised.starts_with(name + "=")) << message;
        EXPECT_EQ(refused(excess.overrides, advised).find("--limit " + name + "="), std::string::npos)
            << advised;
    }
}

TEST_F(SizeLimits, HoldForTheStepsOfARun) {
    const std::vector<std::string> forever{"output.end_time=1e300"};
    Scene scene = read_scene("verification/couette/scene.toml", forever);
    for (const double limit : {1e9, 1e15}) {
        scene.limits.steps = limit;
        try {
            static_cast<void>(describe_scene(scene));
            ADD_FAILURE() << "accepted";
        } catch (const SceneError& error) {
            EXPECT_NE(
                std::string(error.what()).find(fmt::format("allowed at most {:.4g}; --limit steps=", limit)),
                std::string::npos)
                << error.what();
        }
    }
}

TEST_F(SizeLimits, ThatAreNoneAreRefused) {
    Limits limits;
    for (const char* text :
         {"", "=", "particles", "particles=", "particles=0", "particles=-1", "particles=nan", "particles=inf",
          "particles=1x", "particle=1", "particles =1"}) {
        EXPECT_THROW(set_limit(limits, text), SceneError) << text;
    }
    set_limit(limits, "particles=3e7");
    EXPECT_EQ(limits.particles, 3e7);
}

} // namespace
} // namespace slurry::test
