// The combinations of its links' inertial parameters on which the torques of a serial arm depend:
// all that a log of q and torques can determine. Each is one column of the regressor.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/arm/serial_chain.hpp"

namespace cablefit {

/// X = (the kept parameter) + sum of factor * (another).
struct BaseParameter {
  struct Term {
    Eigen::Index parameter;  ///< as in serial_regressor
    double factor;
  };
  std::vector<Term> terms;  ///< the kept one first, with factor 1
  std::string name;         ///< "ZZ1+0.09*(M2+M3)", long ones cut
  std::string combination;  ///< the whole of it
  std::string_view unit;
  double lower;  ///< 0 when it is a sum of masses and moments of inertia about axes

  Eigen::Index kept() const { return terms.front().parameter; }
  /// By the links' inertias as described.
  double value(const SerialChain& chain) const;
};

/// In ascending order of the kept parameters. The columns are sampled at random motions (a fixed
/// seed) and scaled. A QR decomposition with pivoting shows their rank by the gap in its diagonal
/// (Gautier 1991). Which columns are kept follows a fixed order rather than the size of the pivots,
/// so that names do not depend on rounding: from the last link to the first those that Gautier &
/// Khalil 1990 keep (for an axis along z: ZZ, XX, XY, XZ, YZ, MX, MY; along another axis the same
/// with the letters permuted), then the others. The factors solve W_left = W_kept F. Throws
/// Error(input), without a place, where lengths are too large for floating point.
std::vector<BaseParameter> base_parameters_of(const SerialChain& chain);

}  // namespace cablefit
