#pragma once
// What the time step asks of the particles' interactions; the widths and compositions behind it are chosen
// once.
#include "solver/loop/list_origin.hpp"
#include "solver/particles/particles.hpp"
#include "solver/scene/scene.hpp"

#include <memory>

namespace slurry {

// What the neighbour lists cost. Counts are those of the fluid's lists as they are now.
struct ListStatistics {
    long rebuilds = 0;         // since the start
    std::size_t pairs = 0;     // nearer than the kernel's support and the skin when the lists were made
    std::size_t evaluated = 0; // with the padding that fills the vectors' lanes
    std::size_t useful = 0;    // nearer than the kernel's support in the last pass; 0 before the first
    std::size_t bytes = 0;     // of all lists and rows
};

class Interactions {
  public:
    Interactions() = default;
    Interactions(const Interactions&) = delete;
    Interactions& operator=(const Interactions&) = delete;
    virtual ~Interactions() = default;

    // Brings the neighbour lists up to date with the positions. Wraps and sorts the particles when it
    // rebuilds them.
    virtual void refresh_neighbours(Particles& particles) = 0;
    // For resuming a run: what the lists were made from, and making them again from it. The particles have to
    // be in the order that they had.
    [[nodiscard]] virtual ListOrigin list_origin() const = 0;
    virtual void restore_lists(const Particles& particles, const ListOrigin& origin) = 0;
    // Eq. 2.14 with the scene's corrections, into fluid.density_rate.
    virtual void compute_density_rate(Particles& particles) = 0;
    // 1 / sum W (below Eq. 2.8) into fluid.number_density_volume, if the scene asks for it.
    virtual void compute_volumes(Particles& particles) = 0;
    // Eqs. 2.16 and 2.17, into the dummies' velocity and pressure. The fluid has to stay as it is until the
    // forces are computed, if they are next: both read the same rows.
    virtual void extrapolate_to_walls(Particles& particles) = 0;
    // Eqs. 2.15, 2.19 and 2.20 (without the body force), into fluid.acceleration and fluid.background; the
    // forces on the particles of discs (Eq. 2.23), into dummies.force and dummies.twist.
    virtual void compute_forces(Particles& particles) = 0;
    [[nodiscard]] virtual ListStatistics list_statistics(const Particles& particles) const = 0;
};

// As wide as the machine's vectors, or with plain numbers (the reference that the wide loops are tested
// against).
enum class LoopWidth : unsigned char { native, plain };
// Whether this build has the pair loops of a kernel: builds for the sanitizers and for counting have one
// only.
[[nodiscard]] constexpr bool is_built([[maybe_unused]] KernelShape kernel) {
#ifdef SLURRY_ONLY_KERNEL
    return kernel == KernelShape::SLURRY_ONLY_KERNEL;
#else
    return true;
#endif
}

// Sums over pairs in the scene's arithmetic and with its kernel; plain is always in double precision. Throws
// RunError when the kernel is not built.
std::unique_ptr<Interactions> make_interactions(const Scene& scene, LoopWidth width = LoopWidth::native);

} // namespace slurry
