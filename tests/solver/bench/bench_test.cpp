// `slurry bench` in quick mode. Nothing here depends on how long something takes.
#include "solver/bench/bench.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

namespace slurry {
namespace {

bool positive_and_finite(double value) {
    return value > 0 && std::isfinite(value);
}

TEST(FmaPeak, IsPositiveAndFinite) {
    for (const FmaPeak& peak : {measure_fma_peak<float>(2, true), measure_fma_peak<double>(2, true)}) {
        EXPECT_PRED1(positive_and_finite, peak.one_core);
        EXPECT_PRED1(positive_and_finite, peak.all_cores);
    }
}

template <class Real> void expect_whole_sweeps(const char* arithmetic) {
    const FmaPeak peak{10, 20};
    const auto sweeps = time_pair_sweeps<Real>(peak, true);
    ASSERT_EQ(sweeps.size(), 2U);
    EXPECT_EQ(sweeps[0].sweep, "density rate");
    EXPECT_EQ(sweeps[1].sweep, "forces");
    for (const PairSweepTime& time : sweeps) {
        EXPECT_EQ(time.arithmetic, arithmetic);
        EXPECT_PRED1(positive_and_finite, time.ns_per_particle);
        EXPECT_PRED1(positive_and_finite, time.share_of_port_bound);
        // The kernel's support holds 9 pi = 28.3 lattice cells, one of them the particle's own.
        EXPECT_NEAR(time.pairs_useful, 27, 1);
        EXPECT_GT(time.pairs_evaluated, time.pairs_useful);
        EXPECT_GT(time.flops_per_pair, 20);
        EXPECT_NEAR(time.useful_gflops * time.ns_per_particle, time.pairs_useful * time.flops_per_pair, 1e-9);
        EXPECT_DOUBLE_EQ(time.share_of_fma_peak, time.useful_gflops / peak.one_core);
    }
}

TEST(PairSweeps, CountTheirPairsInFloat) {
    expect_whole_sweeps<float>("float");
}
TEST(PairSweeps, CountTheirPairsInDouble) {
    expect_whole_sweeps<double>("double");
}
TEST(PairSweeps, LeaveTheNumberOfThreadsAsItWas) {
    const int before = omp_get_max_threads();
    omp_set_num_threads(3);
    time_pair_sweeps<double>({1, 1}, true);
    EXPECT_EQ(omp_get_max_threads(), 3);
    omp_set_num_threads(before);
}

TEST(Bench, WritesEveryFigure) {
    const PairSweepTime time{"float", "forces", 20.5, 27, 36, 62, 80.5, 0.5, 0.75};
    const BenchReport report{
        "the \"fastest\"", 2, {160, 320}, {80, 160}, {time, time}, {{"cells", "uniform", 1000, 2, 0.5}}};
    const std::string json = bench_json(report);
    for (const char* part :
         {R"("processor": "the \"fastest\"", "cores": 2, "instruction_set": ")", R"("lanes": {"float": )",
          R"("fma_peak_gflops": {"float": {"one_core": 160, "all_cores": 320}, "double": {"one_core": 80, )",
          R"({"arithmetic": "float", "sweep": "forces", "ns_per_particle": 20.5, "pairs_useful": 27, )",
          R"("pairs_evaluated": 36, "flops_per_pair": 62, "useful_gflops": 80.5, "share_of_fma_peak": 0.5, )",
          R"("share_of_port_bound": 0.75})",
          R"("search": "cells", "set": "uniform", "points": 1000, "threads": 2, "seconds": 0.5)"}) {
        EXPECT_NE(json.find(part), std::string::npos) << part << "\nis not in\n" << json;
    }
    const std::string text = bench_text(report);
    for (const char* part : {"the \"fastest\", 2 cores", "160.0 Gflop/s", "forces", "20.5", "75.0 %"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
    }
}

} // namespace
} // namespace slurry
