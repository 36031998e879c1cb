#include "solver/time/simulation.hpp"

#include "solver/discs/contact.hpp"
#include "solver/loop/interactions.hpp"
#include "solver/output/phase_clock.hpp"
#include "solver/output/progress.hpp"
#include "solver/output/result_file.hpp"
#include "solver/particles/arrangement.hpp"
#include "solver/scene/refusal.hpp"
#include "solver/terms/selection.hpp"
#include "solver/time/recorder.hpp"
#include "solver/time/time_step.hpp"
#include "solver/time/velocity_verlet.hpp"
#include "solver/time/watchdog.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <omp.h>
#include <unistd.h>
#include <version.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace slurry {

namespace {

// The walls' distances make a check as dear as a few steps; this many in a run cost about 1 %.
constexpr long checks_per_run = 50;

// Steps of equal length that end exactly at the end time. Throws SceneError when they are beyond the limits.
long step_count(const Scene& scene, double time_step) {
    const double steps = std::ceil(scene.output.end_time / time_step * (1 - 1e-12));
    if (!(steps <= scene.limits.steps)) {
        refuse(printable(scene.path.string()),
               fmt::format("{:.4g} steps of {:.4g} s to output.end_time = {} (s)", steps, time_step,
                           scene.output.end_time),
               limit_text(scene.limits, &Limits::steps, steps));
    }
    return std::max(1L, static_cast<long>(steps));
}

// Waking a thread takes as long as the pairs of some hundred particles. The answer is the same for any
// number.
int useful_threads(int wanted, const Particles& particles) {
    constexpr std::size_t least_particles_per_thread = 500;
    const std::size_t shares =
        (particles.fluid.size() + particles.dummies.size()) / least_particles_per_thread;
    return std::clamp(static_cast<int>(shares), 1, wanted);
}

void write_list_attributes(ResultFile& file, const Particles& particles, const ListStatistics& lists) {
    const auto count = static_cast<double>(particles.fluid.size() + particles.dummies.size());
    file.set_attribute("list_rebuilds", static_cast<double>(lists.rebuilds));
    file.set_attribute("list_pairs", static_cast<double>(lists.pairs));
    file.set_attribute("list_evaluated", static_cast<double>(lists.evaluated));
    file.set_attribute("list_useful", static_cast<double>(lists.useful));
    file.set_attribute(
        "bytes_per_particle",
        static_cast<double>(lists.bytes + particles.fluid.bytes() + particles.dummies.bytes()) / count);
}

void write_disc_attributes(ResultFile& file, const Particles& particles, const DiscContacts& contacts) {
    if (particles.discs.empty()) {
        return;
    }
    file.set_attribute("discs", static_cast<double>(particles.discs.size()));
    file.set_attribute("least_gap", contacts.least_gap());
    file.set_attribute("greatest_overlap", std::max(0.0, -contacts.least_gap()));
    file.set_attribute("first_contact_time", contacts.first_contact_time());
}

void write_run_attributes(ResultFile& file, const Particles& particles, long steps, double time_step,
                          int threads, const PhaseClock& clock, const ListStatistics& lists) {
    const double seconds = clock.elapsed();
    const auto fluid = static_cast<double>(particles.fluid.size());
    const auto dummies = static_cast<double>(particles.dummies.size());
    file.set_attribute("fluid_particles", fluid);
    file.set_attribute("dummy_particles", dummies);
    file.set_attribute("steps", static_cast<double>(steps));
    file.set_attribute("time_step", time_step);
    file.set_attribute("end_time", particles.time);
    file.set_attribute("threads", threads);
    file.set_attribute("wall_seconds", seconds);
    file.set_attribute("particle_steps_per_second", (fluid + dummies) * static_cast<double>(steps) / seconds);
    file.set_attribute("particle_mass", particles.fluid.mass);
    for (const PhaseClock::Phase& phase : clock.phases()) {
        std::string name = "seconds_" + phase.name;
        std::replace(name.begin(), name.end(), ' ', '_');
        file.set_attribute(name, phase.seconds);
    }
    write_list_attributes(file, particles, lists);
}

Particles timed_start(const Scene& scene, const Region& region, PhaseClock& clock) {
    const PhaseClock::Scope scope(clock, "start");
    return arrange_particles(scene, region);
}

void print_summary(const RunSummary& summary, const Particles& particles, const PhaseClock& clock) {
    const auto count = particles.fluid.size() + particles.dummies.size();
    fmt::print(std::cout, "{}\n{}", summary.result.string(),
               clock.summary(static_cast<std::int64_t>(count), summary.steps));
}

} // namespace

RunSummary run_scene(const Scene& scene, const RunOptions& options) {
    PhaseClock clock;
    const Region region(scene);
    ResultFile file(options.folder, scene, SLURRY_VERSION, options.overwrite);
    Particles particles = timed_start(scene, region, clock);
    const int threads = useful_threads(options.threads, particles);
    omp_set_num_threads(threads);
    const auto sums = make_interactions(scene);
    DiscContacts contacts(scene, region);
    const long steps = step_count(
        scene, largest_time_step(scene, particles.discs, contacts.highest_frequency(particles.discs)));
    const double time_step = scene.output.end_time / static_cast<double>(steps);
    Forces forces{*sums, contacts, scene.fluid, scene.numerics.sound_speed};
    const long check_interval = std::max(1L, steps / checks_per_run);
    Recorder recorder(scene, region, file, steps, time_step);
    {
        Progress progress(std::cout, progress_style(options.quiet, STDOUT_FILENO), scene.output.end_time);
        prepare_first_step(particles, forces, clock);
        recorder.record(particles, 0);
        for (long step = 1; step <= steps; ++step) {
            advance(particles, forces, time_step, clock);
            const PhaseClock::Scope scope(clock, "output and checks");
            if (step % check_interval == 0 || step == steps) {
                check_particles(particles, region, scene.fluid.density, scene.numerics.particle_spacing,
                                step);
            }
            recorder.record(particles, step);
            progress.update(particles.time, step);
        }
    }
    write_disc_attributes(file, particles, contacts);
    write_run_attributes(file, particles, steps, time_step, threads, clock, sums->list_statistics(particles));
    RunSummary summary{file.finish(), steps};
    if (!options.quiet) {
        print_summary(summary, particles, clock);
    }
    return summary;
}

std::string describe_scene(const Scene& scene) {
    const Region region(scene);
    const Particles particles = arrange_particles(scene, region);
    const double time_step = largest_time_step(
        scene, particles.discs, DiscContacts(scene, region).highest_frequency(particles.discs));
    std::string text =
        fmt::format("fluid particles   {}\ndummy particles   {}\ndiscs             {}\n"
                    "time step         {:.4g} s\nsteps             {}\n"
                    "neighbour reach   {:.4g} m\nterms\n",
                    particles.fluid.size(), particles.dummies.size(), particles.discs.size(), time_step,
                    step_count(scene, time_step), 3 * scene.numerics.smoothing_length());
    for (const TermReason& term : explain_terms(scene)) {
        text += fmt::format("  {:4} {:48} {}\n", term.runs ? "on" : "off", term.term, term.reason);
    }
    return text;
}

} // namespace slurry
