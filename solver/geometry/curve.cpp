#include "solver/geometry/curve.hpp"

#include "solver/geometry/numerical.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slurry {
namespace {

constexpr double leaf_turn = 0.05; // rad
constexpr int deepest_subdivision = 16;

double distance_to_segment(const Vector& point, const Vector& a, const Vector& b) {
    const Vector chord = b - a;
    const double squared = chord.squaredNorm();
    const double along = squared > 0 ? std::clamp((point - a).dot(chord) / squared, 0.0, 1.0) : 0.0;
    return (point - a - along * chord).norm();
}

// Largest turn of the tangent seen in a few steps along a stretch of a piece.
double turn(const Piece& piece, double start, double end) {
    const Vector from = piece.at(start).first;
    double largest = 0;
    for (int i = 1; i <= 4; ++i)
        largest =
            std::max(largest, std::abs(angle_between(from, piece.at(start + (end - start) * i / 4).first)));
    return largest;
}

double curvature(const Jet& jet) {
    const double squared = jet.first.squaredNorm();
    return left_of(jet.first).dot(jet.second) / (squared * std::sqrt(squared));
}

} // namespace

double angle_between(const Vector& from, const Vector& to) {
    return std::atan2(left_of(from).dot(to), from.dot(to));
}

Curve::Curve(std::vector<Piece> pieces, Vector period)
    : pieces_(std::move(pieces)), period_(std::move(period)) {
    for (std::size_t piece = 0; piece < pieces_.size(); ++piece)
        for (std::size_t i = 1; i < pieces_[piece].nodes.size(); ++i)
            subdivide(piece, pieces_[piece].nodes[i - 1], pieces_[piece].nodes[i], 0);
    nodes_.reserve(2 * leaves_.size());
    add_node(0, leaves_.size());
}

void Curve::subdivide(std::size_t piece, double start, double end, int depth) {
    if (depth < deepest_subdivision && turn(pieces_[piece], start, end) > leaf_turn) {
        const double middle = (start + end) / 2;
        subdivide(piece, start, middle, depth + 1);
        subdivide(piece, middle, end, depth + 1);
        return;
    }
    Leaf leaf{piece, start, end, pieces_[piece].at(start), pieces_[piece].at(end), length_, 0};
    leaf.length = arc_between(leaf, start, end);
    length_ += leaf.length;
    leaves_.push_back(leaf);
}

std::size_t Curve::add_node(std::size_t begin, std::size_t end) {
    const std::size_t index = nodes_.size();
    Node node{leaves_[begin].first.position, leaves_[end - 1].last.position, 0, begin, end, 0, 0};
    for (std::size_t i = begin; i < end; ++i) {
        const Leaf& leaf = leaves_[i];
        // A curve that turns by less than an angle stays within (chord / 2) tan(angle); the turn was sampled,
        // so twice it.
        const double sagitta =
            leaf.length * std::tan(std::min(1.0, turn(pieces_[leaf.piece], leaf.start, leaf.end)));
        node.slack = std::max({node.slack, sagitta + distance_to_segment(leaf.first.position, node.a, node.b),
                               sagitta + distance_to_segment(leaf.last.position, node.a, node.b)});
    }
    nodes_.push_back(node);
    if (end - begin > 1) {
        const std::size_t middle = (begin + end) / 2;
        const std::size_t left = add_node(begin, middle);
        const std::size_t right = add_node(middle, end);
        nodes_[index].left = left;
        nodes_[index].right = right;
    }
    return index;
}

double Curve::arc_between(const Leaf& leaf, double from, double to) const {
    const double half = (to - from) / 2;
    double sum = 0;
    for (const auto& [position, weight] : gauss_points())
        sum += weight * pieces_[leaf.piece].at(from + half * (1 + position)).first.norm();
    return sum * half;
}

double Curve::periods(const Vector& point) const {
    return closed() ? std::floor((point - first_point()).dot(period_) / period_.squaredNorm()) : 0.0;
}

Foot Curve::nearest(const Vector& point) const {
    const Vector home = periods(point) * period_;
    Nearest best{std::numeric_limits<double>::infinity(), 0, 0, leaves_[0].first, home};
    search(0, point - home, home, best);
    if (closed())
        for (const double image : {-1.0, 1.0})
            if (const Vector shift = home + image * period_;
                lower_bound(nodes_[0], point - shift) < best.distance)
                search(0, point - shift, shift, best);
    return foot(best);
}

double Curve::lower_bound(const Node& node, const Vector& point) const {
    return distance_to_segment(point, node.a, node.b) - node.slack;
}

void Curve::search(std::size_t index, const Vector& point, const Vector& shift, Nearest& best) const {
    const Node& node = nodes_[index];
    if (node.left == 0) {
        search_leaf(node.begin, point, shift, best);
        return;
    }
    std::size_t near = node.left;
    std::size_t far = node.right;
    double near_bound = lower_bound(nodes_[near], point);
    double far_bound = lower_bound(nodes_[far], point);
    if (far_bound < near_bound) {
        std::swap(near, far);
        std::swap(near_bound, far_bound);
    }
    if (near_bound < best.distance)
        search(near, point, shift, best);
    if (far_bound < best.distance)
        search(far, point, shift, best);
}

void Curve::search_leaf(std::size_t index, const Vector& point, const Vector& shift, Nearest& best) const {
    const Leaf& leaf = leaves_[index];
    const auto offer = [&](const Jet& here, double parameter) {
        const double distance = (point - here.position).norm();
        if (distance < best.distance)
            best = {distance, index, parameter, here, shift};
    };
    const double at_start = (leaf.first.position - point).dot(leaf.first.first);
    const double at_end = (leaf.last.position - point).dot(leaf.last.first);
    if (at_start < 0 && at_end > 0) {
        const double parameter = root_in_leaf(leaf, point, at_start, at_end);
        offer(jet(leaf, parameter), parameter);
    } else {
        offer(leaf.first, leaf.start);
        offer(leaf.last, leaf.end);
    }
}

// Newton, kept inside a shrinking bracket, on (r - p) . r' = 0.
double Curve::root_in_leaf(const Leaf& leaf, const Vector& point, double at_start, double at_end) const {
    double lower = leaf.start;
    double upper = leaf.end;
    double parameter = lower + (upper - lower) * at_start / (at_start - at_end);
    const double tolerance = 1e-8 * (upper - lower); // of the last step; Newton squares it
    for (int i = 0; i < 60; ++i) {
        const Jet here = jet(leaf, parameter);
        const Vector offset = here.position - point;
        const double value = offset.dot(here.first);
        (value < 0 ? lower : upper) = parameter;
        const double slope = here.first.squaredNorm() + offset.dot(here.second);
        double next = parameter - value / slope;
        if (!(slope > 0) || next < lower || next > upper)
            next = (lower + upper) / 2;
        const double step = std::abs(next - parameter);
        parameter = next;
        if (step <= tolerance || upper - lower <= tolerance)
            break;
    }
    return parameter;
}

Foot Curve::foot(const Nearest& nearest) const {
    const Leaf& leaf = leaves_[nearest.leaf];
    const Jet& here = nearest.jet;
    const Vector tangent = here.first.normalized();
    Foot result{here.position + nearest.shift,
                tangent,
                tangent,
                curvature(here),
                leaf.arc_start + arc_between(leaf, leaf.start, nearest.parameter),
                0};
    const std::size_t last = leaves_.size() - 1;
    if (nearest.parameter == leaf.start) {
        if (nearest.leaf == 0 && !closed())
            result.end = -1;
        else
            result.before = leaves_[nearest.leaf == 0 ? last : nearest.leaf - 1].last.first.normalized();
    } else if (nearest.parameter == leaf.end) {
        if (nearest.leaf == last && !closed())
            result.end = 1;
        else
            result.after = leaves_[nearest.leaf == last ? 0 : nearest.leaf + 1].first.first.normalized();
    }
    return result;
}

CurvePoint Curve::at(double arc_length) const {
    const double wanted = std::clamp(arc_length, 0.0, length_);
    auto leaf = std::upper_bound(leaves_.begin() + 1, leaves_.end(), wanted,
                                 [](double arc, const Leaf& other) { return arc < other.arc_start; }) -
                1;
    const double rest = wanted - leaf->arc_start;
    double parameter = leaf->start + (leaf->end - leaf->start) * rest / leaf->length;
    for (int i = 0; i < 20; ++i) { // the speed hardly varies in a leaf, so Newton needs no bracket
        const double step =
            (rest - arc_between(*leaf, leaf->start, parameter)) / jet(*leaf, parameter).first.norm();
        parameter = std::clamp(parameter + step, leaf->start, leaf->end);
        if (std::abs(step) <= 1e-14 * (leaf->end - leaf->start))
            break;
    }
    const Jet here = jet(*leaf, parameter);
    return {here.position, here.first.normalized(), curvature(here), wanted};
}

bool Curve::vertical() const {
    return std::abs(last_point().x() - first_point().x()) < 1e-12 * length_;
}

double Curve::height(double x) const {
    const double base = x - (closed() ? periods({x, 0}) * period_.x() : 0.0);
    const auto prolonged = [&](const Jet& end) {
        return end.position.y() + (base - end.position.x()) * end.first.y() / end.first.x();
    };
    if (base <= first_point().x())
        return prolonged(leaves_.front().first);
    if (base >= last_point().x())
        return prolonged(leaves_.back().last);
    const auto leaf =
        std::upper_bound(leaves_.begin() + 1, leaves_.end(), base,
                         [](double value, const Leaf& other) { return value < other.first.position.x(); }) -
        1;
    double parameter = leaf->start + (leaf->end - leaf->start) * (base - leaf->first.position.x()) /
                                         (leaf->last.position.x() - leaf->first.position.x());
    for (int i = 0; i < 30; ++i) {
        const Jet here = jet(*leaf, parameter);
        const double step = (base - here.position.x()) / here.first.x();
        if (!std::isfinite(step))
            break;
        parameter = std::clamp(parameter + step, leaf->start, leaf->end);
        if (std::abs(step) <= 1e-15 * std::abs(leaf->end - leaf->start))
            break;
    }
    return jet(*leaf, parameter).position.y();
}

} // namespace slurry
