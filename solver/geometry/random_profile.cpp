#include "solver/geometry/random_profile.hpp"

#include <cmath>
#include <numbers>

namespace slurry {
namespace {

constexpr double last_power = 36; // harmonics weaker than exp(-36) of the first are beyond double precision

class SplitMix64 {
  public:
    explicit SplitMix64(std::uint64_t seed) : state_(seed) {}

    // In [0, 1), of 53 bits.
    double uniform() {
        state_ += 0x9E3779B97F4A7C15U;
        std::uint64_t mixed = (state_ ^ (state_ >> 30U)) * 0xBF58476D1CE4E5B9U;
        mixed = (mixed ^ (mixed >> 27U)) * 0x94D049BB133111EBU;
        mixed ^= mixed >> 31U;
        return std::ldexp(static_cast<double>(mixed >> 11U), -53);
    }

  private:
    std::uint64_t state_;
};

} // namespace

std::vector<Harmonic> harmonics(const RandomShape& shape, double period) {
    const double first = 2 * std::numbers::pi / period;
    const double power = std::pow(first * shape.correlation_length / 2, 2);
    const int last = std::max(1, static_cast<int>(std::sqrt(last_power / power)));
    SplitMix64 random(shape.seed);
    std::vector<Harmonic> result;
    double variance = 0;
    for (int n = 1; n <= last; ++n) {
        const double weight = std::exp(-power * (n * n - 1)); // of the variance, over the first one's
        variance += weight / 2;
        result.push_back({n * first, std::sqrt(weight), 2 * std::numbers::pi * random.uniform()});
    }
    for (Harmonic& harmonic : result)
        harmonic.amplitude *= shape.rms_height / std::sqrt(variance);
    return result;
}

} // namespace slurry
