// A whole run of a tiny scene.
#include "solver/time/simulation.hpp"

#include "solver/scene/read_scene.hpp"
#include "solver/time/time_step.hpp"
#include "solver/time/watchdog.hpp"
#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <omp.h>
#include <unistd.h>

namespace slurry::testing {
namespace {

// A folder of this test's own that goes when the test ends.
class TemporaryFolder {
  public:
    TemporaryFolder()
        : path_(std::filesystem::temp_directory_path() /
                ("slurry_simulation_" + std::to_string(getpid()) + "_" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {}
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

std::vector<double> read_dataset(const std::filesystem::path& path, const std::string& name) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
    const hid_t space = H5Dget_space(dataset);
    std::vector<double> values(
        static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space))));
    EXPECT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    H5Sclose(space);
    H5Dclose(dataset);
    H5Fclose(file);
    return values;
}

double read_attribute(const std::filesystem::path& path, const std::string& name) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t attribute = H5Aopen_by_name(file, "/run", name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    double value = std::nan("");
    EXPECT_GE(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), 0) << name;
    H5Aclose(attribute);
    H5Fclose(file);
    return value;
}

Scene tiny_scene() {
    Scene scene = flat_channel(12, 1);
    jitter(scene, 0.2);
    scene.numerics.density_diffusion = 0.1;
    scene.output.end_time = 0.1;
    scene.output.series_samples = 5;
    scene.output.probe_samples = 2;
    scene.output.snapshot_times = {0.05};
    scene.probes = {
        {"lid", WallProbe{"lid", 7}}, {"middle", PointProbe{{0.2, 0.7}}}, {"grid", GridProbe{{3, 4}}}};
    return scene;
}

class Simulation : public ::testing::Test {
  protected:
    void TearDown() override { omp_set_num_threads(threads_before_); }
    std::filesystem::path run(const Scene& scene, const std::string& name, int threads) {
        return run_scene(scene, {folder_.path() / name, threads, true, true}).result;
    }
    TemporaryFolder folder_;

  private:
    int threads_before_ = omp_get_max_threads();
};

const std::vector<std::string> datasets{"/series/time",
                                        "/series/kinetic_energy",
                                        "/series/momentum_x",
                                        "/probes/lid/pressure",
                                        "/probes/lid/shear",
                                        "/probes/middle/pressure",
                                        "/probes/grid/velocity_x",
                                        "/snapshots/0001/position_x",
                                        "/snapshots/0001/position_y",
                                        "/snapshots/0001/velocity_x",
                                        "/snapshots/0001/density",
                                        "/snapshots/0001/pressure"};

TEST_F(Simulation, GivesTheSameBitsForOneAndTwoThreads) {
    const Scene scene = tiny_scene();
    const auto one = run(scene, "one", 1);
    const auto two = run(scene, "two", 2);
    for (const std::string& name : datasets) {
        const auto values = read_dataset(one, name);
        EXPECT_FALSE(values.empty()) << name;
        EXPECT_TRUE(std::isfinite(largest(values))) << name;
        EXPECT_EQ(values, read_dataset(two, name)) << name;
    }
}

TEST_F(Simulation, EndsExactlyAtTheEndTimeWithStepsWithinTheLimit) {
    const Scene scene = tiny_scene();
    const auto result = run(scene, "run", 1);
    EXPECT_TRUE(std::filesystem::exists(result.parent_path() / "result.xdmf"));
    EXPECT_NEAR(read_attribute(result, "end_time"), 0.1, 1e-14);
    EXPECT_LE(read_attribute(result, "time_step"), largest_time_step(scene) * (1 + 1e-12));
    EXPECT_NEAR(read_attribute(result, "time_step") * read_attribute(result, "steps"), 0.1, 1e-15);
    EXPECT_EQ(read_attribute(result, "fluid_particles"), 144);
    EXPECT_EQ(read_attribute(result, "dummy_particles"), 72);
    const auto times = read_dataset(result, "/series/time");
    ASSERT_EQ(times.size(), 5U);
    EXPECT_EQ(times.front(), 0);
    EXPECT_NEAR(times.back(), 0.1, 1e-14);
}

TEST_F(Simulation, LidDragsTheFluidAlong) {
    const auto momentum = read_dataset(run(tiny_scene(), "run", 1), "/series/momentum_x");
    for (std::size_t k = 1; k < momentum.size(); ++k) {
        EXPECT_GT(momentum[k], momentum[k - 1]);
    }
}

TEST_F(Simulation, RunThatGoesWrongLeavesNoResult) {
    Scene scene = tiny_scene();
    scene.start.velocity = InitialVelocity::shear;
    scene.start.speed = 300; // 30 times the speed of sound
    EXPECT_THROW(run(scene, "run", 1), RunError);
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "run" / "result.h5"));
}

TEST_F(Simulation, OfTooManyStepsLeavesNoFolder) {
    Scene scene = tiny_scene();
    scene.output.end_time = 1e9;
    EXPECT_THROW(run(scene, "run", 1), SceneError);
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "run"));
}

TEST(DescribeScene, SaysWhatLimitsTheTimeStep) {
    const auto limit = [](Scene scene) {
        const std::string text = describe_scene(scene);
        const std::size_t begin = text.find("limited by        ") + 18;
        return text.substr(begin, text.find(':', begin) - begin);
    };
    Scene scene = tiny_scene();
    EXPECT_EQ(limit(scene), "sound");
    scene.fluid.dynamic_viscosity = 1e4;
    EXPECT_EQ(limit(scene), "viscosity");
    scene = tiny_scene();
    scene.fluid.body_force = {1e6, 0};
    EXPECT_EQ(limit(scene), "the force on the fluid");
    scene = doubly_periodic(24);
    scene.output.end_time = 0.1;
    scene.fluid.dynamic_viscosity = 10;
    scene.discs = {middle_disc(1)};
    EXPECT_EQ(limit(scene), "a light or small disc");
    scene.fluid.dynamic_viscosity = 0;
    EXPECT_EQ(limit(scene), "a light disc");
    scene.discs = {middle_disc()};
    scene.contact.force_scale = 1e9;
    EXPECT_EQ(limit(scene), "the stiffest contact");
}

TEST(DescribeScene, CountsParticlesAndSaysWhichTermsRun) {
    const std::string text = describe_scene(tiny_scene());
    for (const char* part :
         {"fluid particles   144", "dummy particles   72", "on   viscous force", "off  hydrostatic"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << " is not in:\n" << text;
    }
}

} // namespace
} // namespace slurry::testing
