// Few terms out of a large dictionary: orthogonal matching pursuit (Pati, Rezaiifar &
// Krishnaprasad 1993) in the form for atoms that are strongly correlated, where each step lowers
// the residual most (orthogonal least squares, Chen, Billings & Luo 1989; Rebollo-Neira & Lowe
// 2002); also with coefficients >= 0 (Bruckstein, Elad & Zibulevsky 2008).
#pragma once

#include <Eigen/Core>
#include <vector>

namespace cablefit {

/// y = sum_k x(k) dictionary.col(atoms[k]), as far as these atoms go.
struct SparseFit {
  std::vector<Eigen::Index> atoms;  ///< in the order in which they were chosen
  Eigen::VectorXd x;                ///< one per atom, by least squares
  double rss = 0;
};

struct PursuitOptions {
  int most_terms = 12;
  bool non_negative = false;  ///< coefficients >= 0, by non-negative least squares
};

/// The fits of 1, 2, ... terms to y: each time the atom is added whose part outside of the span of
/// those chosen has the largest correlation with the residual, and all coefficients are found again
/// by QR. `dictionary`: m x atoms,
/// columns need not be scaled; y: m. Ends before `most_terms` where no atom lowers the residual or
/// all that are left are in the span of those chosen.
std::vector<SparseFit> matching_pursuit(const Eigen::MatrixXd& dictionary, const Eigen::VectorXd& y,
                                        const PursuitOptions& options);

}  // namespace cablefit
