// The result of comparing bases, as plain data for reports (cable_bases.hpp).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace cablefit {

/// One term of one cable's force: coefficient * atom(l).
struct BasisTerm {
  std::string cable;
  std::string atom;        ///< "l^2", "B-spline about 5.5 mrad, knots 2.75 mrad apart"
  double coefficient = 0;  ///< N (joint space N m), of a power over its length: per m^j or rad^j
};

/// The elastic torque on the motor over the deflections of the logs, the link in its reference
/// position.
struct BasisCurve {
  std::vector<double> deflection;         ///< rad
  std::vector<double> torque, stiffness;  ///< N m, and its slope, N m/rad
};

struct BasisScore {
  std::string basis;             ///< name of the table, cable_bases()
  int n_terms = 0;               ///< of all cables, by block cross-validation
  std::vector<int> cable_terms;  ///< per cable
  double rms_error = 0;          ///< N m, over all rows
  double held_out_rms = 0;       ///< N m, over held-out blocks: path[n_terms - 1]
  double lowest_secant = 0;      ///< least k(l) = f(l)/l of any cable used, N/m (N m/rad)
  bool pulls = true;             ///< k(l) >= 0 over the range of every cable
  std::vector<BasisTerm> terms;
  BasisCurve curve;
  std::vector<double> path;  ///< held-out rms with 1, 2, ... terms, N m
};

struct BasisComparison {
  std::vector<BasisScore> scores;  ///< in the order of cable_bases(): polynomial first
  /// Residual that no curve explains, N m rms: about straight lines within narrow bins of
  /// deflection, each branch of the motion for itself. NaN: too few samples.
  double floor = 0;
  std::size_t n_blocks = 0, n_folds = 0;  ///< of the cross-validation

  /// Held-out rms of the best polynomial with this number of terms; NaN: none was tried.
  double polynomial_rms(int n_terms) const;
};

}  // namespace cablefit
