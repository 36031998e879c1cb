#include "solver/bench/pair_sweeps.hpp"

#include "solver/bench/pair_operations.hpp"
#include "solver/bench/port_bound.hpp"
#include "solver/kernels/quintic_spline.hpp"
#include "solver/loop/neighbourhood.hpp"
#include "solver/loop/pair_count.hpp"
#include "solver/loop/pass_rows.hpp"
#include "solver/loop/sweep.hpp"
#include "solver/output/phase_clock.hpp"
#include "solver/particles/arrangement.hpp"
#include "solver/particles/run_error.hpp"
#include "solver/terms/advection_tensor.hpp"
#include "solver/terms/background_pressure.hpp"
#include "solver/terms/density_diffusion.hpp"
#include "solver/terms/gradient_correction.hpp"
#include "solver/terms/pressure_force.hpp"
#include "solver/terms/viscous_force.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <type_traits>

namespace slurry {

namespace {

using Kernel = QuinticSpline;
using DensityRate = Composition<CorrectedContinuity, DensityDiffusion>;
using Forces = Composition<PressureForce, ViscousForce, BackgroundPressure, AdvectionTensor>;

// Another number of threads than one would time the machine's memory too.
class OneThread {
  public:
    OneThread() { omp_set_num_threads(1); }
    ~OneThread() { omp_set_num_threads(before_); }
    OneThread(const OneThread&) = delete;
    OneThread& operator=(const OneThread&) = delete;

  private:
    int before_ = omp_get_max_threads();
};

Scene periodic_box(int side) {
    Scene scene;
    scene.domain = {{0, 0}, {1, 1}, {true, true}};
    scene.fluid = {1000, 1, Vector::Zero()};
    scene.numerics.particle_spacing = 1.0 / side;
    scene.numerics.sound_speed = 10;
    scene.start.arrangement = Arrangement::jittered;
    scene.start.velocity = InitialVelocity::taylor_green;
    scene.start.speed = 1;
    return scene;
}

template <class Real> class SweepTimer {
  public:
    // `side`: particles along a side; its square is a multiple of the lanes, or the last block would be
    // counted with pairs of padding.
    SweepTimer(int side, const FmaPeak& peak, int repetitions)
        : scene_(periodic_box(side)), particles_(arrange_particles(scene_, Region(scene_))),
          neighbourhood_(scene_, Kernel::support, Kernel::support, W, sizeof(Row<Real>)),
          rows_(scene_, neighbourhood_.periodic()), peak_(peak), repetitions_(repetitions) {
        neighbourhood_.refresh(particles_);
        rows_.fill_rate(particles_);
        evaluated_ = static_cast<double>(neighbourhood_.of_fluid().evaluated());
        useful_ = static_cast<double>(count_pairs<Real, W, Kernel, RateView>(
            neighbourhood_.of_fluid(), rows_.rows().data(), particles_.fluid.size()));
    }

    PairSweepTime time_density_rate() {
        rows_.fill_rate(particles_);
        return time<RateView, Rate>("density rate", DensityRate{}, RateCoefficients<Real>{1, 1, 0, 0});
    }

    PairSweepTime time_forces() {
        rows_.fill_full_step(particles_);
        rows_.fill_force_dummies(particles_);
        return time<ForceView, Acceleration>("forces", Forces{}, ForceCoefficients<Real>{1, 1, 1});
    }

  private:
    static constexpr int W = native_lanes<Real>;
    using P = Pack<Real, W>;

    // The one place that knows how a sweep is called.
    template <template <class> class View, class Terms, class Coefficients, template <class> class Result>
    void run_sweep(Terms terms, const Coefficients& coefficients, std::vector<Result<P>>& results) const {
        sweep<Real, W, Kernel, View, Result>(
            terms, neighbourhood_.of_fluid(), rows_.rows(), coefficients,
            [&](std::size_t first, const Result<P>& result) { results[first / W] = result; });
    }

    template <template <class> class View, template <class> class Result, class Terms, class Coefficients>
    PairSweepTime time(const char* name, Terms terms, const Coefficients& coefficients) const {
        std::vector<Result<P>> results(neighbourhood_.of_fluid().block_count());
        double seconds = std::numeric_limits<double>::infinity();
        for (int repetition = 0; repetition < repetitions_; ++repetition) {
            const double start = steady_seconds();
            run_sweep<View>(terms, coefficients, results);
            seconds = std::min(seconds, steady_seconds() - start);
        }
        using Numbers = std::array<Real, sizeof(Result<P>) / sizeof(Real)>;
        for (const Result<P>& result : results) {
            const auto numbers = std::bit_cast<Numbers>(result);
            if (!std::all_of(numbers.begin(), numbers.end(), [](Real x) { return std::isfinite(x); })) {
                throw RunError(fmt::format("bench: the sweep '{}' gave a number that is not finite", name));
            }
        }
        return rate(name, count_pair_operations<Kernel, View>(terms), seconds);
    }

    [[nodiscard]] PairSweepTime rate(const char* name, const OperationCounts& operations,
                                     double seconds) const {
        const auto particles = static_cast<double>(particles_.fluid.size());
        const double gflops = useful_ * operations.flops() / seconds * 1e-9;
        // The peak's loop keeps both arithmetic ports busy, so it is the clock, too.
        constexpr double flops_per_cycle = arithmetic_ports * W * (fuses_multiply_add ? 2 : 1);
        const double cycle = flops_per_cycle / (peak_.one_core * 1e9);
        const double bound = evaluated_ / W * port_bound_cycles<Real>(operations) * cycle;
        return {.arithmetic = std::is_same_v<Real, float> ? "float" : "double",
                .sweep = name,
                .ns_per_particle = seconds / particles * 1e9,
                .pairs_useful = useful_ / particles,
                .pairs_evaluated = evaluated_ / particles,
                .flops_per_pair = operations.flops(),
                .useful_gflops = gflops,
                .share_of_fma_peak = gflops / peak_.one_core,
                .share_of_port_bound = bound / seconds};
    }

    OneThread one_thread_;
    Scene scene_;
    Particles particles_;
    Neighbourhood neighbourhood_;
    PassRows<Real> rows_;
    FmaPeak peak_;
    int repetitions_;
    double evaluated_ = 0, useful_ = 0; // pairs of all particles
};

} // namespace

template <class Real> std::vector<PairSweepTime> time_pair_sweeps(const FmaPeak& peak, bool quick) {
    SweepTimer<Real> timer(quick ? 48 : 200, peak, quick ? 3 : 100);
    return {timer.time_density_rate(), timer.time_forces()};
}

template std::vector<PairSweepTime> time_pair_sweeps<float>(const FmaPeak& peak, bool quick);
template std::vector<PairSweepTime> time_pair_sweeps<double>(const FmaPeak& peak, bool quick);

} // namespace slurry
