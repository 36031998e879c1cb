#include "solver/probes/local_fit.hpp"

#include <Eigen/QR>

namespace slurry {

namespace {

// Gains at walls: up to 2.5 with particles displaced by half a spacing, 3.6 for a cubic in the corner of a
// box, from 5 for a parabola where particles are missing, and 1e13 for rows too few for the degree.
constexpr double largest_gain = 4;
// In particle spacings. A wall that cuts a lattice has a particle within 1.2 of each of its points, also of a
// disordered one within 2; without it a slope would be held by the wall alone.
constexpr double farthest_nearest_sample = 2;

// Columns 1; x, y; x^2, x y, y^2; ...: each from one of the order before.
Eigen::MatrixXd polynomial_terms(const LocalSamples& samples, int degree) {
    Eigen::MatrixXd terms(samples.along.size(), (degree + 1) * (degree + 2) / 2);
    terms.col(0).setOnes();
    Eigen::Index column = 1;
    for (int order = 1; order <= degree; ++order) {
        for (int power = 0; power < order; ++power) {
            terms.col(column) = terms.col(column - order).array() * samples.along;
            ++column;
        }
        terms.col(column) = terms.col(column - order - 1).array() * samples.across;
        ++column;
    }
    return terms;
}

// With A = diag(w) terms = Q R P^T, the first coefficient of the fit is e0^T P R^-1 Q^T diag(w) f.
std::optional<Stencil> first_coefficient(const Eigen::MatrixXd& terms, const LocalSamples& samples,
                                         double weight_width) {
    const Eigen::Index unknowns = terms.cols();
    if (terms.rows() < unknowns || samples.distance.minCoeff() > farthest_nearest_sample) {
        return std::nullopt;
    }
    const Eigen::ArrayXd root_weights = (-0.5 * (samples.distance / weight_width).square()).exp();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(root_weights.matrix().asDiagonal() * terms);
    if (factors.rank() < unknowns) {
        return std::nullopt;
    }
    Eigen::VectorXd row = Eigen::VectorXd::Zero(terms.rows());
    row.head(unknowns) = factors.colsPermutation().transpose() * Eigen::VectorXd::Unit(unknowns, 0);
    factors.matrixR()
        .topLeftCorner(unknowns, unknowns)
        .triangularView<Eigen::Upper>()
        .transpose()
        .solveInPlace(row.head(unknowns));
    Stencil stencil = factors.householderQ() * row;
    stencil.array() *= root_weights;
    if (!(stencil.norm() <= largest_gain)) {
        return std::nullopt;
    }
    return stencil;
}

} // namespace

std::optional<Stencil> value_stencil(const LocalSamples& samples, int degree, double weight_width) {
    return first_coefficient(polynomial_terms(samples, degree), samples, weight_width);
}

std::optional<Stencil> slope_stencil(const LocalSamples& samples, int degree, double weight_width) {
    const Eigen::MatrixXd terms =
        samples.across.matrix().asDiagonal() * polynomial_terms(samples, degree - 1);
    return first_coefficient(terms, samples, weight_width);
}

} // namespace slurry
