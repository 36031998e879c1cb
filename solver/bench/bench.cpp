#include "solver/bench/bench.hpp"

#include "solver/loop/pack.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <fstream>
#include <string_view>

namespace slurry {

namespace {

#if defined(__AVX512F__)
constexpr std::string_view instruction_set = "AVX-512";
#elif defined(__AVX2__)
constexpr std::string_view instruction_set = "AVX2";
#elif defined(__AVX__)
constexpr std::string_view instruction_set = "AVX";
#else
constexpr std::string_view instruction_set = "SSE2";
#endif

std::string processor_name() {
    std::ifstream information("/proc/cpuinfo");
    for (std::string line; std::getline(information, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) {
            return line.substr(colon + 2);
        }
    }
    return "unknown";
}

std::string quoted(std::string_view text) {
    std::string result = "\"";
    for (const char character : text) {
        if (character == '"' || character == '\\') {
            result += '\\';
        }
        result += static_cast<unsigned char>(character) < ' ' ? ' ' : character;
    }
    return result + '"';
}

std::string json(const FmaPeak& peak) {
    return fmt::format(R"({{"one_core": {:.6g}, "all_cores": {:.6g}}})", peak.one_core, peak.all_cores);
}

std::string json(const PairSweepTime& time) {
    return fmt::format(
        R"({{"arithmetic": {}, "sweep": {}, "ns_per_particle": {:.6g}, "pairs_useful": {:.6g}, )"
        R"("pairs_evaluated": {:.6g}, "flops_per_pair": {}, "useful_gflops": {:.6g}, )"
        R"("share_of_fma_peak": {:.6g}, "share_of_port_bound": {:.6g}}})",
        quoted(time.arithmetic), quoted(time.sweep), time.ns_per_particle, time.pairs_useful,
        time.pairs_evaluated, time.flops_per_pair, time.useful_gflops, time.share_of_fma_peak,
        time.share_of_port_bound);
}

std::string json(const SearchTime& time) {
    return fmt::format(R"({{"search": {}, "set": {}, "points": {}, "threads": {}, "seconds": {:.6g}}})",
                       quoted(time.search), quoted(time.set), time.points, time.threads, time.seconds);
}

template <class Times> std::string json_list(const Times& times) {
    std::string list;
    for (const auto& time : times) {
        list += (list.empty() ? "\n  " : ",\n  ") + json(time);
    }
    return "[" + list + "]";
}

} // namespace

BenchReport measure_machine(bool quick) {
    BenchReport report;
    report.processor = processor_name();
    report.cores = omp_get_num_procs();
    report.float_peak = measure_fma_peak<float>(report.cores, quick);
    report.double_peak = measure_fma_peak<double>(report.cores, quick);
    report.pair_sweeps = time_pair_sweeps<float>(report.float_peak, quick);
    for (PairSweepTime& time : time_pair_sweeps<double>(report.double_peak, quick)) {
        report.pair_sweeps.push_back(std::move(time));
    }
    report.searches = time_searches(report.cores, quick);
    return report;
}

std::string bench_text(const BenchReport& report) {
    std::string text = fmt::format("processor         {}, {} cores available\n"
                                   "instruction set   {}: {} lanes of float, {} of double\n",
                                   report.processor, report.cores, instruction_set, native_lanes<float>,
                                   native_lanes<double>);
    text += fmt::format("FMA peak          float {:.1f} Gflop/s on one core, {:.1f} on all\n"
                        "                  double {:.1f} Gflop/s on one core, {:.1f} on all\n",
                        report.float_peak.one_core, report.float_peak.all_cores, report.double_peak.one_core,
                        report.double_peak.all_cores);
    text += fmt::format(
        "pair sweeps on one core\n  {:6}  {:12}  {:>11}  {:>15}  {:>18}  {:>9}  {:>7}  {:>8}  {:>10}\n", "",
        "", "ns/particle", "useful/particle", "evaluated/particle", "flop/pair", "Gflop/s", "FMA peak",
        "port bound");
    for (const PairSweepTime& time : report.pair_sweeps) {
        text +=
            fmt::format("  {:6}  {:12}  {:11.1f}  {:15.1f}  {:18.1f}  {:9}  {:7.1f}  {:6.1f} %  {:8.1f} %\n",
                        time.arithmetic, time.sweep, time.ns_per_particle, time.pairs_useful,
                        time.pairs_evaluated, time.flops_per_pair, time.useful_gflops,
                        100 * time.share_of_fma_peak, 100 * time.share_of_port_bound);
    }
    text += fmt::format("neighbour search\n  {:11}  {:9}  {:>8}  {:>7}  {:>8}\n", "", "", "points", "threads",
                        "ns/point");
    for (const SearchTime& time : report.searches) {
        text += fmt::format("  {:11}  {:9}  {:8}  {:7}  {:8.0f}\n", time.search, time.set, time.points,
                            time.threads, time.seconds / static_cast<double>(time.points) * 1e9);
    }
    return text;
}

std::string bench_json(const BenchReport& report) {
    return fmt::format(R"({{"processor": {}, "cores": {}, "instruction_set": {},
 "lanes": {{"float": {}, "double": {}}},
 "fma_peak_gflops": {{"float": {}, "double": {}}},
 "pair_sweeps": {},
 "search": {}}}
)",
                       quoted(report.processor), report.cores, quoted(instruction_set), native_lanes<float>,
                       native_lanes<double>, json(report.float_peak), json(report.double_peak),
                       json_list(report.pair_sweeps), json_list(report.searches));
}

} // namespace slurry
