#pragma once
// An error band from the values of one quantity at several spacings: Richardson extrapolation by least
// squares, after the grid convergence index [roache1994] and its variant for scattered data [eca2014].
#include <cstdint>
#include <span>

namespace slurry {

inline constexpr double safety = 1.25;       // of an error whose order was observed [roache1994]
inline constexpr double standard_errors = 2; // in a band: 95 % of normal noise

struct GridValue {
    double spacing; // m
    double value;   // in the quantity's unit
    double noise;   // standard error of the value, in the same unit
};

enum class Verdict : std::uint8_t {
    converging, // follows value + coefficient spacing^order
    settled,    // all differences are within the noise: nothing is left to converge
    scattered,  // differences are more than noise, without an order
    diverging   // differences grow as the spacing falls: there is no band
};

struct Estimate {
    Verdict verdict;
    double order;        // observed; NaN unless converging
    double order_used;   // of the extrapolation: at most 2, the scheme's own; NaN unless converging
    double extrapolated; // to spacing 0, in the quantity's unit; NaN unless converging
    double error;        // the part of the band that falls with spacing^order_used; 0 unless converging
    double floor;        // the rest of the band, which no smaller spacing is known to lower
    // Half of the band about the value at the finest spacing; NaN when diverging.
    [[nodiscard]] double band() const { return error + floor; }
};

// Of three or more values from the coarsest spacing to the finest. Throws std::invalid_argument for fewer,
// for spacings that do not fall, and for values that are not finite.
[[nodiscard]] Estimate estimate_error(std::span<const GridValue> values);

} // namespace slurry
