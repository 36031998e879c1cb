#pragma once
// A piecewise smooth plane curve that knows its nearest points and its arc length.
#include "solver/vector.hpp"

#include <functional>
#include <span>
#include <vector>

namespace slurry {

// A point of a curve and its first and second derivatives by the parameter.
struct Jet {
    Vector position;
    Vector first;
    Vector second;
};

// A smooth part of a curve: a function of a parameter, and parameters from the part's start to its end that
// are no farther apart than its features. x (y on a vertical line) never decreases along it.
struct Piece {
    std::function<Jet(double)> at;
    std::vector<double> nodes;
};

// A stretch of a piece so short that its tangent hardly turns (by less than 0.1), so it has one nearest
// point.
struct Leaf {
    std::size_t piece;
    double start, end; // parameters
    Jet first, last;
    double arc_start; // m, from the first point of the curve
    double length;    // m
};

// The nearest point. At a kink the unit tangents of its two sides differ.
struct Foot {
    Vector position;
    Vector before, after;
    double curvature; // 1/m, positive where the curve bends to the left of its tangent
    double arc_length;
    int end; // -1: first point of an open curve, +1: its last, 0: neither
};

struct CurvePoint {
    Vector position;
    Vector tangent; // unit
    double curvature;
    double arc_length;
};

class Curve {
  public:
    // Pieces joined end to end. `period` leads from the first point to its image, the last; zero for an open
    // curve.
    Curve(std::vector<Piece> pieces, Vector period);

    // Global minimum of the distance, periodic images of the curve included.
    [[nodiscard]] Foot nearest(const Vector& point) const;
    // The point at an arc length in [0, length()].
    [[nodiscard]] CurvePoint at(double arc_length) const;
    [[nodiscard]] double length() const { return length_; }
    [[nodiscard]] bool closed() const { return period_.squaredNorm() > 0; }
    [[nodiscard]] const Vector& period() const { return period_; }
    // The whole number of periods from the curve's first period to the one that the point is in.
    [[nodiscard]] double periods(const Vector& point) const;
    [[nodiscard]] const Vector& first_point() const { return leaves_.front().first.position; }
    [[nodiscard]] const Vector& last_point() const { return leaves_.back().last.position; }

    [[nodiscard]] bool vertical() const;
    // y(x), an open curve prolonged along its end tangents; not for vertical lines.
    [[nodiscard]] double height(double x) const;

    [[nodiscard]] std::span<const Leaf> leaves() const { return leaves_; }
    [[nodiscard]] Jet jet(const Leaf& leaf, double parameter) const {
        return pieces_[leaf.piece].at(parameter);
    }
    // Length of the curve between two parameters of a leaf, m.
    [[nodiscard]] double arc_between(const Leaf& leaf, double from, double to) const;

  private:
    // All points of the leaves [begin, end) are within `slack` of the chord from a to b.
    struct Node {
        Vector a, b;
        double slack;
        std::size_t begin, end;  // leaves
        std::size_t left, right; // children; 0 for a node of one leaf
    };
    struct Nearest {
        double distance;
        std::size_t leaf;
        double parameter;
        Jet jet;
        Vector shift; // of the image that the point was compared with
    };

    void subdivide(std::size_t piece, double start, double end, int depth);
    std::size_t add_node(std::size_t begin, std::size_t end);
    void search(std::size_t node, const Vector& point, const Vector& shift, Nearest& best) const;
    void search_leaf(std::size_t index, const Vector& point, const Vector& shift, Nearest& best) const;
    [[nodiscard]] double root_in_leaf(const Leaf& leaf, const Vector& point, double at_start,
                                      double at_end) const;
    [[nodiscard]] double lower_bound(const Node& node, const Vector& point) const;
    [[nodiscard]] Foot foot(const Nearest& nearest) const;

    std::vector<Piece> pieces_;
    Vector period_;
    double length_ = 0;
    std::vector<Leaf> leaves_;
    std::vector<Node> nodes_; // a strip tree (Ballard 1981); the root is the first
};

// The angle from one vector to another, anticlockwise positive, in (-pi, pi].
double angle_between(const Vector& from, const Vector& to);

} // namespace slurry
