#include "solver/loop/periodic_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace slurry {

namespace {

double wrap_shift(double position, double lower, double length) {
    return -std::floor((position - lower) / length) * length;
}

// Sorts what is nearly sorted, as a strip is that was sorted some steps ago: few numbers move, and not far.
// Gives up and sorts from scratch when they do.
template <class Key, class Less> void sort_nearly_sorted(std::span<Key> keys, Less&& less) {
    std::size_t moves = 8 * keys.size();
    for (std::size_t k = 1; k < keys.size(); ++k) {
        const Key key = keys[k];
        std::size_t hole = k;
        for (; hole > 0 && less(key, keys[hole - 1]); --hole) {
            keys[hole] = keys[hole - 1];
            if (--moves == 0) {
                keys[hole - 1] = key;
                std::sort(keys.begin(), keys.end(), less);
                return;
            }
        }
        keys[hole] = key;
    }
}

std::pair<double, double> range_without_nan(std::span<const double> values) {
    double lower = std::numeric_limits<double>::infinity();
    double upper = -lower;
    for (const double value : values) {
        lower = value < lower ? value : lower;
        upper = value > upper ? value : upper;
    }
    return {lower, upper};
}

// Order by strips of the given height, then by x.
std::vector<std::uint32_t> strip_order(std::span<const double> x, std::span<const double> y, double height) {
    struct Key {
        double x;
        std::uint32_t index;
    };
    const std::size_t count = x.size();
    if (count == 0) {
        return {};
    }
    const auto strip_of = [&](double position) { return std::floor(position / height); };
    // A position that is not a number, or absurd, is put with the last; the watchdog will find it.
    const auto [lower, upper] = range_without_nan(y);
    const double lowest = strip_of(lower);
    const double strips = std::min(static_cast<double>(count), std::max(1.0, strip_of(upper) - lowest + 1));
    std::vector<std::uint32_t> strip(count);
    std::vector<std::size_t> ends(static_cast<std::size_t>(strips) + 1, 0);
    for (std::size_t k = 0; k < count; ++k) {
        const double place = strip_of(y[k]) - lowest;
        strip[k] = static_cast<std::uint32_t>(place >= 0 && place < strips ? place : strips - 1);
        ++ends[strip[k] + 1];
    }
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    std::vector<Key> keys(count);
    for (std::size_t k = 0; k < count; ++k) { // afterwards ends[s] is where strip s ends
        keys[ends[strip[k]]++] = {x[k], static_cast<std::uint32_t>(k)};
    }
    const auto strip_count = static_cast<std::ptrdiff_t>(strips);
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t s = 0; s < strip_count; ++s) {
        const std::size_t first = s > 0 ? ends[static_cast<std::size_t>(s) - 1] : 0;
        const auto less = [](const Key& a, const Key& b) {
            return a.x != b.x ? a.x < b.x : a.index < b.index;
        };
        sort_nearly_sorted(std::span(keys).subspan(first, ends[static_cast<std::size_t>(s)] - first), less);
    }
    std::vector<std::uint32_t> order(count);
    std::transform(keys.begin(), keys.end(), order.begin(), [](const Key& key) { return key.index; });
    return order;
}

template <class T> void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
    std::vector<T> sorted(values.size());
    const auto count = static_cast<std::ptrdiff_t>(order.size());
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t k = 0; k < count; ++k) {
        sorted[static_cast<std::size_t>(k)] = values[order[static_cast<std::size_t>(k)]];
    }
    values.swap(sorted);
}

void wrap(Particles& particles, const Domain& domain) {
    FluidParticles& fluid = particles.fluid;
    DummyParticles& dummies = particles.dummies;
    const Vector length = domain.size();
    if (domain.periodic[0]) {
        for (double& x : fluid.x) {
            x += wrap_shift(x, domain.lower.x(), length.x());
        }
        for (std::size_t d = 0; d < dummies.size(); ++d) {
            const double shift = wrap_shift(dummies.x[d], domain.lower.x(), length.x());
            dummies.x[d] += shift;
            dummies.start_x[d] += shift;
        }
    }
    if (domain.periodic[1]) {
        for (double& y : fluid.y) {
            y += wrap_shift(y, domain.lower.y(), length.y());
        }
        for (std::size_t d = 0; d < dummies.size(); ++d) {
            const double shift = wrap_shift(dummies.y[d], domain.lower.y(), length.y());
            dummies.y[d] += shift;
            dummies.start_y[d] += shift;
        }
    }
}

void sort(Particles& particles, double strip_height) {
    FluidParticles& fluid = particles.fluid;
    const auto order = strip_order(fluid.x, fluid.y, strip_height);
    fluid.each_array([&](std::vector<double>& array) { reorder(array, order); });
    reorder(fluid.identity, order);
    DummyParticles& dummies = particles.dummies;
    auto dummy_order = strip_order(std::span(dummies.x).first(dummies.first_of_discs),
                                   std::span(dummies.y).first(dummies.first_of_discs), strip_height);
    for (const std::uint32_t k :
         strip_order(std::span(dummies.x).subspan(dummies.first_of_discs),
                     std::span(dummies.y).subspan(dummies.first_of_discs), strip_height)) {
        dummy_order.push_back(static_cast<std::uint32_t>(dummies.first_of_discs) + k);
    }
    dummies.each_array([&](auto& array) { reorder(array, dummy_order); });
}

} // namespace

void PeriodicRows::rebuild(Particles& particles, const Domain& domain, double strip_height, double reach) {
    wrap(particles, domain);
    sort(particles, strip_height);
    take(particles, domain, reach);
}

void PeriodicRows::take(const Particles& particles, const Domain& domain, double reach) {
    fluid_count_ = particles.fluid.size();
    particle_count_ = fluid_count_ + particles.dummies.size();
    x_ = particles.fluid.x;
    y_ = particles.fluid.y;
    x_.insert(x_.end(), particles.dummies.x.begin(), particles.dummies.x.end());
    y_.insert(y_.end(), particles.dummies.y.begin(), particles.dummies.y.end());
    add_copies(domain, reach);
}

void PeriodicRows::add_copies(const Domain& domain, double reach) {
    copies_.clear();
    const Vector length = domain.size();
    const auto copy_range = [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            for (int column = domain.periodic[0] ? -1 : 0; column <= (domain.periodic[0] ? 1 : 0); ++column) {
                for (int row = domain.periodic[1] ? -1 : 0; row <= (domain.periodic[1] ? 1 : 0); ++row) {
                    const Vector shift(column * length.x(), row * length.y());
                    const double x = x_[k] + shift.x();
                    const double y = y_[k] + shift.y();
                    const bool near_x =
                        column == 0 || (x > domain.lower.x() - reach && x < domain.upper.x() + reach);
                    const bool near_y =
                        row == 0 || (y > domain.lower.y() - reach && y < domain.upper.y() + reach);
                    if ((column != 0 || row != 0) && near_x && near_y) {
                        copies_.push_back({static_cast<std::uint32_t>(k), shift});
                    }
                }
            }
        }
    };
    copy_range(0, fluid_count_);
    fluid_copies_ = copies_.size();
    copy_range(fluid_count_, particle_count_);
    for (const Copy& copy : copies_) {
        x_.push_back(x_[copy.source] + copy.shift.x());
        y_.push_back(y_[copy.source] + copy.shift.y());
    }
}

std::vector<std::uint32_t> PeriodicRows::fluid_rows() const {
    std::vector<std::uint32_t> rows(fluid_count_ + fluid_copies_);
    std::iota(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(fluid_count_), 0U);
    std::iota(rows.begin() + static_cast<std::ptrdiff_t>(fluid_count_), rows.end(),
              static_cast<std::uint32_t>(particle_count_));
    return rows;
}

std::vector<std::uint32_t> PeriodicRows::all_rows() const {
    std::vector<std::uint32_t> rows(particle_count_ + copies_.size());
    std::iota(rows.begin(), rows.end(), 0U);
    return rows;
}

std::string PeriodicRows::farthest_moved(const Particles& particles) const {
    const FluidParticles& fluid = particles.fluid;
    std::size_t farthest = 0;
    double distance = 0;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const double moved = std::hypot(fluid.x[i] - x_[i], fluid.y[i] - y_[i]);
        if (moved > distance) {
            distance = moved;
            farthest = i;
        }
    }
    return fmt::format("particle {} at ({:.6g}, {:.6g}) m left its neighbours, by {:.3g} m",
                       fluid.identity[farthest], fluid.x[farthest], fluid.y[farthest], distance);
}

} // namespace slurry
