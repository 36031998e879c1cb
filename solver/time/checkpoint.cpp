#include "solver/time/checkpoint.hpp"

#include "solver/output/hdf5_writer.hpp"
#include "solver/output/seal.hpp"
#include "solver/scene/read_scene.hpp"

#include <fmt/format.h>

#include <array>

namespace slurry {
namespace {

constexpr long most_steps = 1L << 50;

// What changes of a disc.
std::array<double*, 11> numbers_of(Disc& disc) {
    return {&disc.position.x(),      &disc.position.y(),     &disc.angle,
            &disc.velocity.x(),      &disc.velocity.y(),     &disc.spin,
            &disc.force.x(),         &disc.force.y(),        &disc.torque,
            &disc.contact_force.x(), &disc.contact_force.y()};
}

std::vector<double> numbers_of(std::vector<Disc>& discs) {
    std::vector<double> numbers;
    for (Disc& disc : discs) {
        for (const double* number : numbers_of(disc)) {
            numbers.push_back(*number);
        }
    }
    return numbers;
}

// Calls visit(path, array) for every array of the particles.
template <class Visit> void each_array(Particles& particles, Visit&& visit) {
    int index = 0;
    particles.fluid.each_array(
        [&](auto& array) { visit(fmt::format("/state/fluid/{:02}", index++), array); });
    index = 0;
    particles.dummies.each_array(
        [&](auto& array) { visit(fmt::format("/state/dummies/{:02}", index++), array); });
}

void write_particles(Hdf5Writer& writer, Particles& particles) {
    constexpr const char* unit = "SI"; // the order of the arrays is that of solver/particles/particles.hpp
    each_array(particles,
               [&](const std::string& path, const auto& array) { writer.write(path, unit, array); });
    const auto& identity = particles.fluid.identity;
    writer.write("/state/identity", "1", std::vector<int>(identity.begin(), identity.end()));
    writer.write("/state/discs", unit, numbers_of(particles.discs));
    writer.set_attribute("/state", "time", particles.time);
}

// What is used as an index is one, however the file came about.
void require_indices(const Hdf5Reader& reader, const Particles& particles) {
    const auto& dummies = particles.dummies;
    const auto& identity = particles.fluid.identity;
    const auto walls = static_cast<int>(dummies.wall_drift.size());
    const auto solids = walls + static_cast<int>(particles.discs.size());
    std::vector<bool> seen(identity.size(), false);
    bool good = true;
    for (const std::uint32_t id : identity) {
        good = good && id < seen.size() && !seen[id];
        if (good) {
            seen[id] = true;
        }
    }
    for (std::size_t d = 0; d < dummies.size(); ++d) {
        const int first = dummies.of_disc(d) ? walls : 0;
        good = good && dummies.wall[d] >= first && dummies.wall[d] < (dummies.of_disc(d) ? solids : walls);
    }
    if (!good) {
        throw ReadError(fmt::format("{}: its particles are not those of the scene", reader.name()));
    }
}

long read_count(const Hdf5Reader& reader, const std::string& object, const std::string& name, long most) {
    const double value = reader.number(object, name);
    if (!(value >= 0 && value <= static_cast<double>(most))) {
        throw ReadError(
            fmt::format("{}: {} of {} is {}, not 0 ... {}", reader.name(), name, object, value, most));
    }
    return static_cast<long>(value);
}

void read_particles(const Hdf5Reader& reader, Particles& particles) {
    each_array(particles, [&]<class T>(const std::string& path, std::vector<T>& array) {
        if constexpr (std::is_same_v<T, int>) {
            array = reader.integers(path, array.size());
        } else {
            array = reader.numbers(path, array.size());
        }
    });
    const auto identity = reader.integers("/state/identity", particles.fluid.size());
    particles.fluid.identity.assign(identity.begin(), identity.end());
    require_indices(reader, particles);
    const auto numbers = reader.numbers("/state/discs", numbers_of(particles.discs).size());
    auto number = numbers.begin();
    for (Disc& disc : particles.discs) {
        for (double* to : numbers_of(disc)) {
            *to = *number++;
        }
    }
    particles.time = reader.number("/state", "time");
}

void write_lists(Hdf5Writer& writer, const ListOrigin& origin) {
    writer.write("/lists/x", "m", origin.x);
    writer.write("/lists/y", "m", origin.y);
    writer.write("/lists/normal_x", "1", origin.normal_x);
    writer.write("/lists/normal_y", "1", origin.normal_y);
    writer.set_attribute("/lists", "time", origin.time);
    writer.set_attribute("/lists", "rebuilds", static_cast<double>(origin.rebuilds));
}

ListOrigin read_lists(const Hdf5Reader& reader, const Particles& particles) {
    const std::size_t dummies = particles.dummies.size();
    const std::size_t all = particles.fluid.size() + dummies;
    return {reader.numbers("/lists/x", all),
            reader.numbers("/lists/y", all),
            reader.numbers("/lists/normal_x", dummies),
            reader.numbers("/lists/normal_y", dummies),
            reader.number("/lists", "time"),
            read_count(reader, "/lists", "rebuilds", 2 * most_steps)};
}

void write_clock(Hdf5Writer& writer, const PhaseClock& clock) {
    writer.make_group("/clock");
    writer.set_attribute("/clock", "elapsed", clock.elapsed());
    const auto& phases = clock.phases();
    writer.set_attribute("/clock", "phases", static_cast<double>(phases.size()));
    for (std::size_t k = 0; k < phases.size(); ++k) {
        writer.set_attribute("/clock", fmt::format("name_{}", k), phases[k].name);
        writer.set_attribute("/clock", fmt::format("seconds_{}", k), phases[k].seconds);
    }
}

void read_clock(const Hdf5Reader& reader, PhaseClock& clock) {
    std::vector<PhaseClock::Phase> phases;
    const long count = read_count(reader, "/clock", "phases", 100);
    for (long k = 0; k < count; ++k) {
        phases.push_back({reader.text("/clock", fmt::format("name_{}", k)),
                          reader.number("/clock", fmt::format("seconds_{}", k))});
    }
    clock.add(phases, reader.number("/clock", "elapsed"));
}

RunIdentity identity_of(const Hdf5Reader& reader) {
    return {reader.text("/", "version"), reader.text("/", "arithmetic"), reader.text("/", "scene"),
            reader.text("/", "files")};
}

// More than a checkpoint takes: the lists' origin is smaller than the particles.
std::uintmax_t bytes_needed(const RunState& state) {
    constexpr std::uintmax_t hdf5 = std::uintmax_t{1} << 20U;
    const Particles& particles = state.particles;
    return state.result.size() + 2 * (particles.fluid.bytes() + particles.dummies.bytes()) + hdf5;
}

} // namespace

void write_checkpoint(PartialFile& file, const RunIdentity& identity, const RunState& state,
                      const std::filesystem::path& scene) {
    file.require_space(bytes_needed(state));
    Hdf5Writer writer(file.path(), seal_size);
    writer.set_attribute("/", "version", identity.version);
    writer.set_attribute("/", "arithmetic", identity.arithmetic);
    writer.set_attribute("/", "scene", identity.scene);
    writer.set_attribute("/", "files", identity.files);
    writer.set_attribute("/", "scene_path", std::filesystem::absolute(scene).string());
    write_particles(writer, state.particles);
    writer.set_attribute("/state", "step", static_cast<double>(state.step));
    writer.set_attribute("/state", "least_gap", state.contacts.least_gap());
    writer.set_attribute("/state", "first_contact_time", state.contacts.first_contact_time());
    write_lists(writer, state.interactions.list_origin());
    write_clock(writer, state.clock);
    state.result.copy_to(writer);
    writer.close();
    file.write(seal_of(file.path()));
}

void read_checkpoint(const std::filesystem::path& path, const RunIdentity& identity, const RunState& state) {
    const Hdf5Reader reader(path);
    if (const std::string found = difference(identity_of(reader), identity); !found.empty()) {
        throw ReadError(fmt::format("{}: the checkpoint has {}; a run goes on with what it began with only",
                                    path.string(), found));
    }
    read_particles(reader, state.particles);
    state.step = read_count(reader, "/state", "step", most_steps);
    state.contacts.restore(reader.number("/state", "least_gap"),
                           reader.number("/state", "first_contact_time"));
    state.interactions.restore_lists(state.particles, read_lists(reader, state.particles));
    state.result.restore(reader);
    read_clock(reader, state.clock);
}

Scene read_checkpoint_scene(const std::filesystem::path& path, std::span<const std::string> overrides,
                            const Limits& limits) {
    const Hdf5Reader reader(path);
    return parse_scene(reader.text("/", "scene"), reader.text("/", "scene_path"), overrides, limits);
}

} // namespace slurry
