#include "solver/output/progress.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <sstream>

namespace slurry {
namespace {

// A run of 1000 steps that takes `seconds` of wall time.
std::string report(ProgressStyle style, double seconds) {
    std::ostringstream stream;
    double now = 0;
    {
        Progress progress(stream, style, 2e-3, 0, [&] { return now; });
        for (int step = 1; step <= 1000; ++step) {
            now = seconds * step / 1000;
            progress.update(2e-3 * step / 1000, step);
        }
    }
    return stream.str();
}

TEST(Progress, QuietWritesNothing) {
    EXPECT_EQ(report(ProgressStyle::quiet, 1000), "");
}

TEST(Progress, LogGetsAtMostOneLineInTenSeconds) {
    EXPECT_EQ(report(ProgressStyle::lines, 9.9), "");
    const std::string text = report(ProgressStyle::lines, 100);
    EXPECT_EQ(std::ranges::count(text, '\n'), 10);
    EXPECT_EQ(text.find('\r'), std::string::npos);
    EXPECT_TRUE(text.starts_with(" 10.0 %, t = 0.0002 s, step 100, 1 min 30 s left\n")) << text;
}

TEST(Progress, BarIsRedrawnInPlaceAndEndsFull) {
    const std::string text = report(ProgressStyle::bar, 10);
    EXPECT_EQ(std::ranges::count(text, '\n'), 1);
    EXPECT_TRUE(text.ends_with("\n"));
    EXPECT_LE(std::ranges::count(text, '\r'), 51); // one in 0.2 s
    EXPECT_NE(text.find("[==========          ] 51.5 %, t = 0.00103 s, step 515, 5 s left"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("[====================]100.0 %, t = 0.002 s, step 1000, 0 s left"), std::string::npos)
        << text;
}

TEST(Progress, LongTimesReadInHours) {
    EXPECT_NE(report(ProgressStyle::lines, 10 * 3600).find("5 h 00 min left"), std::string::npos);
}

TEST(Progress, AResumedRunIsEstimatedByItsOwnPart) {
    std::ostringstream stream;
    double now = 0;
    Progress progress(stream, ProgressStyle::lines, 1, 0.5, [&] { return now; });
    now = 20;
    progress.update(0.75, 750);
    EXPECT_EQ(stream.str(), " 75.0 %, t = 0.75 s, step 750, 20 s left\n");
}

TEST(Progress, StyleSuitsTheOpenFile) {
    std::array<int, 2> pipe_ends{};
    ASSERT_EQ(::pipe(pipe_ends.data()), 0);
    EXPECT_EQ(progress_style(false, pipe_ends[1]), ProgressStyle::lines);
    EXPECT_EQ(progress_style(true, pipe_ends[1]), ProgressStyle::quiet);
    ::close(pipe_ends[0]);
    ::close(pipe_ends[1]);
}

} // namespace
} // namespace slurry
