#pragma once
// When a quantity has become steady, and what it then is, from its samples over time.
#include <span>

namespace slurry {

struct Reading {
    double value; // in the quantity's unit
    double noise; // standard error of the value, in the same unit
};

// The time (s) from which on the samples are steady: where leaving out what came before makes the standard
// error of the mean of what is left the smallest (marginal standard error rule, white1997). NaN when that
// leaves less than a quarter of the time or fewer than 8 samples, as it does of a trend.
[[nodiscard]] double steady_from(std::span<const double> time, std::span<const double> value);

// Mean of the samples from a time on; its noise from the means of four equal parts, which neighbouring
// samples that belong together do not make too small.
[[nodiscard]] Reading mean_from(std::span<const double> time, std::span<const double> value, double from);

// The last sample; its noise is the scatter of the last samples about their parabola.
[[nodiscard]] Reading final_value(std::span<const double> time, std::span<const double> value);

} // namespace slurry
