#include "cablefit/dynamic/predicted_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/parameter.hpp"
#include "cablefit/estimate/solve/identifiability.hpp"

namespace cablefit {
namespace {

constexpr double kNothingTold = 0.5;  // of its size: two sd reach 0
constexpr double kNegligible = 0.01;  // of the torque

double root_mean_square(const RowStatistics& rows, const Eigen::VectorXd& combination) {
  const double n = static_cast<double>(std::max<Eigen::Index>(1, rows.n_rows()));
  return (rows.r() * combination).norm() / std::sqrt(n);
}

double column_rms(const PredictedSystem& system, Eigen::Index k) {
  return root_mean_square(system.rows, Eigen::VectorXd::Unit(system.columns.count, k));
}

/// rms of the torque that the parameters have to explain.
double torque_rms(const PredictedSystem& system) {
  Eigen::VectorXd response = system.solution.residual_combination;
  response.head(system.solution.x.size()) += system.solution.x;
  return root_mean_square(system.rows, response);
}

/// Of the parameters that are estimated; `which`: their columns.
Identifiability structure(const PredictedSystem& system, std::vector<Eigen::Index>& which) {
  std::vector<NamedColumn> names;
  for (std::size_t k = 0; k < system.columns.parameters.size(); ++k) {
    if (system.columns.parameters[k].given) continue;
    which.push_back(static_cast<Eigen::Index>(k));
    names.push_back({system.columns.parameters[k].name, motion_column(system.columns, k)});
  }
  Eigen::MatrixXd columns(system.rows.n_columns(), static_cast<Eigen::Index>(which.size()));
  for (std::size_t k = 0; k < which.size(); ++k)
    columns.col(static_cast<Eigen::Index>(k)) = system.rows.r().col(which[k]);
  return identifiability(columns, system.rows.n_rows(), names);
}

void set_closest(const Identifiability& found, const std::vector<Eigen::Index>& which,
                 Eigen::Index k, const DynamicColumns& columns, PredictedParameter& p) {
  for (Eigen::Index j = 0; j < found.correlation.cols(); ++j) {
    if (j == k || !(std::abs(found.correlation(k, j)) > std::abs(p.correlation))) continue;
    p.correlation = found.correlation(k, j);
    p.closest =
        columns.parameters[static_cast<std::size_t>(which[static_cast<std::size_t>(j)])].name;
  }
}

/// Of its size; of all torque where it may well be 0: an offset, a friction that hardly counts.
double relative_sd_of(const PredictedSystem& system, Eigen::Index k, const PredictedParameter& p) {
  const DynamicParameter& parameter = system.columns.parameters[static_cast<std::size_t>(k)];
  const double sd = std::isfinite(p.sd_first_look) ? p.sd_first_look : p.sd_best;
  const double share = column_rms(system, k) / torque_rms(system);
  const bool counts = (std::abs(p.size) + 2 * sd) * share > kNegligible;
  const bool has_size = parameter.is_inertia || (parameter.info.lower == 0 && counts);
  return has_size && std::isfinite(p.size) ? std::max(sd * share, p.relative_sd()) : sd * share;
}

Determined judge(const PredictedSystem& system, Eigen::Index k, const PredictedParameter& p) {
  const Estimate& e = system.fit.parameters[static_cast<std::size_t>(k)];
  if (!e.not_identifiable.empty() || !std::isfinite(p.sd_best)) return Determined::not_identifiable;
  const double relative = relative_sd_of(system, k, p);
  if (relative > kNothingTold) return Determined::not_identifiable;
  const bool is_weak = std::abs(p.correlation) > kCorrelationTold || relative > kWantedRelativeSd;
  return is_weak ? Determined::weak : Determined::identifiable;
}

/// Why it is weak or worse, where no sentence about several parameters says so.
void add_sentence(const PredictedSystem& system, Eigen::Index k, const PredictedParameter& p,
                  std::vector<std::string>& sentences) {
  const Estimate& e = system.fit.parameters[static_cast<std::size_t>(k)];
  if (!std::isfinite(p.sd_best)) return;  // listed with those that it is inseparable from
  if (!e.not_identifiable.empty()) {
    sentences.push_back(fmt::format("{}: {}", p.name, e.not_identifiable));
    return;
  }
  const double relative = relative_sd_of(system, k, p);
  if (relative <= kWantedRelativeSd || std::abs(p.correlation) > kCorrelationTold) return;
  const MotionColumn column = motion_column(system.columns, static_cast<std::size_t>(k));
  sentences.push_back(fmt::format("{} would be known to {} % only; {}", p.name,
                                  two_digits(100 * relative),
                                  stronger_motion(column, column_rms(system, k), relative)));
}

PredictedParameter given_parameter(const Estimate& e) {
  PredictedParameter p{e.name, e.unit, e.value};
  p.determined = Determined::given;
  return p;
}

}  // namespace

void add_parameters(const PredictedSystem& system, PredictedEquation& out) {
  std::vector<Eigen::Index> which;
  const Identifiability found = structure(system, which);
  out.condition_scaled = found.condition_scaled;
  for (const Confusion& confusion : found.confusions) out.sentences.push_back(confusion.text);
  Eigen::Index next = 0;
  for (Eigen::Index k = 0; k < system.columns.n_effects; ++k) {
    const Estimate& e = system.fit.parameters[static_cast<std::size_t>(k)];
    if (system.columns.parameters[static_cast<std::size_t>(k)].given) {
      out.parameters.push_back(given_parameter(e));
      continue;
    }
    PredictedParameter p{e.name, e.unit, e.value};
    p.sd_best = system.noise * found.unit_sd(next);
    p.sd_first_look = e.sd;
    set_closest(found, which, next, system.columns, p);
    p.determined = judge(system, k, p);
    add_sentence(system, k, p, out.sentences);
    out.parameters.push_back(std::move(p));
    ++next;
  }
}

std::string_view to_string(Determined determined) {
  switch (determined) {
    case Determined::identifiable:
      return "identifiable";
    case Determined::weak:
      return "weak";
    case Determined::not_identifiable:
      return "not identifiable";
    case Determined::given:
      break;
  }
  return "given";
}

double PredictedParameter::relative_sd() const {
  const double sd = std::isfinite(sd_first_look) ? sd_first_look : sd_best;
  return size != 0 && std::isfinite(sd) ? sd / std::abs(size) : kNotKnown;
}

}  // namespace cablefit
