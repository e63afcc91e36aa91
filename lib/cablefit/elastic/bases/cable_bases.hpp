// Other bases for the force of the cables, as the outlook of Fichera & Grossard 2017 names them:
// polynomial, B-splines, wavelets and monotone splines on the same rows, terms chosen one by one,
// their number by block cross-validation (Stone 1974; blocks: Burman, Chow & Nolan 1994).
#pragma once

#include "cablefit/elastic/bases/basis_rows.hpp"
#include "cablefit/elastic/bases_result.hpp"
#include "cablefit/elastic/models/candidates.hpp"

namespace cablefit {

inline constexpr int kMostTerms = 16;  ///< of all cables

/// Fits every basis of cable_bases(). `cables`: the candidate whose offset and friction are fitted
/// beside the terms. In each fold the terms are chosen and fitted without the blocks that they are
/// scored on. One joint.
BasisComparison compare_bases(const ElasticJob& job, const BlockedRows& rows,
                              const ElasticCandidate& cables);

/// The part of it that needs no logs: the terms of one dictionary, and their number.
struct BasisChoice {
  std::vector<std::size_t> atoms;    ///< places in basis.atoms
  Eigen::VectorXd x;                 ///< one per atom
  double rms_error = 0;              ///< N m, over all rows
  std::vector<double> held_out_rms;  ///< N m, with 1, 2, ... terms
};
BasisChoice choose_terms(const BasisRows& basis, const CableBasis& dictionary);

/// N m rms about straight lines within narrow bins of deflection, rising and falling for
/// themselves; NaN: too few rows.
double scatter_about_lines(const BlockedRows& rows);

}  // namespace cablefit
