// The blocked rows with a dictionary of atoms instead of the law's terms, kept as a triangular
// factor for each held-out block.
#pragma once

#include <vector>

#include "cablefit/elastic/bases/basis_atoms.hpp"
#include "cablefit/elastic/models/held_out.hpp"
#include "cablefit/elastic/rows/blocked_rows.hpp"

namespace cablefit {

/// An atom of one cable (from 0).
struct CableAtom {
  std::size_t cable = 0;
  BasisAtom atom;
};

/// Columns: `n_beside` that every fit has (offset, friction, theta_0), the atoms, tau.
struct BasisRows {
  std::vector<CableAtom> atoms;
  Eigen::Index n_beside = 0;
  std::vector<StreamingQr> blocks;   ///< R of [columns] = Q R, by held-out block
  std::vector<Eigen::Index> n_rows;  ///< per block

  Eigen::Index n_atoms() const { return static_cast<Eigen::Index>(atoms.size()); }
  Eigen::Index n_columns() const { return n_beside + n_atoms() + 1; }
  /// The same of all blocks of a fold, by fold.
  std::vector<StreamingQr> folds() const;
};

/// R of all rows but those of one fold; of a fold that there is none: of all.
Eigen::MatrixXd factor_without(const std::vector<StreamingQr>& folds, Eigen::Index fold);

/// One pass over the logs: the atoms are formed at the full rate and low-passed like the torque.
/// `beside`: columns of `rows` that every fit has. One joint.
BasisRows collect_basis(const ElasticJob& job, const BlockedRows& rows,
                        std::vector<CableAtom> atoms, const std::vector<Eigen::Index>& beside);

}  // namespace cablefit
