#include "solver/geometry/shapes.hpp"

#include "solver/geometry/geometry_error.hpp"
#include "solver/geometry/numerical.hpp"
#include "solver/geometry/periodic_pieces.hpp"
#include "solver/geometry/random_profile.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <numbers>

namespace slurry {
namespace {

using std::numbers::pi;

constexpr double rounding = 1e-9; // relative; lengths of a scene that should be equal may differ by this

[[noreturn]] void refuse(const WallScene& wall, const std::string& reason) {
    throw GeometryError(fmt::format("wall '{}': {}", wall.name, reason));
}

void require_positive(const WallScene& wall, const char* key, double value) {
    if (!(value > 0))
        refuse(wall, fmt::format("{} is {:g}, but has to be positive", key, value));
}

// The stretch of x in which a graph is set up: the domain's, or for a feature one period centred on the
// feature's nearest image, so that the periodic cut is as far from the feature as it can be.
struct Window {
    double lower, upper, centre;

    [[nodiscard]] double width() const { return upper - lower; }
};

Window centred_window(const Domain& domain, double centre) {
    const double lower = domain.lower.x();
    const double width = domain.size().x();
    if (!domain.periodic[0])
        return {lower, domain.upper.x(), centre};
    const double image = centre - width * std::floor((centre - lower) / width);
    return {image - width / 2, image + width / 2, image};
}

std::vector<double> even_nodes(double lower, double upper, double largest_step) {
    const int steps =
        std::max(1, static_cast<int>(std::ceil((upper - lower) / largest_step * (1 - rounding))));
    std::vector<double> nodes;
    for (int i = 0; i <= steps; ++i)
        nodes.push_back(i == steps ? upper : lower + (upper - lower) * i / steps);
    return nodes;
}

Piece straight(const Vector& from, const Vector& to) {
    const Vector along = to - from;
    return {[from, along](double u) { return Jet{from + u * along, along, Vector::Zero()}; }, {0, 1}};
}

// base + amplitude cos(wavenumber (x - origin))
Piece wave(double base, double amplitude, double wavenumber, double origin, double lower, double upper) {
    return {
        [=](double x) {
            const double phase = wavenumber * (x - origin);
            const double cosine = amplitude * std::cos(phase);
            const double sine = amplitude * std::sin(phase);
            return Jet{{x, base + cosine}, {1, -wavenumber * sine}, {0, -wavenumber * wavenumber * cosine}};
        },
        even_nodes(lower, upper, pi / (4 * wavenumber))};
}

Pieces pieces_of(const CosineShape& shape, const WallScene& wall, const Domain& domain) {
    require_positive(wall, "wavelength", shape.wavelength);
    const double waves = domain.size().x() / shape.wavelength;
    if (domain.periodic[0] && !(std::abs(waves - std::round(waves)) <= rounding * waves))
        refuse(wall,
               fmt::format(
                   "the periodic domain is {:g} m wide, {:g} wavelengths of {:g} m; it has to be a whole "
                   "number of them",
                   domain.size().x(), waves, shape.wavelength));
    return {wave(shape.mean_height, shape.amplitude, 2 * pi / shape.wavelength, shape.crest, domain.lower.x(),
                 domain.upper.x())};
}

Pieces pieces_of(const GaussianShape& shape, const WallScene& wall, const Domain& domain) {
    require_positive(wall, "width", shape.width);
    const Window window = centred_window(domain, shape.centre);
    std::vector<double> nodes{window.lower};
    for (double sigmas = -8; sigmas <= 8; sigmas += 0.5) { // exp(-32) is beyond anything a particle feels
        const double x = window.centre + sigmas * shape.width;
        if (x > nodes.back() + rounding * window.width() && x < window.upper - rounding * window.width())
            nodes.push_back(x);
    }
    nodes.push_back(window.upper);
    const auto graph = [shape, centre = window.centre](double x) {
        const double scaled = (x - centre) / shape.width;
        const double bump = shape.amplitude * std::exp(-scaled * scaled / 2);
        return Jet{{x, shape.base_height + bump},
                   {1, -bump * scaled / shape.width},
                   {0, bump * (scaled * scaled - 1) / (shape.width * shape.width)}};
    };
    return {{graph, nodes}};
}

// A feature between two flats of the same height.
Pieces on_a_line(const WallScene& wall, const Window& window, double half_length, double height,
                 Piece feature) {
    const double from = window.centre - half_length;
    const double to = window.centre + half_length;
    const double slack = rounding * window.width();
    if (from < window.lower - slack || to > window.upper + slack)
        refuse(wall,
               fmt::format("the feature reaches from x = {:g} to {:g} m, but the domain from {:g} to {:g} m",
                           from, to, window.lower, window.upper));
    Pieces pieces;
    if (from > window.lower + slack)
        pieces.push_back(straight({window.lower, height}, {from, height}));
    pieces.push_back(std::move(feature));
    if (to < window.upper - slack)
        pieces.push_back(straight({to, height}, {window.upper, height}));
    return pieces;
}

Pieces pieces_of(const ArcShape& shape, const WallScene& wall, const Domain& domain) {
    require_positive(wall, "radius", shape.radius);
    if (!(shape.angle > 0 && shape.angle <= pi))
        refuse(wall, fmt::format("angle is {:g}, but has to be above 0 and at most pi", shape.angle));
    const Window window = centred_window(domain, shape.centre);
    const double side = shape.upward ? 1 : -1;
    const Vector centre{window.centre, shape.base_height - side * shape.radius * std::cos(shape.angle / 2)};
    const auto arc = [centre, side, radius = shape.radius](double angle) { // clockwise from the crest
        const Vector spoke{radius * std::sin(angle), side * radius * std::cos(angle)};
        return Jet{centre + spoke, {side * spoke.y(), -side * spoke.x()}, -spoke};
    };
    return on_a_line(wall, window, shape.radius * std::sin(shape.angle / 2), shape.base_height,
                     {arc, even_nodes(-shape.angle / 2, shape.angle / 2, pi / 8)});
}

Pieces pieces_of(const SineShape& shape, const WallScene& wall, const Domain& domain) {
    require_positive(wall, "length", shape.length);
    const Window window = centred_window(domain, shape.centre);
    const double wavenumber = 2 * pi / shape.length;
    const double half = shape.length / 2;
    return on_a_line(wall, window, half, shape.base_height,
                     wave(shape.base_height, shape.amplitude, wavenumber, window.centre + shape.length / 4,
                          window.centre - half, window.centre + half));
}

// A profile that covers a thousand domains with hardly a point in this one is of another unit.
void require_points_in(const WallScene& wall, const std::vector<double>& x, const Domain& domain) {
    constexpr double most_domains = 1e3;
    constexpr std::ptrdiff_t fewest_points = 3;
    const double width = domain.size().x();
    const double slack = rounding * width;
    const double ratio = (x.back() - x.front()) / width;
    const auto inside = std::ranges::count_if(
        x, [&](double knot) { return knot >= domain.lower.x() - slack && knot <= domain.upper.x() + slack; });
    if (ratio > most_domains && inside < fewest_points)
        refuse(wall, fmt::format(
                         "the profile covers x = {:g} to {:g} m, {:.3g} times the domain's width of {:g} m, "
                         "and has {} of its points in the domain, but needs {} or more: is it in um? The "
                         "file has to be in m",
                         x.front(), x.back(), ratio, width, inside, fewest_points));
}

Pieces pieces_of(const ProfileShape& shape, const WallScene& wall, const Domain& domain) {
    const double lower = domain.lower.x();
    const double upper = domain.upper.x();
    const double slack = rounding * (upper - lower);
    std::vector<double> x;
    std::vector<double> y;
    for (const Vector& point : shape.points) {
        if (!point.allFinite())
            refuse(wall, fmt::format("row {} of the profile is not finite", x.size() + 1));
        if (!x.empty() && !(point.x() > x.back()))
            refuse(wall, fmt::format("x does not increase at row {} of the profile", x.size() + 1));
        x.push_back(point.x());
        y.push_back(point.y() + shape.base_height);
    }
    if (x.size() < 3)
        refuse(wall, fmt::format("the profile has {} points, but needs 3 or more", x.size()));
    if (x.front() > lower + slack || x.back() < upper - slack)
        refuse(wall, fmt::format(
                         "the profile covers x = {:g} to {:g} m, but the domain reaches from {:g} to {:g} m",
                         x.front(), x.back(), lower, upper));
    require_points_in(wall, x, domain);
    const bool spans = std::abs(x.front() - lower) <= slack && std::abs(x.back() - upper) <= slack;
    const bool meets = std::abs(y.front() - y.back()) <= slack;
    Spline::Kind kind = Spline::Kind::steffen;
    if (domain.periodic[0] && spans && meets) {
        kind = Spline::Kind::periodic_cubic;
        y.back() = y.front();
    }
    const Spline spline(kind, x, y);
    std::vector<double> nodes{lower};
    for (const double knot : x)
        if (knot > lower + slack && knot < upper - slack)
            nodes.push_back(knot);
    nodes.push_back(upper);
    return {{[spline](double at) {
                 const auto [value, first, second] = spline.at(at);
                 return Jet{{at, value}, {1, first}, {0, second}};
             },
             nodes}};
}

Pieces pieces_of(const RandomShape& shape, const WallScene& wall, const Domain& domain) {
    constexpr double most_correlation_lengths = 200; // more would be slow to evaluate
    const double width = domain.size().x();
    require_positive(wall, "rms_height", shape.rms_height);
    require_positive(wall, "correlation_length", shape.correlation_length);
    if (shape.correlation_length * most_correlation_lengths < width)
        refuse(wall,
               fmt::format("correlation_length is {:g} m, but has to be at least 1 / {:g} of the domain's "
                           "width, {:g} m",
                           shape.correlation_length, most_correlation_lengths,
                           width / most_correlation_lengths));
    const double lower = domain.lower.x();
    const auto graph = [lower, mean = shape.mean_height, waves = harmonics(shape, width)](double x) {
        Jet jet{{x, mean}, {1, 0}, {0, 0}};
        for (const Harmonic& wave : waves) {
            const double phase = wave.wavenumber * (x - lower) + wave.phase;
            const double cosine = wave.amplitude * std::cos(phase);
            jet.position.y() += cosine;
            jet.first.y() -= wave.wavenumber * wave.amplitude * std::sin(phase);
            jet.second.y() -= wave.wavenumber * wave.wavenumber * cosine;
        }
        return jet;
    };
    return {{graph, even_nodes(lower, domain.upper.x(), std::min(shape.correlation_length, width) / 4)}};
}

Curve make_line(const LineShape& shape, const WallScene& wall, const Domain& domain) {
    Vector along = shape.to - shape.from;
    if (!(along.norm() > 0))
        refuse(wall, "from and to are the same point");
    Vector from = shape.from;
    const bool vertical = std::abs(along.x()) < 1e-12 * along.norm();
    if (vertical ? along.y() < 0 : along.x() < 0) {
        from = shape.to;
        along = -along;
    }
    const bool sideways = wall.fluid_side == FluidSide::left || wall.fluid_side == FluidSide::right;
    if (vertical != sideways)
        refuse(wall,
               vertical
                   ? "fluid_side of a vertical line has to be 'left' or 'right'"
                   : "fluid_side has to be 'above' or 'below' ('left' and 'right' are for vertical lines)");
    if (!domain.periodic[0] && !domain.periodic[1])
        return {{straight(from, from + along)}, Vector::Zero()};
    const Eigen::Index axis = vertical ? 1 : 0;
    Vector period = Vector::Zero();
    period[axis] = domain.size()[axis];
    if (!domain.periodic[vertical ? 1 : 0] || !((along - period).norm() <= rounding * period.norm()))
        refuse(wall,
               "in a periodic domain a line has to lead along a periodic axis, across the whole domain");
    from[axis] = domain.lower[axis];
    return {{straight(from, from + period)}, period};
}

template <class Graph> Curve make_graph(const Graph& shape, const WallScene& wall, const Domain& domain) {
    if (wall.fluid_side != FluidSide::above && wall.fluid_side != FluidSide::below)
        refuse(wall, "fluid_side has to be 'above' or 'below' ('left' and 'right' are for vertical lines)");
    Pieces pieces = pieces_of(shape, wall, domain);
    if (!domain.periodic[0])
        return {pieces, Vector::Zero()};
    const Vector first = pieces.front().at(pieces.front().nodes.front()).position;
    const Vector last = pieces.back().at(pieces.back().nodes.back()).position;
    if (!first.allFinite() || !last.allFinite())
        refuse(wall, "its shape is not finite");
    if (!(std::abs(first.y() - last.y()) <= 1e-6 * domain.size().x()))
        refuse(wall,
               fmt::format("its heights at the two periodic sides, {:g} and {:g} m, have to be the same",
                           first.y(), last.y()));
    return {from_the_left(pieces, domain, rounding), {domain.size().x(), 0}};
}

} // namespace

Curve make_curve(const WallScene& wall, const Domain& domain) {
    if (!(domain.size().minCoeff() > 0))
        throw GeometryError("domain: upper has to be above lower on both axes");
    return std::visit(
        [&](const auto& shape) {
            if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, LineShape>)
                return make_line(shape, wall, domain);
            else
                return make_graph(shape, wall, domain);
        },
        wall.shape);
}

} // namespace slurry
