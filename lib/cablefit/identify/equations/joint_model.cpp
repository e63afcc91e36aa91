#include "cablefit/identify/equations/joint_model.hpp"

#include <algorithm>

#include "cablefit/identify/equations/equilibrium.hpp"
#include "cablefit/identify/equations/joint_radii.hpp"
#include "cablefit/model/effects.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/model/rig/searched_radius.hpp"

namespace cablefit {
namespace {

bool has_own(const PreloadJob& job, std::string_view name) {
  for (const JointRecord& record : job.records)
    for (const JointEquation& equation : record.equations)
      for (const JointEquation::Own& own : equation.own)
        if (own.name == name) return true;
  return false;
}

void add_coefficients(const PreloadJob& job, JointLayout& layout) {
  for (std::size_t c = 0; c < job.transmission.cables.size(); ++c) {
    const Cable& cable = job.transmission.cables[c];
    for (int k = 0; k < cable.n_coefficients(); ++k) {
      const std::string name = coefficient_name(cable, k, job.cable_space);
      layout.parameters.push_back(
          {name, name,
           unit_for(axes_of(job.axes, cable), coefficient_unit(*cable.law, k, job.cable_space)),
           -kUnbounded, kShared, c});
    }
  }
  layout.n_coefficients = static_cast<Eigen::Index>(layout.parameters.size());
}

/// What a drive has besides its cables, by joint: the effects of (31); of an arm whose links move
/// each other its base parameters first, which stand for the inertias of the links.
struct DriveParameter {
  std::string name;
  std::string unit;
  ParameterInfo info;
  bool inertia = false;  ///< of the drive, whatever the preload
};
std::vector<DriveParameter> drive_parameters(const PreloadJob& job) {
  std::vector<DriveParameter> all;
  if (job.arm != nullptr)
    for (const ParameterInfo& info : job.arm->base_parameters())
      all.push_back({std::string(info.name), std::string(info.unit), info, true});
  for (int joint = 1; joint <= job.n_joints(); ++joint)
    for (const Side side : {Side::link, Side::motor})
      for (const Effect& effect : base_effects(side))
        for (const ParameterInfo& info : effect.parameters)
          all.push_back({joint_parameter_name(info.name, joint, job.n_joints()),
                         unit_for(job.axes.of(joint - 1), info.unit), info, effect.is_inertia()});
  return all;
}

/// Parameters of the drive of one kind, inertias or others.
void add_drive(const std::vector<PreloadJob>& jobs, bool inertias, bool apart,
               JointLayout& layout) {
  const auto add = [&](const PreloadJob& job, int preload, const auto& is_used) {
    for (const DriveParameter& p : drive_parameters(job))
      if (p.inertia == inertias && is_used(p.name))
        layout.parameters.push_back(
            {p.name, std::string(p.info.symbol), p.unit, p.info.lower, preload, 0, inertias});
  };
  if (!apart)
    return add(jobs.front(), kShared, [&](std::string_view name) {
      return std::any_of(jobs.begin(), jobs.end(),
                         [&](const PreloadJob& job) { return has_own(job, name); });
    });
  for (std::size_t j = 0; j < jobs.size(); ++j)
    add(jobs[j], static_cast<int>(j),
        [&](std::string_view name) { return has_own(jobs[j], name); });
}

/// Parameters beyond (31), of each preload its own.
void add_added(const std::vector<PreloadJob>& jobs, JointLayout& layout) {
  for (std::size_t j = 0; j < jobs.size(); ++j)
    for (const JointRecord& record : jobs[j].records)
      for (const JointEquation& equation : record.equations)
        for (const DynamicParameter& p : equation.added)
          if (layout.find(p.name, static_cast<int>(j)) < 0)
            layout.parameters.push_back({p.name, std::string(p.info.symbol), p.unit(), p.info.lower,
                                         static_cast<int>(j), 0, false, p.origin});
}

/// Frictions of blocked sweeps.
void add_blocked(const std::vector<PreloadJob>& jobs, JointLayout& layout) {
  for (std::size_t j = 0; j < jobs.size(); ++j)
    for (int joint = 1; joint <= jobs[j].n_joints(); ++joint) {
      const auto add = [&](const char* symbol, const char* rotary_unit, double lower) {
        const std::string name = joint_parameter_name(symbol, joint, jobs[j].n_joints());
        const std::string unit = unit_for(jobs[j].axes.of(joint - 1), rotary_unit);
        if (has_own(jobs[j], name))
          layout.parameters.push_back({name, name, unit, lower, static_cast<int>(j), 0});
      };
      add(kBlockedFriction, "N m", 0);
      add(kCreep, "N m s/rad", -kUnbounded);
    }
}

void add_elongations(const std::vector<PreloadJob>& jobs, JointLayout& layout) {
  for (std::size_t j = 0; j < jobs.size(); ++j)
    for (std::size_t c = 0; c < jobs[j].searched.size(); ++c) {
      if (!jobs[j].searched[c]) continue;
      const Cable& cable = jobs[j].transmission.cables[c];
      const std::string name = elongation_name(cable);
      const std::string unit =
          unit_for(axes_of(jobs[j].axes, cable), elongation_unit(jobs[j].cable_space));
      layout.parameters.push_back({name, name, unit, -kUnbounded, static_cast<int>(j), c});
    }
}

/// The pulleys are those of all preloads.
void add_radii(const PreloadJob& job, JointLayout& layout) {
  for (std::size_t c = 0; c < job.searched_radius.size(); ++c) {
    if (!job.searched_radius[c]) continue;
    const std::string name = radius_name(job.transmission.cables[c]);
    layout.parameters.push_back(
        {name, name,
         job.axes.of(static_cast<int>(*job.searched_radius[c])) == Axes::linear ? "1" : "m",
         -kUnbounded, kShared, c});
  }
}

/// The link's inertia of a preload, or of all when the same load rides on it; shared under several
/// loads it stays that of the link alone.
void add_loads(const std::vector<PreloadJob>& jobs, JointLayout& layout) {
  const double first = jobs.front().load_inertia;
  const bool same = std::all_of(jobs.begin(), jobs.end(),
                                [&](const PreloadJob& job) { return job.load_inertia == first; });
  for (const Effect& effect : base_effects(Side::link))
    for (const ParameterInfo& info : effect.parameters)
      for (JointParameter& p : layout.parameters) {
        if (!effect.is_inertia() || p.name != info.name) continue;
        if (p.preload != kShared) p.known = jobs[static_cast<std::size_t>(p.preload)].load_inertia;
        if (p.preload == kShared && same) p.known = first;
      }
}

JointBlock block_of(const JointEquation& equation, const PreloadJob& job, int place,
                    const RowStatistics& rows, const JointLayout& layout, const JointForm& form,
                    Eigen::Index n_params) {
  const JointColumns c = joint_columns(equation, layout.n_coefficients);
  JointBlock block;
  block.rows = &rows;
  block.response = Eigen::VectorXd::Unit(c.count, equation.response);
  block.regressors = Eigen::MatrixXd::Zero(c.count, n_params);
  for (const JointEquation::Own& own : equation.own) {
    const Eigen::Index k = layout.find(own.name, place);
    block.regressors(own.column, k) = 1;
    if (layout.parameters[static_cast<std::size_t>(k)].inertia && !equation.motor_side)
      block.response(own.column) -= job.load_inertia;
  }
  for (const JointEquation::Given& given : equation.given)
    block.response(given.column) -= *given.parameter.given;
  for (Eigen::Index k = 0; k < layout.n_coefficients; ++k)
    block.regressors(c.basis + k, k) = equation.sign();
  if (!form.coefficients) return block;
  Eigen::Index first = 0;
  for (const Cable& cable : job.transmission.cables) {
    const Eigen::VectorXd force =
        equation.sign() * form.coefficients->segment(first, cable.n_coefficients());
    if (const Eigen::Index l_o = layout.find(elongation_name(cable), place); l_o >= 0)
      block.regressors.col(l_o).segment(c.slope + first, force.size()) = force;
    if (const Eigen::Index r_m = layout.find(radius_name(cable), place); r_m >= 0)
      block.regressors.col(r_m).segment(c.turn + first, force.size()) =
          force / searched_radius(job, layout.parameters[static_cast<std::size_t>(r_m)].cable);
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
  add_coefficients(jobs.front(), layout);
  add_drive(jobs, true, inertias_apart, layout);
  add_drive(jobs, false, true, layout);
  add_added(jobs, layout);
  add_blocked(jobs, layout);
  layout.n_linear = static_cast<Eigen::Index>(layout.parameters.size());
  add_elongations(jobs, layout);
  layout.n_elongations = static_cast<Eigen::Index>(layout.parameters.size()) - layout.n_linear;
  add_loads(jobs, layout);
  add_radii(jobs.front(), layout);
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
  problem.equalities.resize(0, n_params);
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
    if (form.coefficients) {
      const Eigen::MatrixXd ties = tie_rows(jobs[j], layout);
      problem.equalities.conservativeResize(problem.equalities.rows() + ties.rows(), n_params);
      problem.equalities.bottomRows(ties.rows()) = ties;
    }
    if (!form.equilibrium) continue;
    const Eigen::MatrixXd rows =
        equilibrium_rows(jobs[j], place, input.l_o[j], layout, form.coefficients);
    problem.equalities.conservativeResize(problem.equalities.rows() + rows.rows(), n_params);
    problem.equalities.bottomRows(rows.rows()) = rows;
  }
  return problem;
}

Transmission fitted_cables(const PreloadJob& job, const Eigen::VectorXd& l_o,
                           const Eigen::VectorXd& x) {
  return with_coefficients(with_elongations(job.transmission, l_o), x);
}

}  // namespace cablefit
