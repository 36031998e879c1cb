#include "solver/converge/stored_run.hpp"

#include "solver/output/hdf5_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

namespace slurry {
namespace {

// With more than these a disc's own way depends on chance; the mean of all does less so.
constexpr std::size_t most_single_discs = 4;

double interpolated(std::span<const double> time, std::span<const double> value, double at) {
    const auto after = static_cast<std::size_t>(std::ranges::upper_bound(time, at) - time.begin());
    if (after == 0 || after == time.size()) {
        return after == 0 ? value.front() : value.back();
    }
    const double share = (at - time[after - 1]) / (time[after] - time[after - 1]);
    return std::lerp(value[after - 1], value[after], share);
}

struct Extremes {
    double least = INFINITY, mean = 0, largest = -INFINITY;

    // Over the values that are there: a grid has none outside the fluid.
    explicit Extremes(std::span<const double> values) {
        int count = 0;
        for (const double value : values) {
            if (!std::isnan(value)) {
                least = std::min(least, value);
                largest = std::max(largest, value);
                mean += value;
                ++count;
            }
        }
        mean /= count;
    }
};

class Collector {
  public:
    Collector(const Hdf5Reader& file, const Scene& scene)
        : file_(file), scene_(scene), time_(file.table("/series/time").values),
          level_(file.table("/series/mean_density").values) {
        for (double& density : level_) { // to the mean pressure, Eq. 2.11
            density = std::pow(scene.numerics.sound_speed, 2) * (density - scene.fluid.density);
        }
    }

    std::vector<Quantity> collect() {
        if (scene_.start.arrangement != Arrangement::empty) {
            add("flow", "kinetic_energy", "J/m", Kind::energy, time_,
                file_.table("/series/kinetic_energy").values);
            add("flow", "momentum_x", "kg/s", Kind::momentum, time_,
                file_.table("/series/momentum_x").values);
            add("flow", "momentum_y", "kg/s", Kind::momentum, time_,
                file_.table("/series/momentum_y").values);
        }
        for (const ProbeScene& probe : scene_.probes) {
            const std::string group = "/probes/" + probe.name + "/";
            std::visit([&](const auto& kind) { add_probe(probe.name, group, kind); }, probe.kind);
        }
        if (file_.has("/discs")) {
            add_discs();
        }
        return std::move(quantities_);
    }

  private:
    void add(std::string place, std::string name, std::string unit, Kind kind, std::vector<double> time,
             std::vector<double> value) {
        quantities_.push_back(
            {std::move(place), std::move(name), std::move(unit), kind, std::move(time), std::move(value)});
    }

    // The quantity `of(extremes, time)` of every row of a table.
    template <class Of>
    void add_rows(const std::string& place, std::string name, Kind kind, const std::vector<double>& time,
                  const StoredTable& table, Of of) {
        std::vector<double> values;
        for (std::size_t row = 0; row < table.rows; ++row) {
            const auto all = std::span(table.values).subspan(row * table.columns, table.columns);
            values.push_back(of(Extremes(all), time[row]));
        }
        add(place, std::move(name), kind == Kind::velocity ? "m/s" : "Pa", kind, time, std::move(values));
    }

    void add_probe(const std::string& place, const std::string& group, const WallProbe& /*probe*/) {
        const std::vector<double> time = file_.table(group + "time").values;
        add_pressures(place, time, file_.table(group + "pressure"));
        const StoredTable shear = file_.table(group + "shear");
        const auto add_shear = [&](const char* name, auto member) {
            add_rows(place, name, Kind::shear, time, shear,
                     [&](const Extremes& of, double) { return of.*member; });
        };
        add_shear("shear_max", &Extremes::largest);
        add_shear("shear_min", &Extremes::least);
        add_shear("shear_mean", &Extremes::mean);
    }

    void add_pressures(const std::string& place, const std::vector<double>& time, const StoredTable& table) {
        add_rows(place, "pressure_max", Kind::pressure, time, table,
                 [](const Extremes& of, double) { return of.largest - of.mean; });
        add_rows(place, "pressure_min", Kind::pressure, time, table,
                 [](const Extremes& of, double) { return of.least - of.mean; });
        add_rows(place, "pressure_mean", Kind::pressure, time, table,
                 [&](const Extremes& of, double at) { return of.mean - interpolated(time_, level_, at); });
    }

    void add_probe(const std::string& place, const std::string& group, const PointProbe& /*probe*/) {
        const std::vector<double> time = file_.table(group + "time").values;
        std::vector<double> pressure = file_.table(group + "pressure").values;
        for (std::size_t sample = 0; sample < pressure.size(); ++sample) {
            pressure[sample] -= interpolated(time_, level_, time[sample]);
        }
        add(place, "pressure", "Pa", Kind::pressure, time, std::move(pressure));
        for (const char* name : {"velocity_x", "velocity_y"}) {
            add(place, name, "m/s", Kind::velocity, time, file_.table(group + name).values);
        }
    }

    void add_probe(const std::string& place, const std::string& group, const GridProbe& /*probe*/) {
        const std::vector<double> time = file_.table(group + "time").values;
        add_pressures(place, time, file_.table(group + "pressure"));
        for (const std::string name : {"velocity_x", "velocity_y"}) {
            const StoredTable table = file_.table(group + name);
            add_rows(place, name + "_max", Kind::velocity, time, table,
                     [](const Extremes& of, double) { return of.largest; });
            add_rows(place, name + "_min", Kind::velocity, time, table,
                     [](const Extremes& of, double) { return of.least; });
        }
    }

    void add_discs() {
        struct Field {
            const char* name;
            const char* unit;
            Kind kind;
        };
        constexpr std::array fields{
            Field{"position_x", "m", Kind::position},   Field{"position_y", "m", Kind::position},
            Field{"velocity_x", "m/s", Kind::velocity}, Field{"velocity_y", "m/s", Kind::velocity},
            Field{"spin", "rad/s", Kind::spin},         Field{"force_x", "N/m", Kind::force},
            Field{"force_y", "N/m", Kind::force},       Field{"torque", "N", Kind::torque}};
        const std::vector<double> time = file_.table("/discs/time").values;
        for (const Field& field : fields) {
            const StoredTable table = file_.table(std::string("/discs/") + field.name);
            if (table.columns <= most_single_discs) {
                for (std::size_t disc = 0; disc < table.columns; ++disc) {
                    add(fmt::format("disc_{}", disc + 1), field.name, field.unit, field.kind, time,
                        table.column(disc));
                }
            } else if (field.kind != Kind::position) {
                std::vector<double> mean;
                for (std::size_t row = 0; row < table.rows; ++row) {
                    const auto all = std::span(table.values).subspan(row * table.columns, table.columns);
                    mean.push_back(Extremes(all).mean);
                }
                add("discs", fmt::format("mean_{}", field.name), field.unit, field.kind, time, mean);
            }
        }
    }

    const Hdf5Reader& file_;
    const Scene& scene_;
    std::vector<double> time_, level_; // of the series: s, and the fluid's mean pressure, Pa
    std::vector<Quantity> quantities_;
};

} // namespace

bool is_file_of(const std::filesystem::path& file, const Scene& scene) {
    return std::filesystem::exists(file) && Hdf5Reader(file).text("/", "scene") == scene.resolved_text;
}

StoredRun read_run(const std::filesystem::path& result, const Scene& scene) {
    const Hdf5Reader file(result);
    const auto of_run = [&](const char* name) { return file.number("/run", name); };
    return {{of_run("fluid_particles"), of_run("dummy_particles"), of_run("steps"), of_run("time_step"),
             of_run("wall_seconds")},
            Collector(file, scene).collect()};
}

} // namespace slurry
