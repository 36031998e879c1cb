#include "solver/output/hdf5_reader.hpp"

#include "solver/output/hdf5_writer.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

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

} // namespace
} // namespace slurry
