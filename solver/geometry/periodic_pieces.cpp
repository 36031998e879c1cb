#include "solver/geometry/periodic_pieces.hpp"

#include "solver/geometry/numerical.hpp"

#include <array>
#include <optional>

namespace slurry {
namespace {

// The two parts of a piece, left and right of x; a part may be missing.
std::array<std::optional<Piece>, 2> split(const Piece& piece, double x, double slack, double rounding) {
    const auto beyond = [&](double parameter) { return piece.at(parameter).position.x() - x; };
    if (beyond(piece.nodes.back()) <= slack)
        return {piece, std::nullopt};
    if (beyond(piece.nodes.front()) >= -slack)
        return {std::nullopt, piece};
    const double cut = find_root(beyond, piece.nodes.front(), piece.nodes.back());
    const double tiny = rounding * (piece.nodes.back() - piece.nodes.front());
    Piece left{piece.at, {}};
    Piece right{piece.at, {cut}};
    for (const double node : piece.nodes) {
        if (node < cut - tiny)
            left.nodes.push_back(node);
        if (node > cut + tiny)
            right.nodes.push_back(node);
    }
    left.nodes.push_back(cut);
    return {left, right};
}

Piece shifted(const Piece& piece, double shift) {
    return {[at = piece.at, shift](double parameter) {
                Jet jet = at(parameter);
                jet.position.x() += shift;
                return jet;
            },
            piece.nodes};
}

} // namespace

Pieces from_the_left(const Pieces& pieces, const Domain& domain, double rounding) {
    const double width = domain.size().x();
    const double start = pieces.front().at(pieces.front().nodes.front()).position.x();
    const double slack = rounding * width;
    const bool starts_left = start < domain.lower.x();
    const double cut = starts_left ? domain.lower.x() : domain.upper.x();
    Pieces left;
    Pieces right;
    for (const Piece& piece : pieces) {
        const auto parts = split(piece, cut, slack, rounding);
        if (parts[0])
            left.push_back(starts_left ? shifted(*parts[0], width) : *parts[0]);
        if (parts[1])
            right.push_back(starts_left ? *parts[1] : shifted(*parts[1], -width));
    }
    right.insert(right.end(), left.begin(), left.end());
    return right;
}

} // namespace slurry
