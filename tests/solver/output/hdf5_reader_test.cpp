#include "solver/output/hdf5_reader.hpp"

#include "solver/output/hdf5_writer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <utility>

namespace slurry {
namespace {

class Stored : public ::testing::Test {
  protected:
    void SetUp() override {
        std::ofstream(path_).close(); // the writer empties a file that is there
        Hdf5Writer writer(path_);
        writer.write("/list", "m", std::vector<double>{1, 2, 3});
        writer.append("/table", "m", std::vector<double>{1, 2});
        writer.append("/table", "m", std::vector<double>{3, 4});
        writer.set_attribute("/list", "number", 0.25);
        writer.set_attribute("/list", "words", std::string(100'000, 'x') + " µm");
        writer.close();
    }
    void TearDown() override { std::filesystem::remove(path_); }

    std::filesystem::path path_ = std::filesystem::path(::testing::TempDir()) / "hdf5_reader_test.h5";
};

TEST_F(Stored, ComesBackAsItWasWritten) {
    const Hdf5Reader reader(path_);
    EXPECT_EQ(reader.table("/list").values, (std::vector<double>{1, 2, 3}));
    const StoredTable table = reader.table("/table");
    EXPECT_EQ(table.rows, 2U);
    EXPECT_EQ(table.column(1), (std::vector<double>{2, 4}));
    EXPECT_EQ(reader.number("/list", "number"), 0.25);
    EXPECT_EQ(reader.text("/list", "words"), std::string(100'000, 'x') + " µm");
    EXPECT_TRUE(reader.has("/table"));
    EXPECT_FALSE(reader.has("/discs"));
}

TEST_F(Stored, WhatIsMissingIsNamed) {
    const Hdf5Reader reader(path_);
    EXPECT_THROW(static_cast<void>(reader.table("/series").values), ReadError);
    EXPECT_THROW(static_cast<void>(reader.number("/list", "steps")), ReadError);
    EXPECT_THROW(static_cast<void>(reader.text("/list", "number")), ReadError);
    EXPECT_THROW(Hdf5Reader("/nowhere/result.h5"), ReadError);
}

// What our writer never makes, and what would write beyond a value or take any amount of memory.
TEST_F(Stored, WhatIsLargerThanItShouldBeIsRefused) {
    {
        const Hdf5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
        const auto space = [](hsize_t size) {
            return Hdf5Handle(H5Screate_simple(1, &size, nullptr), H5Sclose);
        };
        const Hdf5Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
        H5Tset_size(text.get(), H5T_VARIABLE);
        const std::array<std::pair<const char*, hid_t>, 2> attributes{
            {{"numbers", H5T_NATIVE_DOUBLE}, {"texts", text.get()}}};
        for (const auto& [name, type] : attributes) {
            const Hdf5Handle attribute(H5Acreate_by_name(file.get(), "/list", name, type, space(1000).get(),
                                                         H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                                       H5Aclose);
            ASSERT_GE(attribute.get(), 0);
        }
        const Hdf5Handle huge(H5Dcreate2(file.get(), "/huge", H5T_NATIVE_DOUBLE, space(1ULL << 50U).get(),
                                         H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                              H5Dclose);
        ASSERT_GE(huge.get(), 0);
    }
    const Hdf5Reader reader(path_);
    EXPECT_THROW(static_cast<void>(reader.number("/list", "numbers")), ReadError);
    EXPECT_THROW(static_cast<void>(reader.text("/list", "texts")), ReadError);
    EXPECT_THROW(static_cast<void>(reader.table("/huge").values), ReadError);
}

} // namespace
} // namespace slurry
