// Studies of runs that were never made: values that follow known laws of spacing and sound speed.
#include "solver/converge/report.hpp"
#include "solver/converge/requirement.hpp"
#include "solver/converge/study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

namespace slurry {
namespace {

using Law = std::function<double(double spacing, double sound_speed)>;

struct Laws {
    std::string place, name;
    Kind kind;
    Law law;
};

StudyRun fake_run(const std::vector<Laws>& laws, double spacing, double sound_speed) {
    StudyRun run;
    run.scene.fluid = {1000, 1e-6, Vector::Zero()}; // sound limits the step
    run.scene.numerics.particle_spacing = spacing;
    run.scene.numerics.sound_speed = sound_speed;
    run.stored.cost = {1e4 / (spacing * spacing), 1e3 / spacing, 1e3 / spacing, 1e-3 * spacing,
                       2 / std::pow(spacing, 3)};
    for (const Laws& quantity : laws) {
        Quantity values{quantity.place, quantity.name, "Pa", quantity.kind, {}, {}};
        for (int k = 0; k <= 40; ++k) {
            values.time.push_back(k);
            values.value.push_back(quantity.law(spacing, sound_speed));
        }
        run.stored.quantities.push_back(values);
    }
    return run;
}

Study fake_study(const std::vector<Laws>& laws, bool stiffer = true) {
    Study study;
    study.asked_spacing = 1;
    for (const double spacing : {2.0, 1.4, 1.0}) {
        study.runs.push_back(fake_run(laws, spacing, 10));
    }
    if (stiffer) {
        study.stiffer = fake_run(laws, 1.4, 20);
    }
    assess(study);
    return study;
}

const Laws second_order{"wafer", "shear_max", Kind::shear,
                        [](double h, double c) { return 100 + 4 * h * h + 200 / (c * c); }};

TEST(Study, SeparatesWhatSpacingAndSoundSpeedCost) {
    const Study study = fake_study({second_order});
    const Assessment& shear = study.quantities.at(0);
    EXPECT_TRUE(shear.mean);
    EXPECT_EQ(shear.spacing.verdict, Verdict::converging);
    EXPECT_NEAR(shear.spacing.order, 2, 0.03);
    EXPECT_NEAR(shear.spacing.error, 1.25 * 4, 0.1);
    EXPECT_NEAR(shear.sound_speed_band, 1.25 * 2, 1e-9);
    EXPECT_NEAR(shear.extrapolated(), 100, 0.1);
    EXPECT_GT(shear.band(), std::abs(shear.finest() - 100));
}

TEST(Study, ASpacingThatWasChangedIsTold) {
    Study study = fake_study({second_order});
    EXPECT_EQ(study_text(study, {}).find("becomes"), std::string::npos);
    study.asked_spacing = 1.02;
    EXPECT_NE(study_text(study, {}).find("spacing 1.02 m becomes 1 m"), std::string::npos);
    EXPECT_NE(study_json(study, {}).find("\"asked_spacing_m\": 1.02,"), std::string::npos);
}

TEST(Study, WithoutTheStifferRunItsShareIsLeftOut) {
    const Study study = fake_study({second_order}, false);
    EXPECT_EQ(study.quantities.at(0).sound_speed_band, 0);
    EXPECT_NE(study_text(study, {}).find("sound speed was not varied"), std::string::npos);
    EXPECT_EQ(study_json(study, {}).find("\"band_of_sound_speed\": 0"), std::string::npos);
}

TEST(Study, PercentagesAreOfTheLargestOfTheKind) {
    const Laws small{"wafer", "shear_mean", Kind::shear, [](double h, double) { return 1e-3 * h; }};
    const Study study = fake_study({second_order, small});
    EXPECT_NEAR(study.quantities.at(1).scale, 106, 1e-9);
}

TEST(Study, AQuantityWithoutANumberIsNamedAndLeftOut) {
    const Laws broken{"point", "pressure", Kind::pressure,
                      [](double h, double) { return h < 1.2 ? std::nan("") : 1; }};
    const Study study = fake_study({second_order, broken});
    EXPECT_EQ(study.quantities.size(), 1U);
    ASSERT_EQ(study.unreadable.size(), 1U);
    EXPECT_NE(study_text(study, {}).find("point pressure"), std::string::npos);
}

TEST(Study, WhatDivergesIsRefusedEverywhere) {
    const Laws diverging{"point", "pressure", Kind::pressure, [](double h, double) { return 1 / (h * h); }};
    const Study study = fake_study({diverging});
    EXPECT_TRUE(std::isnan(study.quantities.at(0).band()));
    const Plan plan = plan_for(study, 0.01);
    EXPECT_EQ(plan.needs.spacing, 0);
    EXPECT_EQ(plan.out_of_reach, std::vector<std::string>{"point pressure"});
    const std::vector<Plan> plans{plan};
    EXPECT_NE(study_text(study, plans).find("not converging"), std::string::npos);
    EXPECT_NE(study_json(study, plans).find("\"band\": null"), std::string::npos);
}

TEST(Requirement, TheBandAtTheSpacingThatItNamesIsTheWantedOne) {
    const Study study = fake_study({second_order});
    const Assessment& shear = study.quantities.at(0);
    const Requirement needs = requirement(shear, 2);
    const double at_needs = shear.spacing.error * std::pow(needs.spacing, shear.spacing.order_used) +
                            shear.spacing.floor +
                            shear.sound_speed_band / std::pow(needs.sound_speed_factor, 2);
    EXPECT_NEAR(at_needs, 2, 1e-9);
    EXPECT_GT(needs.sound_speed_factor, 1);
    EXPECT_EQ(requirement(shear, 100).spacing, 2); // the coarsest is enough, and none coarser was run
}

TEST(Requirement, TheTimeGrowsWithTheThirdPowerOfTheSpacing) {
    const Laws exact_sound{"wafer", "shear_max", Kind::shear,
                           [](double h, double) { return 100 + 4 * h * h; }};
    const Study study = fake_study({exact_sound});
    const Plan plan = plan_for(study, 0.01);
    const double finer = 1 / plan.needs.spacing;
    EXPECT_GT(finer, 1.5);
    EXPECT_EQ(plan.needs.sound_speed_factor, 1);
    EXPECT_NEAR(plan.steps, 1e3 * finer, 1e-6 * plan.steps);
    EXPECT_NEAR(plan.wall_seconds, 2 * std::pow(finer, 3), 0.1 * plan.wall_seconds); // dummies grow less
    EXPECT_LE(plan.wall_seconds, 2 * std::pow(finer, 3));
}

TEST(Requirement, ScatterHasNoSpacingThatLowersIt) {
    const Laws scatter{"wafer", "shear_max", Kind::shear, [](double h, double) {
                           return h > 1.5 ? 102 : h > 1.2 ? 100 : 101;
                       }};
    const Study study = fake_study({scatter});
    EXPECT_EQ(requirement(study.quantities.at(0), 1).spacing, 0);
    EXPECT_EQ(requirement(study.quantities.at(0), 10).spacing, 1);
}

TEST(Requirement, NoiseAboutNothingIsNotAskedFor) {
    const Laws noise{"wafer", "shear_mean", Kind::shear, [](double h, double) { return 1e-3 / (h * h); }};
    EXPECT_TRUE(plan_for(fake_study({second_order, noise}), 0.01).out_of_reach.empty());
}

TEST(Figure, HasAPanelForEachQuantityAndNothingThatIsNoNumber) {
    const Laws diverging{"point", "pressure", Kind::pressure, [](double h, double) { return 1 / (h * h); }};
    const Laws zero{"point", "velocity_x", Kind::velocity, [](double, double) { return 0.0; }};
    const std::string svg = study_svg(fake_study({second_order, diverging, zero}));
    for (const char* name : {"wafer shear_max", "point pressure", "point velocity_x"}) {
        EXPECT_NE(svg.find(name), std::string::npos);
    }
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("=\"inf"), std::string::npos); // "infinite sound speed" is in the legend
}

// The heights of a panel's curve, from the axis on, in pixels.
std::vector<double> heights_of_curve(const std::string& svg) {
    const std::size_t start = svg.find("<path d=\"M", svg.find("order"));
    std::vector<double> heights;
    std::istringstream path(svg.substr(start + 10, svg.find('"', start + 10) - start - 10));
    std::string word; // "M64.0", then "120.3L70.1" and so on: a height and the next place
    path >> word;
    while (path >> word) {
        heights.push_back(std::stod(word));
    }
    return heights;
}

TEST(Figure, TheCurveIsDrawnWholeWhereThePointsLieBelowIt) {
    // The fit is of second order at most, and through the finest value: above the coarsest one.
    const Laws sudden{"wafer", "shear_max", Kind::shear,
                      [](double h, double) { return 100 + 0.1 * std::pow(h, 5); }};
    const Study study = fake_study({sudden}, false);
    ASSERT_EQ(study.quantities.at(0).spacing.verdict, Verdict::converging);
    const std::vector<double> heights = heights_of_curve(study_svg(study));
    ASSERT_GT(heights.size(), 30U);
    constexpr double top_of_panel = 38, bottom_of_panel = 164;
    for (std::size_t k = 0; k < heights.size(); ++k) {
        EXPECT_GT(heights[k], top_of_panel);
        EXPECT_LT(heights[k], bottom_of_panel);
        if (k > 1) {
            EXPECT_LT(heights[k], heights[k - 1]); // a flat end is a curve that was cut
        }
    }
}

} // namespace
} // namespace slurry
