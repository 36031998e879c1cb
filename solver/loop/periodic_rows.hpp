#pragma once
// Which rows a pass has: the fluid, the dummies, then copies of both beyond periodic sides, then one row far
// away that pads neighbour lists. With copies the pair loop needs no minimum image.
#include "solver/particles/particles.hpp"
#include "solver/scene/scene.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace slurry {

class PeriodicRows {
  public:
    struct Copy {
        std::uint32_t source;
        Vector shift;
    };

    // Wraps the particles into the domain, sorts them into strips (by y in steps of `strip_height`, counted
    // from y = 0, then by x) so that neighbours are near in memory, and finds the copies within `reach` of a
    // periodic side, m.
    void rebuild(Particles& particles, const Domain& domain, double strip_height, double reach);
    // The same for particles that are wrapped and sorted.
    void take(const Particles& particles, const Domain& domain, double reach);

    [[nodiscard]] std::size_t fluid_count() const { return fluid_count_; }
    [[nodiscard]] std::size_t particle_count() const { return particle_count_; }
    // Of the fluid, then of the dummies.
    [[nodiscard]] std::span<const Copy> copies() const { return copies_; }
    [[nodiscard]] std::span<const Copy> fluid_copies() const { return copies().first(fluid_copies_); }
    [[nodiscard]] std::span<const Copy> dummy_copies() const { return copies().subspan(fluid_copies_); }
    // Of the first of some of the copies.
    [[nodiscard]] std::size_t row_of(std::span<const Copy> some) const {
        return particle_count_ + static_cast<std::size_t>(some.data() - copies_.data());
    }
    [[nodiscard]] std::size_t row_count() const { return particle_count_ + copies_.size() + 1; }
    [[nodiscard]] std::uint32_t padding() const { return static_cast<std::uint32_t>(row_count() - 1); }

    // Positions of all rows but the padding, as of the last rebuild.
    [[nodiscard]] std::span<const double> x() const { return x_; }
    [[nodiscard]] std::span<const double> y() const { return y_; }
    // Rows that are fluid or copies of fluid; all rows (padding excepted).
    [[nodiscard]] std::vector<std::uint32_t> fluid_rows() const;
    [[nodiscard]] std::vector<std::uint32_t> all_rows() const;

    [[nodiscard]] std::size_t bytes() const {
        return copies_.capacity() * sizeof(Copy) + (x_.capacity() + y_.capacity()) * sizeof(double);
    }

    // Names the fluid particle that has moved farthest since the rebuild, for messages.
    [[nodiscard]] std::string farthest_moved(const Particles& particles) const;

  private:
    void add_copies(const Domain& domain, double reach);

    std::size_t fluid_count_ = 0;
    std::size_t particle_count_ = 0;
    std::size_t fluid_copies_ = 0;
    std::vector<Copy> copies_;
    std::vector<double> x_, y_;
};

} // namespace slurry
