#include "tracker_server/pose/normal_equations.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace counterpart {

NormalVector solve_normal(const NormalMatrix& A, const NormalVector& b) {
  return A.ldlt().solve(b);
}

NormalVector weakest_direction(const NormalMatrix& A) {
  return Eigen::SelfAdjointEigenSolver<NormalMatrix>(A).eigenvectors().col(0);
}

}  // namespace counterpart
