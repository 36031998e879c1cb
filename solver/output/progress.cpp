#include "solver/output/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <utility>

namespace slurry {
namespace {

constexpr double bar_interval = 0.2; // s
constexpr double line_interval = 10; // s
constexpr int bar_width = 20;        // characters; the whole line fits in 80

std::string duration(double seconds) {
    const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
    if (whole < 60)
        return fmt::format("{} s", whole);
    if (whole < 3600)
        return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

} // namespace

ProgressStyle progress_style(bool quiet, int file_descriptor) {
    if (quiet)
        return ProgressStyle::quiet;
    return ::isatty(file_descriptor) == 1 ? ProgressStyle::bar : ProgressStyle::lines;
}

Progress::Progress(std::ostream& stream, ProgressStyle style, double end_time, double start_time,
                   SecondsSource now)
    : stream_(stream), style_(style), end_time_(end_time), start_time_(start_time), now_(std::move(now)),
      start_(now_()), last_report_(start_) {}

Progress::~Progress() {
    if (bar_drawn_)
        stream_ << std::endl;
}

void Progress::update(double time, std::int64_t steps) {
    if (style_ == ProgressStyle::quiet)
        return;
    const bool done = time >= end_time_;
    const double now = now_();
    const bool bar = style_ == ProgressStyle::bar;
    if (now - last_report_ < (bar ? bar_interval : line_interval) && !(bar && done))
        return;
    last_report_ = now;
    const double share = std::clamp(time / end_time_, 0.0, 1.0);
    const double elapsed = now - start_;
    const double since_start = (time - start_time_) / end_time_;
    const std::string remaining =
        since_start > 0 ? duration(elapsed * (1 - share) / since_start) + " left" : "just begun";
    const std::string state =
        fmt::format("{:5.1f} %, t = {:.3g} s, step {}, {}", 100 * share, time, steps, remaining);
    if (bar) {
        const auto filled = static_cast<std::size_t>(share * bar_width);
        // "\x1b[K" clears what a longer line left behind.
        stream_ << fmt::format("\r[{:<{}}]{}\x1b[K", std::string(filled, '='), bar_width, state)
                << std::flush;
        bar_drawn_ = true;
    } else {
        stream_ << state << std::endl;
    }
}

} // namespace slurry
