#pragma once
// A folder of its own for each test, and a valid scene with a wall of every shape, discs of every placement
// and a probe of every kind.
#include "solver/scene/read_scene.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace slurry::test {

// Tables stand in the order of the choices of `shape`, `placement` and `kind`, and are named after them.
inline const std::string full_scene = R"([domain]
lower = [0, 0]
upper = [4, 4]

[fluid]
density = 1000
dynamic_viscosity = 1e-3

[numerics]
particle_spacing = 0.1
sound_speed = 10

[start]
velocity = "shear"
speed = 1

[[walls]]
name = "line"
shape = "line"
fluid_side = "below"
from = [0, 4]
to = [4, 4]

[[walls]]
name = "cosine"
shape = "cosine"
fluid_side = "above"
mean_height = 0.5
amplitude = -0.1
wavelength = 4

[[walls]]
name = "gaussian"
shape = "gaussian"
fluid_side = "above"
base_height = 0
amplitude = 1
centre = 2
width = 0.5

[[walls]]
name = "arc"
shape = "arc"
fluid_side = "below"
base_height = 4
centre = 2
radius = 1
angle = 2
upward = true

[[walls]]
name = "sine"
shape = "sine"
fluid_side = "above"
base_height = 0
amplitude = 0.2
centre = 2
length = 1

[[walls]]
name = "profile"
shape = "profile"
fluid_side = "above"
file = "profile.csv"

[[probes]]
name = "wall"
kind = "wall"
wall = "cosine"

[[probes]]
name = "point"
kind = "point"
position = [0.5, 0.75]

[[probes]]
name = "grid"
kind = "grid"
points = [3, 4]

[output]
end_time = 1

[[discs]]
name = "single"
placement = "single"
density = 1500
radius = 0.4
position = [1, 2]

[[discs]]
name = "random"
placement = "random"
density = 2000
count = 3
radius = 0.4

[[walls]]
name = "random"
shape = "random"
fluid_side = "above"
mean_height = 0.5
rms_height = 0.1
correlation_length = 0.5
)";

// The text with the first occurrence of a part replaced; the part has to be there.
inline std::string replaced(std::string text, const std::string& part, const std::string& by) {
    const std::size_t position = text.find(part);
    if (position == std::string::npos) {
        throw std::logic_error("not in the text: " + part);
    }
    return text.replace(position, part.size(), by);
}

class SceneFolder : public ::testing::Test {
  protected:
    SceneFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "slurry-scene-XXXXXX").string();
        folder_ = mkdtemp(pattern.data());
        write("profile.csv", "# measured\n0, 0.1\n2, 0.2\n4, 0.1\n");
        write("radii.csv", "# measured\n0.4\n0.5\n");
    }
    ~SceneFolder() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    SceneFolder(const SceneFolder&) = delete;
    SceneFolder& operator=(const SceneFolder&) = delete;

    [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
    }

    [[nodiscard]] Scene read(const std::string& text, const std::vector<std::string>& overrides = {}) const {
        write("scene.toml", text);
        return read_scene(path("scene.toml"), overrides);
    }

    // What the scene is refused with, less the folder; a line that starts with ACCEPTED when it is not
    // refused.
    [[nodiscard]] std::string refusal(const std::string& text,
                                      const std::vector<std::string>& overrides = {}) const {
        try {
            return "ACCEPTED as\n" + read(text, overrides).resolved_text;
        } catch (const SceneError& error) {
            std::string message = error.what();
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
            const std::string prefix = folder_.string() + "/";
            for (auto at = message.find(prefix); at != std::string::npos; at = message.find(prefix)) {
                message.erase(at, prefix.size());
            }
            return message;
        }
    }

  private:
    std::filesystem::path folder_;
};

} // namespace slurry::test
