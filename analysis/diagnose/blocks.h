#pragma once
#include <Eigen/Core>
#include <vector>

namespace scree {

/// A square matrix with these square ones along its diagonal, 0 elsewhere: experiments do not know of one
/// another.
inline Eigen::MatrixXd block_diagonal(const std::vector<Eigen::MatrixXd>& blocks) {
  Eigen::Index n = 0, first = 0;
  for (const Eigen::MatrixXd& block : blocks) n += block.rows();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
  for (const Eigen::MatrixXd& block : blocks) {
    all.block(first, first, block.rows(), block.rows()) = block;
    first += block.rows();
  }
  return all;
}

}  // namespace scree
