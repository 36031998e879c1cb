#include "solver/converge/requirement.hpp"

#include "solver/time/time_step.hpp"

#include <algorithm>
#include <cmath>

namespace slurry {

namespace {

// At no spacing as large as the error that is wanted: noise about nothing, whose order need not be known.
bool negligible(const Assessment& quantity, double error) {
    return std::ranges::all_of(quantity.values,
                               [&](const GridValue& at) { return std::abs(at.value) <= error; });
}

} // namespace

Requirement requirement(const Assessment& quantity, double error) {
    const Estimate& estimate = quantity.spacing;
    Requirement needs;
    double left = error - quantity.sound_speed_band;
    if (left < error / 2) {
        needs.sound_speed_factor = std::sqrt(quantity.sound_speed_band / (error / 2));
        left = error / 2;
    }
    const double coarsest = quantity.values.front().spacing;
    if (!(estimate.floor < left)) { // true for NaN
        return needs;
    }
    if (estimate.verdict == Verdict::scattered) {
        needs.spacing = quantity.values.back().spacing;
    } else if (estimate.error > 0) {
        const double ratio = std::pow((left - estimate.floor) / estimate.error, 1 / estimate.order_used);
        needs.spacing = std::min(coarsest, quantity.values.back().spacing * ratio);
    } else {
        needs.spacing = coarsest;
    }
    return needs;
}

Plan plan_for(const Study& study, double error) {
    Plan plan{.error = error, .needs = {}, .strictest = {}, .out_of_reach = {}};
    for (const Assessment& quantity : study.quantities) {
        const std::string name = quantity.place + " " + quantity.name;
        if (negligible(quantity, error * quantity.scale)) {
            continue;
        }
        const Requirement needs = requirement(quantity, error * quantity.scale);
        if (needs.spacing <= 0) {
            plan.out_of_reach.push_back(name);
            continue;
        }
        if (plan.needs.spacing <= 0 || needs.spacing < plan.needs.spacing) {
            plan.needs.spacing = needs.spacing;
            plan.strictest = name;
        }
        plan.needs.sound_speed_factor = std::max(plan.needs.sound_speed_factor, needs.sound_speed_factor);
    }
    if (plan.needs.spacing > 0) {
        const StudyRun& finest = study.runs.back();
        const RunCost& cost = finest.stored.cost;
        Scene scene = finest.scene;
        scene.numerics.particle_spacing = plan.needs.spacing;
        scene.numerics.sound_speed *= plan.needs.sound_speed_factor;
        const double finer = finest.scene.numerics.particle_spacing / plan.needs.spacing;
        plan.particles = cost.fluid_particles * finer * finer + cost.dummy_particles * finer;
        plan.steps = cost.steps * largest_time_step(finest.scene) / largest_time_step(scene);
        plan.wall_seconds = cost.wall_seconds * plan.particles * plan.steps / cost.particle_steps();
    }
    return plan;
}

} // namespace slurry
