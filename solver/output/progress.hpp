#pragma once
// How far a run has come and how long it will still take.
#include "solver/output/phase_clock.hpp"

#include <cstdint>
#include <iosfwd>

namespace slurry {

enum class ProgressStyle : std::uint8_t {
    quiet,
    bar,  // one line, redrawn: a terminal
    lines // at most one line in 10 s: a log
};

// Quiet when asked for, else what suits the open file (1 = standard output).
ProgressStyle progress_style(bool quiet, int file_descriptor);

class Progress {
  public:
    // Simulated time at the end of the run and now, s. The stream must outlive this.
    Progress(std::ostream& stream, ProgressStyle style, double end_time, double start_time = 0,
             SecondsSource now = steady_seconds);
    // Ends the line of a bar, so that what follows begins on its own.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // To be called after every step: writes only when it is time to. `time`: simulated so far, s.
    void update(double time, std::int64_t steps);

  private:
    std::ostream& stream_;
    ProgressStyle style_;
    double end_time_, start_time_;
    SecondsSource now_;
    double start_;
    double last_report_;
    bool bar_drawn_ = false;
};

} // namespace slurry
