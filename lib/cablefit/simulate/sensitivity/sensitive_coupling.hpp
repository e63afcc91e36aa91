// Elastic and load forces on all axes with their derivatives. Internal to simulate/.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "cablefit/model/model_parameters.hpp"

namespace cablefit {

/// Axes of a model: the links of all joints, then the motors; of rigid drives one each.
class SensitiveCoupling {
 public:
  /// `columns`: column of each parameter of model_parameters(), -1: it is held.
  SensitiveCoupling(const Model& model, const std::vector<ModelParameter>& parameters,
                    const std::vector<int>& columns);

  /// Takes the elastic parameters from `model`, whose cables are those of the constructor.
  void update(const Model& model);

  /// An entry of the derivative of the forces by the parameters.
  struct Entry {
    std::size_t axis;
    int column;
    double value;
  };

  /// Forces at these positions, N m; their derivatives by position and parameters are left in
  /// stiffness() and by_parameter().
  void evaluate(const double* position, double* force);

  /// dF_a/dx_b at [a * n_axes + b], N m/rad.
  const std::vector<double>& stiffness() const { return stiffness_; }
  const std::vector<Entry>& by_parameter() const { return entries_; }

 private:
  struct Strand {
    std::size_t first_joint, n_moved;     ///< into moved_
    std::vector<int> coefficient_column;  ///< per coefficient
    int elongation_column = -1;
  };
  void add_cable(std::size_t i, const double* position, double* force);
  void add_spring(std::size_t joint, const double* position, double* force);
  void add_load(const double* position, double* force);

  std::size_t n_joints_, n_axes_;
  bool is_rigid_;
  Load load_;
  Transmission transmission_;
  std::vector<Strand> strands_;
  std::vector<int> stiffness_column_, zero_column_;  ///< per joint
  std::vector<double> stiffness_, gradient_, theta_0_, shift_;
  std::vector<Entry> entries_;
};

}  // namespace cablefit
