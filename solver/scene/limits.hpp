#pragma once
// How large a scene may be. A scene file is not trusted: a slip of a digit, or malice, must not take the
// machine's memory or disk. What is larger is refused before anything is allocated, unless the command line
// allows it.
#include <array>
#include <string>
#include <string_view>

namespace slurry {

struct Limits {
    double particles = 2e7;          // of the fluid, as if it filled the domain
    double discs = 1e5;              // single ones and members of groups
    double steps = 1e9;              // of a run
    double probe_values = 1e8;       // points times samples, of all probes
    double snapshot_particles = 1e9; // particles times snapshots
    double series_values = 1e9;      // discs times samples of the series
};

// A limit that the command line can change.
struct NamedLimit {
    std::string_view name;
    double Limits::*value;
};

inline constexpr std::array<NamedLimit, 6> named_limits{{{"particles", &Limits::particles},
                                                         {"discs", &Limits::discs},
                                                         {"steps", &Limits::steps},
                                                         {"probe_values", &Limits::probe_values},
                                                         {"snapshot_particles", &Limits::snapshot_particles},
                                                         {"series_values", &Limits::series_values}}};

// Sets one limit from the text `name=number`. Throws SceneError: no such limit, no positive number.
void set_limit(Limits& limits, const std::string& text);

// What a refusal says of a limit: `at most 2e+07; --limit particles=4e+07 would allow it`.
[[nodiscard]] std::string limit_text(const Limits& limits, double Limits::*limit, double needed);

} // namespace slurry
