#pragma once
// Where the wall time of a run goes.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace slurry {

using SecondsSource = std::function<double()>;
// Seconds of a clock that never steps back, from an arbitrary origin.
double steady_seconds();

// Accumulates wall time per named phase. Phases nest: while an inner one runs the outer one stands still, so
// the shares never add up to more than one. For one thread; two clock readings per scope.
class PhaseClock {
  public:
    struct Phase {
        std::string name;
        double seconds;
    };

    explicit PhaseClock(SecondsSource now = steady_seconds);

    // Charges the time of its own life to the phase.
    class Scope {
      public:
        Scope(PhaseClock& clock, std::string_view phase);
        ~Scope();
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

      private:
        PhaseClock& clock_;
        std::size_t outer_;
    };

    // In the order of first use.
    [[nodiscard]] const std::vector<Phase>& phases() const { return phases_; }
    // Adds what an earlier part of the run took: its phases, and elapsed() as a whole, s.
    void add(const std::vector<Phase>& phases, double elapsed);
    // Since construction, s.
    [[nodiscard]] double elapsed() const { return now_() - start_; }
    // The closing lines of a run: particle-steps per second and each phase's share of elapsed().
    [[nodiscard]] std::string summary(std::int64_t particles, std::int64_t steps) const;

  private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    std::size_t find(std::string_view phase);
    void switch_to(std::size_t phase);

    SecondsSource now_;
    double start_;
    double last_switch_;
    std::size_t current_ = none;
    std::vector<Phase> phases_;
};

} // namespace slurry
