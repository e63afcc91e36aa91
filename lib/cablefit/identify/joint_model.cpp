#include "cablefit/identify/joint_model.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "cablefit/estimate/constrained_least_squares.hpp"
#include "cablefit/model/effects.hpp"

namespace cablefit {
namespace {

constexpr double kBalanced = 1e-11;  // of pulleys of unit radius: rounding

bool has_own(const PreloadJob& job, std::string_view name) {
  for (const JointRecord& record : job.records)
    for (const JointEquation& equation : record.equations)
      for (const JointEquation::Own& own : equation.own)
        if (own.name == name) return true;
  return false;
}

void add_coefficients(const Transmission& transmission, bool cable_space, JointLayout& layout) {
  for (std::size_t c = 0; c < transmission.cables.size(); ++c) {
    const Cable& cable = transmission.cables[c];
    for (int k = 0; k < cable.n_coefficients(); ++k) {
      const std::string name = coefficient_name(cable, k, cable_space);
      layout.parameters.push_back(
          {name, name, coefficient_unit(*cable.law, k, cable_space), -kUnbounded, kShared, c});
    }
  }
  layout.n_coefficients = static_cast<Eigen::Index>(layout.parameters.size());
}

/// Parameters of the effects of one kind, inertias or others.
void add_effects(const std::vector<PreloadJob>& jobs, bool inertias, bool apart,
                 JointLayout& layout) {
  const auto add = [&](int preload, const auto& is_used) {
    for (const Side side : {Side::link, Side::motor})
      for (const Effect& effect : base_effects(side)) {
        if ((effect.inertia != nullptr) != inertias) continue;
        for (const ParameterInfo& info : effect.parameters)
          if (is_used(info.name))
            layout.parameters.push_back({std::string(info.name), std::string(info.symbol),
                                         std::string(info.unit), info.lower, preload, 0});
      }
  };
  if (!apart)
    return add(kShared, [&](std::string_view name) {
      return std::any_of(jobs.begin(), jobs.end(),
                         [&](const PreloadJob& job) { return has_own(job, name); });
    });
  for (std::size_t j = 0; j < jobs.size(); ++j)
    add(static_cast<int>(j), [&](std::string_view name) { return has_own(jobs[j], name); });
}

/// Frictions of blocked sweeps.
void add_blocked(const std::vector<PreloadJob>& jobs, JointLayout& layout) {
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    const int place = static_cast<int>(j);
    if (has_own(jobs[j], kBlockedFriction))
      layout.parameters.push_back({kBlockedFriction, kBlockedFriction, "N m", 0, place, 0});
    if (has_own(jobs[j], kCreep))
      layout.parameters.push_back({kCreep, kCreep, "N m s/rad", -kUnbounded, place, 0});
  }
}

void add_elongations(const std::vector<PreloadJob>& jobs, JointLayout& layout) {
  for (std::size_t j = 0; j < jobs.size(); ++j)
    for (std::size_t c = 0; c < jobs[j].searched.size(); ++c) {
      if (!jobs[j].searched[c]) continue;
      const std::string name = elongation_name(jobs[j].transmission.cables[c]);
      layout.parameters.push_back({name, name, std::string(elongation_unit(jobs[j].cable_space)),
                                   -kUnbounded, static_cast<int>(j), c});
    }
}

using Values = std::array<double, kMaxCableOrder>;

/// Rows P f and S f of a preload in its reference pose, over all parameters.
class Equilibrium {
 public:
  Equilibrium(const PreloadJob& job, int place, const Eigen::VectorXd& l_o,
              const JointLayout& layout, const JointForm& form)
      : job_(job), place_(place), l_o_(l_o), layout_(layout), form_(form) {}

  /// Slack cables everywhere balance by themselves.
  bool speaks() const { return (l_o_.array() > 0).any() || (l_o_.array() >= 0).all(); }

  Eigen::RowVectorXd row(const Eigen::VectorXd& gain, Eigen::Index n_params) const {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(n_params);
    Eigen::Index first = 0;
    for (std::size_t c = 0; c < job_.transmission.cables.size(); ++c) {
      const Cable& cable = job_.transmission.cables[c];
      const auto at = static_cast<Eigen::Index>(c);
      if (l_o_(at) > 0) add_force(cable, gain(at), l_o_(at), first, row);
      if (l_o_(at) >= 0 && form_.coefficients) add_slope(c, gain(at), first, row);
      first += cable.n_coefficients();
    }
    return row;
  }

 private:
  static void add_force(const Cable& cable, double gain, double l, Eigen::Index first,
                        Eigen::RowVectorXd& row) {
    Values values{};
    cable.law->basis(cable.shape(), l, values.data());
    for (int k = 0; k < cable.n_coefficients(); ++k)
      row(first + k) += gain * values[static_cast<std::size_t>(k)];
  }
  void add_slope(std::size_t c, double gain, Eigen::Index first, Eigen::RowVectorXd& row) const {
    const Cable& cable = job_.transmission.cables[c];
    const Eigen::Index column = layout_.find(elongation_name(cable), place_);
    if (column < 0) return;
    Values values{};
    // At l_o = 0 the cable is about to be taut: its slope is that from above.
    const double l =
        std::max(l_o_(static_cast<Eigen::Index>(c)), std::numeric_limits<double>::min());
    cable.law->slope(cable.shape(), l, values.data());
    for (int k = 0; k < cable.n_coefficients(); ++k)
      row(column) += gain * values[static_cast<std::size_t>(k)] * (*form_.coefficients)(first + k);
  }

  const PreloadJob& job_;
  int place_;
  const Eigen::VectorXd& l_o_;
  const JointLayout& layout_;
  const JointForm& form_;
};

Eigen::VectorXd reference_gain(const Transmission& transmission, bool motor_side) {
  Eigen::VectorXd gain(static_cast<Eigen::Index>(transmission.cables.size()));
  for (std::size_t c = 0; c < transmission.cables.size(); ++c)
    gain(static_cast<Eigen::Index>(c)) =
        motor_side ? transmission.cables[c].motor_radii(transmission.reference_theta())(0)
                   : transmission.cables[c].link_radii(transmission.reference_q())(0);
  return gain;
}

JointBlock block_of(const JointEquation& equation, const PreloadJob& job, int place,
                    const RowStatistics& rows, const JointLayout& layout, const JointForm& form,
                    Eigen::Index n_params) {
  const JointColumns c = joint_columns(equation, layout.n_coefficients);
  JointBlock block;
  block.rows = &rows;
  block.response = Eigen::VectorXd::Unit(c.count, equation.response);
  block.regressors = Eigen::MatrixXd::Zero(c.count, n_params);
  for (const JointEquation::Own& own : equation.own)
    block.regressors(own.column, layout.find(own.name, place)) = 1;
  for (Eigen::Index k = 0; k < layout.n_coefficients; ++k)
    block.regressors(c.basis + k, k) = equation.sign();
  if (!form.coefficients) return block;
  Eigen::Index first = 0;
  for (const Cable& cable : job.transmission.cables) {
    const Eigen::Index column = layout.find(elongation_name(cable), place);
    for (int k = 0; column >= 0 && k < cable.n_coefficients(); ++k)
      block.regressors(c.slope + first + k, column) =
          equation.sign() * (*form.coefficients)(first + k);
    first += cable.n_coefficients();
  }
  return block;
}

}  // namespace

Eigen::Index JointLayout::find(std::string_view name, int preload) const {
  for (std::size_t k = 0; k < parameters.size(); ++k)
    if (parameters[k].name == name &&
        (parameters[k].preload == kShared || parameters[k].preload == preload))
      return static_cast<Eigen::Index>(k);
  return -1;
}

JointLayout joint_layout(const std::vector<PreloadJob>& jobs, bool inertias_apart) {
  JointLayout layout;
  add_coefficients(jobs.front().transmission, jobs.front().cable_space, layout);
  add_effects(jobs, true, inertias_apart, layout);
  add_effects(jobs, false, true, layout);
  add_blocked(jobs, layout);
  layout.n_linear = static_cast<Eigen::Index>(layout.parameters.size());
  add_elongations(jobs, layout);
  return layout;
}

JointProblem joint_problem(const std::vector<PreloadJob>& jobs, const JointLayout& layout,
                           const JointInput& input, const std::vector<double>& weights,
                           const JointForm& form) {
  const Eigen::Index n_params =
      form.coefficients ? static_cast<Eigen::Index>(layout.parameters.size()) : layout.n_linear;
  JointProblem problem;
  for (Eigen::Index k = 0; k < n_params; ++k)
    problem.names.push_back(layout.parameters[static_cast<std::size_t>(k)].name);
  std::vector<Eigen::RowVectorXd> equalities;
  int record_number = 0;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    const int place = static_cast<int>(j);
    std::size_t e = 0;
    for (const JointRecord& record : jobs[j].records) {
      for (const JointEquation& equation : record.equations) {
        problem.blocks.push_back(
            block_of(equation, jobs[j], place, (*input.rows[j])[e++], layout, form, n_params));
        problem.blocks.back().weight = weights[problem.blocks.size() - 1];
        problem.blocks.back().record = record_number;
      }
      ++record_number;
    }
    const Equilibrium equilibrium(jobs[j], place, input.l_o[j], layout, form);
    if (!form.equilibrium || !equilibrium.speaks()) continue;
    for (const bool motor_side : {true, false})
      equalities.push_back(
          equilibrium.row(reference_gain(jobs[j].transmission, motor_side), n_params));
  }
  problem.equalities.resize(static_cast<Eigen::Index>(equalities.size()), n_params);
  for (std::size_t i = 0; i < equalities.size(); ++i)
    problem.equalities.row(static_cast<Eigen::Index>(i)) = equalities[i];
  return problem;
}

Transmission fitted_cables(const PreloadJob& job, const Eigen::VectorXd& l_o,
                           const Eigen::VectorXd& x) {
  Transmission transmission = with_elongations(job.transmission, l_o);
  Eigen::Index next = 0;
  for (Cable& cable : transmission.cables) {
    cable.coefficients.assign(static_cast<std::size_t>(cable.n_coefficients()), 0.0);
    for (double& coefficient : cable.coefficients) coefficient = x(next++);
  }
  return transmission;
}

bool can_balance(const Transmission& transmission, const Eigen::VectorXd& l_o) {
  std::vector<Eigen::Index> taut;
  for (Eigen::Index c = 0; c < l_o.size(); ++c)
    if (l_o(c) > 0) taut.push_back(c);
  if (taut.empty()) return true;
  Eigen::MatrixXd gain(2, l_o.size());
  gain << reference_gain(transmission, true).transpose(),
      reference_gain(transmission, false).transpose();
  Eigen::MatrixXd pulls = gain(Eigen::all, taut);
  for (Eigen::Index i = 0; i < 2; ++i)
    if (pulls.row(i).norm() > 0) pulls.row(i).normalize();
  // Forces of any positive size: 1 + u with u >= 0, up to a factor.
  const Eigen::VectorXd ones = pulls.rowwise().sum();
  const Eigen::VectorXd more = non_negative_least_squares(pulls, -ones);
  return (ones + pulls * more).norm() < kBalanced;
}

}  // namespace cablefit
