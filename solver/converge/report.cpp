#include "solver/converge/report.hpp"

#include "solver/converge/spacings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

namespace slurry {
namespace {

std::string percent(double value, double scale) {
    const double share = 100 * value / scale;
    return std::isfinite(share) ? fmt::format("{:.2f}", share) : "-";
}

std::string number(double value) {
    return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

std::string json_number(double value) {
    return std::isfinite(value) ? fmt::format("{:.10g}", value) : "null";
}

std::string runs_text(const Study& study) {
    const Scene& finest = study.runs.back().scene;
    std::string text = adaptation(finest.domain, study.asked_spacing, finest.numerics.particle_spacing);
    text += text.empty() ? "" : "\n";
    text += fmt::format("{:>12} {:>12} {:>10} {:>9} {:>9}\n", "spacing (m)", "sound (m/s)", "particles",
                        "steps", "wall (s)");
    const auto add = [&](const StudyRun& run) {
        const RunCost& cost = run.stored.cost;
        text += fmt::format("{:12.4g} {:12.4g} {:10.0f} {:9.0f} {:9.2f}\n",
                            run.scene.numerics.particle_spacing, run.scene.numerics.sound_speed,
                            cost.fluid_particles + cost.dummy_particles, cost.steps, cost.wall_seconds);
    };
    for (const StudyRun& run : study.runs) {
        add(run);
    }
    if (study.stiffer) {
        add(*study.stiffer);
    }
    return text;
}

std::string row_text(const Assessment& quantity) {
    const std::string taken =
        quantity.mean ? fmt::format("mean from {:.3g} s", quantity.from_time) : std::string("final");
    return fmt::format(
        "{:10} {:15} {:6} {:>11} {:>9} {:>6} {:>7} {:>6} {:>12} {:>5}  {:14} {}\n", quantity.place,
        quantity.name, quantity.unit, number(quantity.finest()), number(quantity.band()),
        percent(quantity.band(), quantity.scale), percent(quantity.spacing.band(), quantity.scale),
        percent(quantity.sound_speed_band, quantity.scale), number(quantity.extrapolated()),
        std::isnan(quantity.spacing.order) ? "-" : fmt::format("{:.1f}", quantity.spacing.order),
        verdict_name(quantity.spacing.verdict), taken);
}

// Beyond this the law that was seen is not known to hold.
constexpr double farthest_extrapolation = 8;

std::string plan_text(const Study& study, const Plan& plan) {
    std::string text = fmt::format("a band of {:.3g} % ", 100 * plan.error);
    if (plan.needs.spacing > 0) {
        const double factor = plan.needs.sound_speed_factor;
        text += fmt::format(
            "needs a spacing of {:.3g} m{}: about {:.3g} particles, {:.3g} steps, {:.3g} s of "
            "wall time (strictest: {})\n",
            plan.needs.spacing, factor > 1 ? fmt::format(" and {:.3g} times the sound speed", factor) : "",
            plan.particles, plan.steps, plan.wall_seconds, plan.strictest);
        if (plan.needs.spacing * farthest_extrapolation < study.runs.back().scene.numerics.particle_spacing) {
            text += "  far beyond what was run: believe it after a study with a smaller --spacing\n";
        }
    } else {
        text += "is not known to be reached by any spacing\n";
    }
    if (!plan.out_of_reach.empty()) {
        text += fmt::format("  not known to be reached: {}\n", fmt::join(plan.out_of_reach, ", "));
    }
    return text;
}

std::string json(const StudyRun& run) {
    const RunCost& cost = run.stored.cost;
    return fmt::format(
        R"({{"spacing_m": {}, "sound_speed_m_per_s": {}, "fluid_particles": {}, )"
        R"("dummy_particles": {}, "steps": {}, "time_step_s": {}, "wall_s": {}, )"
        R"("particle_steps_per_s": {}}})",
        json_number(run.scene.numerics.particle_spacing), json_number(run.scene.numerics.sound_speed),
        cost.fluid_particles, cost.dummy_particles, cost.steps, json_number(cost.time_step),
        json_number(cost.wall_seconds), json_number(cost.particle_steps() / cost.wall_seconds));
}

std::string json(const Assessment& quantity) {
    std::vector<std::string> values, noises;
    for (const GridValue& at : quantity.values) {
        values.push_back(json_number(at.value));
        noises.push_back(json_number(at.noise));
    }
    return fmt::format(
        R"({{"place": "{}", "quantity": "{}", "unit": "{}", "taken": "{}", "from_s": {}, )"
        R"("values": [{}], "noise": [{}], "value_at_twice_the_sound_speed": {}, "verdict": "{}", )"
        R"("order": {}, "value": {}, "extrapolated": {}, "band": {}, "band_of_spacing": {}, )"
        R"("band_of_sound_speed": {}, "scale": {}}})",
        quantity.place, quantity.name, quantity.unit, quantity.mean ? "mean" : "final",
        json_number(quantity.from_time), fmt::join(values, ", "), fmt::join(noises, ", "),
        quantity.stiffer ? json_number(quantity.stiffer->value) : "null",
        verdict_name(quantity.spacing.verdict), json_number(quantity.spacing.order),
        json_number(quantity.finest()), json_number(quantity.extrapolated()), json_number(quantity.band()),
        json_number(quantity.spacing.band()),
        quantity.stiffer ? json_number(quantity.sound_speed_band) : "null", json_number(quantity.scale));
}

std::string json(const Plan& plan) {
    std::vector<std::string> names;
    for (const std::string& name : plan.out_of_reach) {
        names.push_back('"' + name + '"');
    }
    const bool known = plan.needs.spacing > 0;
    return fmt::format(R"({{"error": {}, "spacing_m": {}, "sound_speed_factor": {}, "wall_s": {}, )"
                       R"("strictest": "{}", "out_of_reach": [{}]}})",
                       json_number(plan.error), known ? json_number(plan.needs.spacing) : "null",
                       known ? json_number(plan.needs.sound_speed_factor) : "null",
                       known ? json_number(plan.wall_seconds) : "null", plan.strictest,
                       fmt::join(names, ", "));
}

template <class Items> std::string json_list(const Items& items) {
    std::string list;
    for (const auto& item : items) {
        list += (list.empty() ? "\n  " : ",\n  ") + json(item);
    }
    return "[" + list + "]";
}

} // namespace

std::string_view verdict_name(Verdict verdict) {
    switch (verdict) {
    case Verdict::converging:
        return "converging";
    case Verdict::settled:
        return "settled";
    case Verdict::scattered:
        return "scattered";
    case Verdict::diverging:
        break;
    }
    return "not converging";
}

std::string study_text(const Study& study, std::span<const Plan> plans) {
    std::string text = runs_text(study) + "\n";
    text += fmt::format("{:10} {:15} {:6} {:>11} {:>9} {:>6} {:>7} {:>6} {:>12} {:>5}\n", "", "", "unit",
                        "value", "+-", "%", "spacing", "sound", "extrapolated", "order");
    for (const Assessment& quantity : study.quantities) {
        text += row_text(quantity);
    }
    text +=
        "\nvalue: at the finest spacing; +-: half of its band; %: of the largest of its kind, and the shares "
        "of it that\nspacing and sound speed have; extrapolated: to no spacing and an infinite sound speed\n";
    if (!study.stiffer) {
        text += "the sound speed was not varied: the bands leave out what its finite value costs\n";
    }
    if (!study.unreadable.empty()) {
        text += fmt::format("without a value in some run: {}\n", fmt::join(study.unreadable, ", "));
    }
    for (const Plan& plan : plans) {
        text += plan_text(study, plan);
    }
    return text;
}

std::string study_json(const Study& study, std::span<const Plan> plans) {
    return fmt::format("{{\"asked_spacing_m\": {},\n \"runs\": {},\n \"twice_the_sound_speed\": {},\n "
                       "\"quantities\": {},\n \"plans\": {}}}\n",
                       json_number(study.asked_spacing), json_list(study.runs),
                       study.stiffer ? json(*study.stiffer) : "null", json_list(study.quantities),
                       json_list(plans));
}

} // namespace slurry
