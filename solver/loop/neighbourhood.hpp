#pragma once
// Who is near whom: the neighbour lists of the fluid and of the walls' dummies, and when to make them anew.
#include "solver/loop/displacement_watch.hpp"
#include "solver/loop/interactions.hpp"
#include "solver/loop/neighbour_list.hpp"
#include "solver/loop/periodic_rows.hpp"

namespace slurry {

class Neighbourhood {
  public:
    // Lists for a kernel that reaches `support` smoothing lengths, wall sums that reach `wall_support`, and a
    // pair loop of `width` lanes over rows of `row_bytes`.
    Neighbourhood(const Scene& scene, double support, double wall_support, int width, std::size_t row_bytes);

    // Brings the lists up to date; wraps and sorts the particles when it makes them anew. Throws RunError
    // when a particle has left its neighbours behind: by more than a smoothing length since the last call.
    void refresh(Particles& particles);

    // See Interactions. Wrapping and sorting are not repeated: particles sit beside a side by rounding.
    [[nodiscard]] ListOrigin origin() const;
    void restore(const Particles& particles, const ListOrigin& origin);

    [[nodiscard]] const PeriodicRows& periodic() const { return periodic_; }
    [[nodiscard]] const NeighbourList& of_fluid() const { return fluid_list_; }
    [[nodiscard]] const NeighbourList& of_dummies() const { return dummy_list_; }
    // The fluid near the particles of discs.
    [[nodiscard]] const NeighbourList& of_discs() const { return disc_list_; }
    // All but the useful pairs.
    [[nodiscard]] ListStatistics statistics() const;

  private:
    void refuse_flight(const Particles& particles, double displacement) const;
    [[nodiscard]] double reach() const;
    [[nodiscard]] double reach_beyond_sides(const DummyParticles& dummies) const;
    [[nodiscard]] Vector cell() const;
    void make_lists(const Particles& particles);
    void build_dummy_list(const DummyParticles& dummies);

    Domain domain_;
    bool walls_, wall_points_; // wall_points_: dummies look for fluid around their wall points
    double spacing_, skin_, longest_way_, support_, wall_support_; // m
    PeriodicRows periodic_;
    DisplacementWatch watch_;
    NeighbourList fluid_list_, dummy_list_, disc_list_;
    std::vector<double> normal_x_, normal_y_; // of the dummies when the lists were made
    double list_time_ = 0;                    // s, likewise
    long rebuilds_ = 0;
};

} // namespace slurry
