#pragma once
// Repulsion that keeps discs from each other and from walls (Sec. 2.5.2, Eqs. 2.27 and 2.28) [wang2014,
// glowinski2001].
#include "solver/geometry/region.hpp"
#include "solver/particles/particles.hpp"

#include <limits>
#include <span>
#include <vector>

namespace slurry {

class DiscContacts {
  public:
    // The region must outlive this.
    DiscContacts(const Scene& scene, const Region& region);

    // Contact forces of all discs where they are now. Throws RunError when two rims, or a rim and a wall,
    // overlap by more than half a particle spacing.
    void compute(Particles& particles);

    // Of the stiffest contact that these discs can have, rad/s.
    [[nodiscard]] double highest_frequency(std::span<const Disc> discs) const;

    // Between rims, or a rim and a wall, of all calls so far, m: infinite until two are near, negative for an
    // overlap.
    [[nodiscard]] double least_gap() const { return least_gap_; }
    // Goes on from what an earlier run of the same scene found.
    void restore(double least_gap, double first_contact_time) {
        least_gap_ = least_gap;
        first_contact_time_ = first_contact_time;
    }
    // When two discs first repelled each other, s; negative if none did.
    [[nodiscard]] double first_contact_time() const { return first_contact_time_; }

  private:
    [[nodiscard]] double touch_force(const Disc& a, const Disc& b) const;
    [[nodiscard]] double touch_force_at_wall(const Disc& disc) const;
    void repel(Particles& particles, std::size_t a, std::size_t b, const Vector& a_to_b);
    void repel_from_wall(Particles& particles, std::size_t a, const Wall& wall);
    void note_gap(const Particles& particles, std::size_t disc, double gap, const std::string& other);

    Domain domain_;
    const Region& region_;
    Contact contact_;
    double stopped_speed_, largest_overlap_; // m/s, m
    double least_gap_ = std::numeric_limits<double>::infinity();
    double first_contact_time_ = -1;
};

} // namespace slurry
