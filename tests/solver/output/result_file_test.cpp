#include "solver/output/result_file.hpp"

#include "solver/output/hdf5_handle.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <numeric>
#include <vector>

namespace slurry {
namespace {

namespace fs = std::filesystem;

class ResultFileTest : public ::testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "slurry-XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder = name;
        scene.title = "test";
        scene.resolved_text = std::string(100000, '#'); // longer than a fixed-length attribute may be
        scene.probes = {{"wafer", WallProbe{"wafer", 3}}, {"spot", PointProbe{Vector::Zero()}}};
    }
    void TearDown() override { fs::remove_all(folder); }

    // A run's worth of output; `particles` sets its size.
    void write(std::size_t particles) const {
        ResultFile file(folder, scene, "1.2.3", true);
        std::vector<double> values(particles);
        std::iota(values.begin(), values.end(), 1.0);
        const std::vector<int> wall(particles, -1);
        file.add_probe_constant("wafer", "arc_length", "m", std::vector{0.0, 1.0, 2.0});
        for (int sample = 0; sample < 300; ++sample) {
            file.begin_sample(sample);
            file.add_sample("kinetic_energy", "J/m", 2.0 * sample);
            file.begin_probe_sample("spot", sample);
            file.add_probe_row("spot", "pressure", "Pa", std::vector{1.0 * sample});
        }
        for (const double time : {0.0, 1.5}) {
            file.begin_probe_sample("wafer", time);
            file.add_probe_row("wafer", "pressure", "Pa", std::vector<double>{time, NAN, 3.0});
            file.begin_snapshot(time, particles);
            for (const auto& [quantity, unit] :
                 std::vector<std::pair<const char*, const char*>>{{"position_x", "m"},
                                                                  {"position_y", "m"},
                                                                  {"velocity_x", "m/s"},
                                                                  {"velocity_y", "m/s"},
                                                                  {"density", "kg/m3"},
                                                                  {"pressure", "Pa"},
                                                                  {"volume", "m2"}}) {
                file.add_to_snapshot(quantity, unit, values);
            }
            file.add_to_snapshot("wall", "1", wall);
            file.end_snapshot();
        }
        file.set_attribute("steps", 41);
        file.set_attribute("steps", 42);
        EXPECT_EQ(file.finish(), folder / "result.h5");
    }

    [[nodiscard]] std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder))
            names.push_back(entry.path().filename().string());
        std::ranges::sort(names);
        return names;
    }

    // With 42 when a write beyond the limit ends as it should.
    [[noreturn]] void exit_with_file_limit(rlim_t limit) const {
        std::signal(SIGXFSZ, SIG_IGN); // so that the limit shows as EFBIG
        const rlimit limits{limit, limit};
        ::setrlimit(RLIMIT_FSIZE, &limits);
        int status = 1;
        try {
            write(2000);
        } catch (const OutputError& error) {
            const std::string_view what = error.what();
            const bool named = what.ends_with("File too large") && what.starts_with(folder.string());
            status = named && files().empty() ? 42 : 2;
        }
        fs::remove_all(folder);
        std::exit(status); // NOLINT(concurrency-mt-unsafe): runs the exit handlers, HDF5's among them
    }

    fs::path folder;
    Scene scene;
};

class Reader {
  public:
    explicit Reader(const fs::path& path)
        : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {}

    [[nodiscard]] std::vector<hsize_t> sizes(const char* path) const {
        const Hdf5Handle dataset(H5Dopen2(file_.get(), path, H5P_DEFAULT), H5Dclose);
        const Hdf5Handle space(H5Dget_space(dataset.get()), H5Sclose);
        std::vector<hsize_t> sizes(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.get())));
        H5Sget_simple_extent_dims(space.get(), sizes.data(), nullptr);
        return sizes;
    }
    [[nodiscard]] std::vector<double> values(const char* path) const {
        hsize_t count = 1;
        for (const hsize_t size : sizes(path))
            count *= size;
        std::vector<double> values(count);
        const Hdf5Handle dataset(H5Dopen2(file_.get(), path, H5P_DEFAULT), H5Dclose);
        H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        return values;
    }
    [[nodiscard]] std::string text(const char* object, const char* name) const {
        const Hdf5Handle attribute(H5Aopen_by_name(file_.get(), object, name, H5P_DEFAULT, H5P_DEFAULT),
                                   H5Aclose);
        const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose);
        char* characters = nullptr;
        if (H5Aread(attribute.get(), type.get(), &characters) < 0)
            return "";
        std::string text = characters;
        H5free_memory(characters);
        return text;
    }
    [[nodiscard]] double number(const char* object, const char* name) const {
        const Hdf5Handle attribute(H5Aopen_by_name(file_.get(), object, name, H5P_DEFAULT, H5P_DEFAULT),
                                   H5Aclose);
        double value = NAN;
        H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value);
        return value;
    }

  private:
    Hdf5Handle file_;
};

using Sizes = std::vector<hsize_t>;

TEST_F(ResultFileTest, HoldsWhatWasWritten) {
    write(5);
    EXPECT_EQ(files(), (std::vector<std::string>{"result.h5", "result.xdmf"}));
    const Reader reader(folder / "result.h5");
    EXPECT_EQ(reader.text("/", "version"), "1.2.3");
    EXPECT_EQ(reader.text("/", "scene"), scene.resolved_text);
    EXPECT_EQ(reader.number("/run", "steps"), 42);
    EXPECT_EQ(reader.number("/snapshots/0001", "time"), 1.5);
    EXPECT_EQ(reader.sizes("/series/kinetic_energy"), Sizes{300});
    EXPECT_EQ(reader.values("/series/kinetic_energy")[299], 598);
    EXPECT_EQ(reader.values("/series/time")[299], 299);
    EXPECT_EQ(reader.sizes("/probes/spot/pressure"), Sizes{300});
    EXPECT_EQ(reader.sizes("/probes/wafer/pressure"), (Sizes{2, 3}));
    EXPECT_EQ(reader.values("/probes/wafer/pressure")[3], 1.5);
    EXPECT_TRUE(std::isnan(reader.values("/probes/wafer/pressure")[4]));
    EXPECT_EQ(reader.values("/snapshots/0000/wall"), std::vector<double>(5, -1.0));
}

TEST_F(ResultFileTest, EveryDatasetHasItsUnit) {
    write(5);
    const Reader reader(folder / "result.h5");
    const std::vector<std::pair<const char*, const char*>> units{{"/series/time", "s"},
                                                                 {"/series/kinetic_energy", "J/m"},
                                                                 {"/probes/spot/time", "s"},
                                                                 {"/probes/wafer/pressure", "Pa"},
                                                                 {"/probes/wafer/arc_length", "m"},
                                                                 {"/snapshots/0000/position_x", "m"},
                                                                 {"/snapshots/0000/velocity_y", "m/s"},
                                                                 {"/snapshots/0000/density", "kg/m3"},
                                                                 {"/snapshots/0000/pressure", "Pa"},
                                                                 {"/snapshots/0000/volume", "m2"},
                                                                 {"/snapshots/0000/wall", "1"},
                                                                 {"/snapshots/0000/velocity", "m/s"}};
    for (const auto& [path, unit] : units)
        EXPECT_EQ(reader.text(path, "unit"), unit) << path;
}

TEST_F(ResultFileTest, VectorViewShowsBothComponents) {
    write(2);
    const Reader reader(folder / "result.h5");
    EXPECT_EQ(reader.sizes("/snapshots/0001/velocity"), (Sizes{2, 3}));
    EXPECT_EQ(reader.values("/snapshots/0001/velocity"), (std::vector<double>{1, 1, 0, 2, 2, 0}));
}

TEST_F(ResultFileTest, NothingStaysOfARunThatDoesNotFinish) {
    { const ResultFile file(folder, scene, "", true); }
    EXPECT_TRUE(files().empty());
}

TEST_F(ResultFileTest, OldResultStaysUntilTheNewOneIsWhole) {
    std::ofstream(folder / "result.h5") << "old";
    EXPECT_THROW(ResultFile(folder, scene, "", false), OutputError);
    { const ResultFile file(folder, scene, "", true); }
    EXPECT_EQ(files(), std::vector<std::string>{"result.h5"});
    EXPECT_EQ(fs::file_size(folder / "result.h5"), 3U);
    write(1);
    EXPECT_EQ(Reader(folder / "result.h5").number("/run", "steps"), 42);
}

TEST_F(ResultFileTest, TwoRunsCannotWriteTheSameFile) {
    const ResultFile first(folder, scene, "", true);
    EXPECT_THROW(ResultFile(folder, scene, "", true), OutputError);
    EXPECT_EQ(files(), std::vector<std::string>{"result.h5.partial"})
        << "the first run's file is still there";
}

TEST_F(ResultFileTest, UnwritableFolderIsNamedWithTheReason) {
    std::ofstream(folder / "file") << "x";
    try {
        const ResultFile file(folder / "file" / "out", scene, "", true);
        FAIL();
    } catch (const OutputError& error) {
        EXPECT_NE(std::string(error.what()).find("file/out"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("Not a directory"), std::string::npos) << error.what();
    }
}

TEST_F(ResultFileTest, QuantitiesNeedOneRowForEachTime) {
    ResultFile file(folder, scene, "", true);
    EXPECT_THROW(file.add_sample("kinetic_energy", "J/m", 1), std::logic_error);
    file.begin_probe_sample("wafer", 0);
    file.add_probe_row("wafer", "shear", "Pa", std::vector{1.0, 2.0});
    EXPECT_THROW(file.add_probe_row("wafer", "shear", "Pa", std::vector{1.0, 2.0}), std::logic_error);
    file.begin_probe_sample("wafer", 1);
    EXPECT_THROW(file.add_probe_row("wafer", "shear", "Pa", std::vector{1.0}), std::logic_error);
}

// Wherever the file hits the limit (superblock, chunks, metadata at closing, the XDMF file), the run has to
// end in an OutputError, leave nothing behind, and exit without a crash in HDF5: see ~Hdf5Writer. In a
// process that starts afresh: a fork lacks the threads of earlier tests, for which clang's OpenMP would wait
// at its exit.
TEST_F(ResultFileTest, FullDiskLeavesNothingBehind) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    write(2000);
    const auto size = static_cast<rlim_t>(fs::file_size(folder / "result.h5"));
    fs::remove(folder / "result.h5");
    fs::remove(folder / "result.xdmf");
    for (rlim_t limit = 0; limit < size; limit += size / 60) {
        EXPECT_EXIT(exit_with_file_limit(limit), ::testing::ExitedWithCode(42), "") << "at limit " << limit;
    }
}

} // namespace
} // namespace slurry
