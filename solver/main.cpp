// The command line: `slurry run|check|info|converge SCENE`, `slurry help scene`, `slurry bench`.
#include "solver/bench/bench.hpp"
#include "solver/converge/report.hpp"
#include "solver/converge/shell_command.hpp"
#include "solver/discs/motion.hpp"
#include "solver/discs/placement.hpp"
#include "solver/geometry/geometry_error.hpp"
#include "solver/geometry/region.hpp"
#include "solver/output/partial_file.hpp"
#include "solver/output/result_file.hpp"
#include "solver/particles/arrangement.hpp"
#include "solver/particles/start_jump.hpp"
#include "solver/scene/manual.hpp"
#include "solver/scene/read_scene.hpp"
#include "solver/scene/refusal.hpp"
#include "solver/time/checkpoint_folder.hpp"
#include "solver/time/simulation.hpp"
#include "solver/time/start_warnings.hpp"
#include "solver/time/step_count.hpp"
#include "solver/time/watchdog.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace slurry {
namespace {

constexpr int bad_input = 2;
constexpr int run_went_wrong = 3;
constexpr int run_interrupted = 4;

struct Arguments {
    std::filesystem::path scene;
    std::string spacing;
    std::vector<std::string> overrides, limits;
    std::filesystem::path resume;
    std::string checkpoint_interval;
    RunOptions run;
    std::string topic;
    bool markdown = false;
    std::filesystem::path json;
    bool quick = false;
    StudyOptions study;
    std::vector<std::string> words; // of the command line
    double error = 0.01;
};

void print(std::string_view text) {
    errno = 0;
    if (!(std::cout << text << std::flush))
        throw OutputError(fmt::format("standard output: cannot write{}{}", errno == 0 ? "" : ": ",
                                      errno == 0 ? "" : std::strerror(errno)));
}

void warn(const std::string& text) {
    std::cerr << "warning: " << text << '\n';
}

std::vector<std::string> overrides_of(const Arguments& arguments) {
    std::vector<std::string> overrides = arguments.overrides;
    if (!arguments.spacing.empty())
        overrides.push_back("numerics.particle_spacing=" + arguments.spacing);
    if (!arguments.checkpoint_interval.empty())
        overrides.push_back("output.checkpoint_interval=" + arguments.checkpoint_interval);
    return overrides;
}

Limits limits_of(const Arguments& arguments) {
    Limits limits;
    for (const std::string& limit : arguments.limits)
        set_limit(limits, limit);
    return limits;
}

// Of a checkpoint when there is one and no scene is named.
Scene scene_of(const Arguments& arguments, const std::filesystem::path& checkpoint = {}) {
    const std::vector<std::string> overrides = overrides_of(arguments);
    const Limits limits = limits_of(arguments);
    Scene scene = arguments.scene.empty() ? read_checkpoint_scene(checkpoint, overrides, limits)
                                          : read_scene(arguments.scene, overrides, limits);
    std::ranges::for_each(scene.warnings, warn);
    return scene;
}

void write_whole(const std::filesystem::path& path, std::string_view text) {
    PartialFile file(path);
    file.write(text);
    file.synchronise();
    file.commit();
}

struct Examined {
    Region region;
    std::vector<Disc> discs;
};

// Refuses what a run refuses, before anything is written, and warns of what the geometry tells.
Examined examine(const Scene& scene) {
    Region region(scene);
    std::vector<Disc> discs = make_discs(place_discs(scene, region), scene.fluid);
    static_cast<void>(step_count(scene, region, discs));
    std::ranges::for_each(start_jump_warnings(scene, region), warn);
    std::ranges::for_each(start_warnings(scene, region), warn);
    return {std::move(region), std::move(discs)};
}

void run(const Arguments& arguments) {
    RunOptions options = arguments.run;
    if (!arguments.resume.empty()) {
        const FoundCheckpoint found = find_checkpoint(arguments.resume);
        if (!found.warning.empty())
            warn(found.warning);
        options.folder = arguments.resume;
        options.resume_from = found.path;
    } else if (arguments.scene.empty()) {
        throw CLI::RequiredError("SCENE");
    } else if (options.folder.empty()) {
        options.folder = arguments.scene.stem() += ".out";
    }
    const Scene scene = scene_of(arguments, options.resume_from);
    static_cast<void>(examine(scene));
    run_scene(scene, options);
    print(""); // or a summary that got lost would go unnoticed
}

void check(const Arguments& arguments) {
    const Scene scene = scene_of(arguments);
    const auto [region, discs] = examine(scene);
    const std::size_t particles = fluid_points(scene, region, discs).size();
    print(fmt::format(
        "{}: ok, {} fluid particles{}\n", arguments.scene.string(), particles,
        discs.empty() ? "" : fmt::format(", {} disc{}", discs.size(), discs.size() == 1 ? "" : "s")));
}

void info(const Arguments& arguments) {
    print(describe_scene(scene_of(arguments)));
}

void converge(const Arguments& arguments) {
    StudyOptions options = arguments.study;
    if (options.folder.empty()) {
        options.folder = arguments.scene.stem() += ".converge";
    }
    options.threads = arguments.run.threads;
    options.quiet = arguments.run.quiet;
    std::vector<std::string> words{"slurry"}; // the same once more, so that it keeps what is done
    words.insert(words.end(), arguments.words.begin(), arguments.words.end());
    if (!options.reuse)
        words.emplace_back("--reuse");
    options.go_on = shell_command(words);
    static_cast<void>(examine(scene_of(arguments))); // warns once, not at every spacing
    const SceneReader read = [&](const std::vector<std::string>& more) {
        std::vector<std::string> overrides = overrides_of(arguments);
        overrides.insert(overrides.end(), more.begin(), more.end());
        return read_scene(arguments.scene, overrides, limits_of(arguments));
    };
    const Study study = run_study(read, options);
    const std::vector<Plan> plans{plan_for(study, arguments.error)};
    write_whole(options.folder / "convergence.json", study_json(study, plans));
    write_whole(options.folder / "convergence.svg", study_svg(study));
    print(study_text(study, plans));
}

void bench(const Arguments& arguments) {
    std::optional<PartialFile> file; // before the measurement: a file that cannot be written is known now
    if (!arguments.json.empty())
        file.emplace(arguments.json);
    const BenchReport report = measure_machine(arguments.quick);
    print(bench_text(report));
    if (file) {
        file->write(bench_json(report));
        file->synchronise();
        file->commit();
    }
}

CLI::App* add_scene_command(CLI::App& app, const char* name, const char* description, Arguments& arguments) {
    CLI::App* command = app.add_subcommand(name, description);
    command->add_option("SCENE", arguments.scene, "Scene file (TOML); `slurry help scene` describes it")
        ->required(std::string_view(name) != "run");
    command
        ->add_option("--spacing", arguments.spacing,
                     "Particle spacing, m: short for --set numerics.particle_spacing=M")
        ->type_name("M");
    command
        ->add_option("--set", arguments.overrides, "Another value for a key of the scene (may be repeated)")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false); // or it would take SCENE, too
    command
        ->add_option("--limit", arguments.limits,
                     "Allow a larger scene than the limits do, as a refusal says (may be repeated)")
        ->type_name("NAME=NUMBER")
        ->allow_extra_args(false);
    return command;
}

void add_run_options(CLI::App& command, RunOptions& options) {
    command.add_option("--threads", options.threads, "Number of threads; the answer does not depend on it")
        ->check(CLI::Range(1, 1024))
        ->type_name("N")
        ->capture_default_str();
    command.add_flag("--quiet", options.quiet, "No progress and no summary");
}

// Takes a share, or a percentage, which it writes as a share for the conversion that follows; gives what is
// wrong with the text, or nothing.
std::string share_fault(std::string& text) {
    constexpr double least = 1e-9;
    const bool percentage = text.ends_with('%');
    const std::string number = percentage ? text.substr(0, text.size() - 1) + "e-2" : text;
    double share = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), share);
    if (error != std::errc{} || end != number.data() + number.size() || !(share >= least && share <= 1))
        return fmt::format("found {}, allowed a share from {:g} to 1, such as 0.01, or the same in per cent, "
                           "such as 1%",
                           printable(text), least);
    text = number;
    return {};
}

void add_converge_command(CLI::App& app, Arguments& arguments) {
    CLI::App* command = add_scene_command(
        app, "converge", "Run a scene at several spacings: an error band for each quantity", arguments);
    command
        ->add_option("--out", arguments.study.folder,
                     "Folder for convergence.json, convergence.svg and the runs (SCENE's stem + .converge)")
        ->type_name("DIR");
    command
        ->add_option("--spacings", arguments.study.spacings,
                     "How many: the scene's, and coarser ones by sqrt(2) each")
        ->check(CLI::Range(3, 9))
        ->type_name("N")
        ->capture_default_str();
    command
        ->add_option("--error", arguments.error,
                     "Wanted band, of the largest of each kind: which spacing and time does it need?")
        ->transform(CLI::Validator(share_fault, ""))
        ->type_name("SHARE")
        ->capture_default_str();
    command->add_flag(
        "--reuse", arguments.study.reuse,
        "Keep runs of the same scenes that the folder holds already; go on with an interrupted one");
    command->add_flag("!--fixed-sound-speed", arguments.study.vary_sound_speed,
                      "Leave out the run with twice the sound speed, and its share of the bands");
    add_run_options(*command, arguments.run);
    command->callback([&] { converge(arguments); });
}

void add_bench_command(CLI::App& app, Arguments& arguments) {
    CLI::App* command = app.add_subcommand("bench", "Measure this machine, and the pair loops on it");
    command->add_option("--json", arguments.json, "Write the figures to this file, too")->type_name("FILE");
    command->add_flag("--quick", arguments.quick, "Less than a second, and not accurate");
    command->callback([&] { bench(arguments); });
}

void add_commands(CLI::App& app, Arguments& arguments) {
    app.set_version_flag("--version", "slurry " + program_version());
    app.require_subcommand(1);
    CLI::App* runner = add_scene_command(app, "run", "Simulate a scene", arguments);
    CLI::Option* out =
        runner
            ->add_option("--out", arguments.run.folder,
                         "Folder for result.h5 and result.xdmf, made when missing (SCENE's stem + .out)")
            ->type_name("DIR");
    runner
        ->add_option("--resume", arguments.resume,
                     "Go on from the checkpoint in this folder; SCENE may be left out, or has to be the same")
        ->type_name("DIR")
        ->excludes(out);
    runner
        ->add_option("--checkpoint-interval", arguments.checkpoint_interval,
                     "Wall time between checkpoints, s: short for --set output.checkpoint_interval=S")
        ->type_name("S");
    arguments.run.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    add_run_options(*runner, arguments.run);
    runner->callback([&] { run(arguments); });
    add_scene_command(app, "check", "Check a scene and its geometry", arguments)->callback([&] {
        check(arguments);
    });
    add_scene_command(app, "info", "Tell what a run would do, and why", arguments)->callback([&] {
        info(arguments);
    });
    add_converge_command(app, arguments);
    CLI::App* helper = app.add_subcommand("help", "Describe the scene file");
    helper->add_option("TOPIC", arguments.topic, "scene")->required()->check(CLI::IsMember({"scene"}));
    helper->add_flag("--markdown", arguments.markdown, "As Markdown, for the documentation");
    helper->callback([&] { print(arguments.markdown ? scene_manual_markdown() : scene_manual()); });
    add_bench_command(app, arguments);
}

int run_command_line(int count, char** words, Arguments& arguments) {
    CLI::App app("Smoothed particle hydrodynamics of the slurry film in chemical mechanical polishing",
                 "slurry");
    add_commands(app, arguments);
    try {
        app.parse(count, words);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0)
            throw;
        app.exit(error); // --help, --version
        print("");
    }
    return 0;
}

// A script that reads the errors may count on one line for each.
int fail(std::string reason, int status) {
    std::ranges::replace(reason, '\n', ' ');
    std::cerr << reason << '\n';
    return status;
}

int run_and_report(int count, char** words) {
    Arguments arguments;
    arguments.words.assign(words + 1, words + count);
    try {
        return run_command_line(count, words, arguments);
    } catch (const CLI::ParseError& error) {
        return fail(fmt::format("{}; see slurry --help", error.what()), bad_input);
    } catch (const SceneError& error) {
        return fail(error.what(), bad_input);
    } catch (const GeometryError& error) {
        return fail(fmt::format("{}: {}", arguments.scene.string(), error.what()), bad_input);
    } catch (const OutputError& error) {
        return fail(error.what(), bad_input);
    } catch (const ReadError& error) {
        return fail(error.what(), bad_input);
    } catch (const RunInterrupted& end) {
        return fail(end.what(), run_interrupted);
    } catch (const std::bad_alloc&) {
        return fail(
            "out of memory: found more particles or samples than fit; choose a larger particle_spacing",
            bad_input);
    } catch (const RunError& error) {
        return fail(error.what(), run_went_wrong);
    } catch (const std::exception& error) {
        return fail(fmt::format("internal error, please report it: {}", error.what()), run_went_wrong);
    }
}

} // namespace
} // namespace slurry

int main(int count, char** words) {
    std::signal(SIGXFSZ, SIG_IGN); // a limit on file sizes is to end like a full disk, with a reason
    return slurry::run_and_report(count, words);
}
