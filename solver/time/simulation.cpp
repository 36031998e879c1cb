#include "solver/time/simulation.hpp"

#include "solver/discs/contact.hpp"
#include "solver/discs/motion.hpp"
#include "solver/discs/placement.hpp"
#include "solver/loop/interactions.hpp"
#include "solver/output/phase_clock.hpp"
#include "solver/output/progress.hpp"
#include "solver/output/result_file.hpp"
#include "solver/particles/arrangement.hpp"
#include "solver/terms/selection.hpp"
#include "solver/time/checkpoint_folder.hpp"
#include "solver/time/density_error.hpp"
#include "solver/time/interruption.hpp"
#include "solver/time/recorder.hpp"
#include "solver/time/step_count.hpp"
#include "solver/time/time_step.hpp"
#include "solver/time/velocity_verlet.hpp"
#include "solver/time/watchdog.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace slurry {

namespace {

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

class Run {
  public:
    Run(const Scene& scene, const RunOptions& options)
        : scene_(scene), options_(options), region_(scene),
          steps_(step_count(scene, region_, make_discs(place_discs(scene, region_), scene.fluid))),
          file_(options.folder, scene, program_version(), options.overwrite),
          particles_(timed_start(scene, region_, clock_)),
          threads_(useful_threads(options.threads, particles_)), sums_(make_interactions(scene)),
          contacts_(scene, region_), time_step_(scene.output.end_time / static_cast<double>(steps_)),
          forces_{*sums_, contacts_, scene.fluid, scene.numerics.sound_speed,
                  scene.numerics.keep_mean_density},
          recorder_(scene, region_, file_, steps_, time_step_),
          checkpoints_(options.folder, scene.output.checkpoint_interval, options.resume_from),
          state_{step_, particles_, *sums_, contacts_, file_, clock_} {
        omp_set_num_threads(threads_);
        if (checkpoints_.has_foreign()) {
            warn(fmt::format("{}: holds the checkpoint of an interrupted run, which this run will replace; "
                             "slurry run --resume goes on with it",
                             options.folder.string()));
        }
    }

    RunSummary operator()() {
        try {
            simulate();
        } catch (const RunError& error) {
            throw RunError(error.what() + set_aside());
        }
        write_attributes();
        RunSummary summary{file_.finish(), steps_};
        checkpoints_.remove();
        if (!options_.quiet) {
            print_summary(summary, particles_, clock_);
            std::cout << density_note(summary.result, scene_);
        }
        if (const std::string text = density_warning(summary.result, scene_, region_, time_step_);
            !text.empty()) {
            warn(text);
        }
        return summary;
    }

  private:
    static void warn(const std::string& text) { std::cerr << "warning: " << text << '\n'; }

    void simulate() {
        begin();
        Progress progress(std::cout, progress_style(options_.quiet, STDOUT_FILENO), scene_.output.end_time,
                          particles_.time);
        while (step_ < steps_) {
            take_step();
            const PhaseClock::Scope scope(clock_, "output and checks");
            watch(particles_, region_, scene_, step_, steps_);
            recorder_.record(particles_, step_);
            progress.update(particles_.time, step_);
            if (step_ < steps_) {
                stop_if_interrupted();
                keep_checkpoint_if_due();
            }
        }
    }

    void begin() {
        if (options_.resume_from.empty()) {
            prepare_first_step(particles_, forces_, time_step_, clock_);
            recorder_.record(particles_, 0);
            return;
        }
        read_checkpoint(options_.resume_from, identity_, state_);
        if (step_ >= steps_) {
            throw ReadError(fmt::format("{}: is of step {}, and the run has {}",
                                        options_.resume_from.string(), step_, steps_));
        }
        if (!options_.quiet) {
            fmt::print(std::cout, "resumed at step {} of {}\n", step_, steps_);
        }
    }

    void take_step() {
        try {
            advance(particles_, forces_, time_step_, clock_);
        } catch (const RunError& error) {
            throw RunError(fmt::format("step {}, {}", step_ + 1, error.what()));
        }
        ++step_;
    }

    void write_attributes() {
        write_disc_attributes(file_, particles_, contacts_);
        write_run_attributes(file_, particles_, step_, time_step_, threads_, clock_,
                             sums_->list_statistics(particles_));
    }

    void stop_if_interrupted() {
        if (const char* signal = Interruption::signal_name()) {
            checkpoints_.write(identity_, state_, scene_.path);
            const std::string resume = fmt::format("slurry run --resume {}", options_.folder.string());
            throw RunInterrupted(fmt::format("ended by {} after step {} of {}, time {:.6g} s; to go on: {}",
                                             signal, step_, steps_, particles_.time,
                                             options_.go_on.empty() ? resume : options_.go_on));
        }
    }

    // A state that the watchdog will not let pass is no good to go on from, and a checkpoint that cannot be
    // written no reason to end a run that may come to its end without.
    void keep_checkpoint_if_due() {
        if (!checkpoints_.due()) {
            return;
        }
        try {
            check_particles(particles_, region_, scene_, step_);
            checkpoints_.write(identity_, state_, scene_.path);
        } catch (const OutputError& error) {
            warn(fmt::format("no checkpoint at step {}: {}", step_, error.what()));
        } catch (const RunError&) { // whether a run goes wrong does not depend on when checkpoints are due
            return;
        }
    }

    // Where the state that went wrong is, and the last good one.
    std::string set_aside() {
        std::string where;
        try {
            recorder_.record_snapshot(particles_);
            write_attributes();
            where = fmt::format("; its state is in {}", file_.set_aside().string());
        } catch (const OutputError& error) {
            where = fmt::format("; its state is lost: {}", error.what());
        }
        return checkpoints_.newest().empty()
                   ? where
                   : fmt::format("{}, the last good one in {}", where, checkpoints_.newest().string());
    }

    const Interruption interruption_;
    PhaseClock clock_;
    const Scene& scene_;
    const RunOptions& options_;
    const Region region_;
    const long steps_; // before the file: a run of too many steps is refused and leaves no folder
    ResultFile file_;
    Particles particles_;
    const int threads_;
    const std::unique_ptr<Interactions> sums_;
    DiscContacts contacts_;
    const double time_step_;
    Forces forces_;
    Recorder recorder_;
    CheckpointFolder checkpoints_;
    const RunIdentity identity_ = run_identity(scene_);
    long step_ = 0;
    const RunState state_;
};

} // namespace

RunSummary run_scene(const Scene& scene, const RunOptions& options) {
    return Run(scene, options)();
}

std::string describe_scene(const Scene& scene) {
    const Region region(scene);
    const Particles particles = arrange_particles(scene, region);
    const TimeStepBound bound = time_step_bound(
        scene, particles.discs, DiscContacts(scene, region).highest_frequency(particles.discs));
    std::string text =
        fmt::format("fluid particles   {}\ndummy particles   {}\ndiscs             {}\n"
                    "time step         {:.4g} s\nlimited by        {}\nsteps             {}\n"
                    "neighbour reach   {:.4g} m\nterms\n",
                    particles.fluid.size(), particles.dummies.size(), particles.discs.size(), bound.step,
                    bound.cause, step_count(scene, bound.step), 3 * scene.numerics.smoothing_length());
    for (const TermReason& term : explain_terms(scene)) {
        text += fmt::format("  {:4} {:48} {}\n", term.runs ? "on" : "off", term.term, term.reason);
    }
    return text;
}

} // namespace slurry
