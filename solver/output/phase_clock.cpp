#include "solver/output/phase_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace slurry {

double steady_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

PhaseClock::PhaseClock(SecondsSource now) : now_(std::move(now)), start_(now_()), last_switch_(start_) {}

PhaseClock::Scope::Scope(PhaseClock& clock, std::string_view phase) : clock_(clock), outer_(clock.current_) {
    clock_.switch_to(clock_.find(phase));
}

PhaseClock::Scope::~Scope() {
    clock_.switch_to(outer_);
}

std::size_t PhaseClock::find(std::string_view phase) {
    const auto found = std::ranges::find(phases_, phase, &Phase::name);
    const auto index = static_cast<std::size_t>(std::distance(phases_.begin(), found));
    if (found == phases_.end())
        phases_.push_back({std::string(phase), 0.0});
    return index;
}

void PhaseClock::switch_to(std::size_t phase) {
    const double now = now_();
    if (current_ != none)
        phases_[current_].seconds += now - last_switch_;
    last_switch_ = now;
    current_ = phase;
}

void PhaseClock::add(const std::vector<Phase>& phases, double elapsed) {
    for (const auto& [name, seconds] : phases)
        phases_[find(name)].seconds += seconds;
    start_ -= elapsed;
}

std::string PhaseClock::summary(std::int64_t particles, std::int64_t steps) const {
    const double seconds = elapsed();
    const double particle_steps = static_cast<double>(particles) * static_cast<double>(steps);
    std::string text = fmt::format("{} particles, {} steps in {:.3g} s: {:.3g} particle-steps per second\n",
                                   particles, steps, seconds, seconds > 0 ? particle_steps / seconds : 0.0);
    std::vector<Phase> shares = phases_;
    std::ranges::stable_sort(shares, std::ranges::greater{}, &Phase::seconds);
    double rest = seconds;
    for (const Phase& phase : shares)
        rest -= phase.seconds;
    shares.push_back({"other", std::max(rest, 0.0)});
    for (const auto& [name, spent] : shares)
        text += fmt::format("  {:<24}{:5.1f} %{:10.3g} s\n", name, seconds > 0 ? 100 * spent / seconds : 0.0,
                            spent);
    return text;
}

} // namespace slurry
