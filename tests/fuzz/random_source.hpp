#pragma once
// Random numbers for generated tests: the same from the same seed on every machine.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>

namespace slurry::fuzz {

class RandomSource {
  public:
    explicit RandomSource(std::uint64_t seed) : engine_(seed) {}

    // Below `count`, which is not 0.
    [[nodiscard]] std::size_t below(std::size_t count) { return engine_() % count; }
    [[nodiscard]] double uniform(double lower, double upper) {
        return lower + (upper - lower) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
    }
    [[nodiscard]] double logarithmic(double lower, double upper) {
        return std::exp(uniform(std::log(lower), std::log(upper)));
    }
    [[nodiscard]] bool chance(double probability) { return uniform(0, 1) < probability; }
    template <class T> [[nodiscard]] const T& pick(std::span<const T> from) {
        return from[below(from.size())];
    }

  private:
    std::mt19937_64 engine_;
};

} // namespace slurry::fuzz
