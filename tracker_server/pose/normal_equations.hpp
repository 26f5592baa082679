// Symmetric systems of a few unknowns. One size for all of them: each size of a decomposition that Eigen writes out costs
// seconds of compiling, and at these sizes no time that could be measured.
#pragma once

#include <Eigen/Core>

namespace counterpart {

constexpr int most_unknowns = 9;
using NormalMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_unknowns, most_unknowns>;
using NormalVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_unknowns, 1>;

// x with A x = b; A symmetric and positive semi-definite, n x n, n <= 9. Not finite where A says nothing about x.
NormalVector solve_normal(const NormalMatrix& A, const NormalVector& b);

// The unit x with the least x^T A x; A symmetric.
NormalVector weakest_direction(const NormalMatrix& A);

}  // namespace counterpart
