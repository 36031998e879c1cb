#pragma once
// Writes what a scene asks for while it runs: time series, probes, snapshots.
#include "solver/geometry/region.hpp"
#include "solver/output/result_file.hpp"
#include "solver/particles/particles.hpp"
#include "solver/scene/scene.hpp"

#include <vector>

namespace slurry {

class Recorder {
  public:
    // The region and the file must outlive this. `steps` and `time_step` (s) are those of the whole run.
    Recorder(const Scene& scene, const Region& region, ResultFile& file, long steps, double time_step);

    // To be called once before the first step (step = 0) and after each: records what is due.
    void record(const Particles& particles, long step);
    void record_snapshot(const Particles& particles);

  private:
    struct WallSamples {
        const ProbeScene* probe;
        const Wall* wall;
        std::vector<WallPoint> points;
    };

    void begin_probes();
    void record_series(const Particles& particles);
    void record_points(const Particles& particles);
    void record_discs(const Particles& particles);
    void record_walls_and_grids(const Particles& particles);

    const Scene& scene_;
    const Region& region_;
    ResultFile& file_;
    std::vector<bool> series_due_, probes_due_, snapshot_due_; // per step
    std::vector<WallSamples> walls_;
};

} // namespace slurry
