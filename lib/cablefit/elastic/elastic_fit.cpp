#include "cablefit/elastic/elastic_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>

#include "cablefit/elastic/elastic_columns.hpp"
#include "cablefit/elastic/held_out.hpp"
#include "cablefit/estimate/least_squares.hpp"
#include "cablefit/estimate/long_run.hpp"

namespace cablefit {
namespace {

constexpr double kArbitraryZero = 0.05;   // of the peak torque: a larger offset is an encoder zero
constexpr double kSlidingShare = 0.1;     // fewer rows in motion: the log is made of plateaus
constexpr double kSpeedCollinear = 0.98;  // speed and direction tell the same
constexpr double kSignificant = 2;        // paired block test, standard errors
constexpr double kPathShare = 0.02;       // of the peak torque: left over by the best static law
constexpr double kLoopShare = 0.05;       // of the peak torque: a loop this wide is worth words

/// Rows of one preload under one choice of theta_0.
struct BlockedRows {
  Transmission transmission;       // of the highest order, theta_0 set
  BlockedColumns columns;
  std::vector<Equation> equations; // those whose rows are used
  std::optional<RowStatistics> rows;
  RowCounts counts;
  WindowCounts windows;
  bool plateaus = false;
};

/// What all steps for one preload share.
struct Job {
  std::span<const LogSurvey> logs;
  PartFilter wanted;
  const ElasticOptions& options;
  ChosenSettings settings;
  double still_speed = 0;
  Transmission basis;              // highest order, theta_0 = 0
  bool orders_given = false;
};

Transmission with_order(Transmission transmission, int order) {
  for (Cable& cable : transmission.cables) cable.order = std::min(order, cable.law->max_order);
  return transmission;
}

BlockedRows collect(const Job& job, double theta_0, const Transmission* pilot) {
  BlockedRows blocked;
  blocked.transmission = job.basis;
  blocked.transmission.theta_0 = Eigen::VectorXd::Constant(job.basis.n_joints, theta_0);
  blocked.columns = blocked_columns(blocked.transmission);
  const std::vector<Equation> both = {
      blocked_equation(blocked.transmission, pilot, true, job.settings.rest_speed_theta, job.still_speed),
      blocked_equation(blocked.transmission, pilot, false, job.settings.rest_speed_theta, job.still_speed)};
  const Eigen::Index expected = expected_rows(job.logs, job.wanted, job.settings.rows);
  const RowStatistics blank(blocked.columns.count, expected);
  std::vector<RowStatistics> statistics(both.size(), blank);
  std::vector<RowCounts> counts(both.size());
  struct Result {
    std::vector<RowStatistics> statistics;
    std::vector<RowCounts> counts;
  };
  blocked.windows = stream_rows(
      job.logs, job.wanted, job.settings.rows, both, job.options.samples.threads,
      [&](const RowBatch& batch) {
        Result result;
        for (const EquationBatch& equation : batch.equations) {
          result.statistics.push_back(blank.empty_copy());
          result.statistics.back().add(equation.rows, equation.numbers);
          result.counts.push_back(equation.counts);
        }
        return result;
      },
      [&](const Result& result) {
        for (std::size_t k = 0; k < both.size(); ++k) {
          statistics[k].add(result.statistics[k]);
          counts[k] += result.counts[k];
        }
      });
  const auto sliding = static_cast<double>(counts[0].rows_used);
  const auto holding = static_cast<double>(counts[1].rows_used);
  // Plateaus: the torque at rest lies anywhere within the friction band, but the side from which a place
  // was approached decides on which half; better than nothing, and said so.
  blocked.plateaus = sliding < kSlidingShare * (sliding + holding);
  const std::size_t chosen = blocked.plateaus ? 1 : 0;
  blocked.equations = {both[chosen]};
  blocked.rows = statistics[chosen];
  blocked.counts = counts[chosen];
  if (!blocked.plateaus) blocked.counts.rows_at_rest = counts[0].rows_at_rest;
  return blocked;
}

/// A model of the blocked rows: which columns, under which names.
struct Candidate {
  std::string model;
  int order = 1;
  Transmission transmission;
  std::vector<Eigen::Index> regressors;
  std::vector<std::string> names;
  std::vector<double> lower;
  std::size_t n_elastic = 0;
};

void add_nuisance(Candidate& candidate, const BlockedRows& rows, bool theta_0, bool branches,
                  bool speed) {
  const auto add = [&](Eigen::Index column, const char* name, double lower) {
    candidate.regressors.push_back(column);
    candidate.names.emplace_back(name);
    candidate.lower.push_back(lower);
  };
  if (theta_0 && candidate.model != "linear") {
    add(rows.columns.zero, "theta_0", -kUnbounded);
  } else {
    add(rows.columns.offset, "offset", -kUnbounded);
  }
  if (branches) add(rows.columns.direction, "f_sm", 0);
  if (speed) add(rows.columns.speed, "f_vm", -kUnbounded);
}

Candidate linear_candidate(const BlockedRows& rows) {
  Candidate candidate;
  candidate.model = "linear";
  candidate.transmission.n_joints = rows.transmission.n_joints;
  candidate.transmission.linear_stiffness = Eigen::VectorXd::Zero(rows.transmission.n_joints);
  candidate.transmission.theta_0 = rows.transmission.theta_0;
  candidate.regressors = {rows.columns.deflection};
  candidate.names = {"K"};
  candidate.lower = {-kUnbounded};
  candidate.n_elastic = 1;
  return candidate;
}

Candidate poly_candidate(const Job& job, const BlockedRows& rows, int order) {
  Candidate candidate;
  candidate.model = "poly";
  candidate.transmission =
      job.orders_given ? rows.transmission : with_order(rows.transmission, order);
  Eigen::Index first = rows.columns.basis;
  for (std::size_t c = 0; c < rows.transmission.cables.size(); ++c) {
    const Cable& cable = candidate.transmission.cables[c];
    candidate.order = std::max(candidate.order, cable.order);
    for (int k = 0; k < cable.n_coefficients(); ++k) {
      candidate.regressors.push_back(first + k);
      candidate.names.push_back(
          coefficient_name(cable, k, job.logs.front().plan.rig.cables_given));
      candidate.lower.push_back(-kUnbounded);
    }
    first += rows.transmission.cables[c].n_coefficients();
  }
  candidate.n_elastic = candidate.regressors.size();
  return candidate;
}

Eigen::VectorXd torque_response(const BlockedRows& rows) {
  return Eigen::VectorXd::Unit(rows.columns.count, rows.columns.tau);
}

LinearSolution solve_candidate(const BlockedRows& rows, const Candidate& candidate) {
  return solve(*rows.rows, {candidate.regressors, candidate.names, candidate.lower, torque_response(rows)});
}

/// Both branches: the direction column is not (nearly) a constant.
bool has_both_branches(const BlockedRows& rows) {
  const auto& r = rows.rows->r();
  const double sum = r.col(rows.columns.direction).dot(r.col(rows.columns.offset));
  const double n = r.col(rows.columns.offset).squaredNorm();
  return n > 0 && std::abs(sum) < 0.95 * n;
}

bool speed_tells_more(const BlockedRows& rows, bool branches) {
  if (!branches) return false;
  const auto& r = rows.rows->r();
  const auto direction = r.col(rows.columns.direction);
  const auto speed = r.col(rows.columns.speed);
  const double norms = direction.norm() * speed.norm();
  return norms > 0 && std::abs(direction.dot(speed)) < kSpeedCollinear * norms;
}

/// Lowest order that no higher one beats significantly on held-out blocks.
int choose_order(const Job& job, const BlockedRows& rows, bool theta_0, bool branches, bool speed,
                 std::vector<std::string>& words) {
  const HeldOut held_out(*rows.rows);
  std::vector<Eigen::VectorXd> errors;
  for (int order = 1; order <= job.options.max_order; ++order) {
    Candidate candidate = poly_candidate(job, rows, order);
    add_nuisance(candidate, rows, theta_0, branches, speed);
    errors.push_back(held_out.block_errors(held_out.fits(candidate.regressors, torque_response(rows))));
  }
  const auto beats = [&](std::size_t high, std::size_t low) {
    const Eigen::ArrayXd gain = (errors[low] - errors[high]).array();
    const double n = static_cast<double>(gain.size());
    const double mean = gain.mean();
    const double spread = std::sqrt((gain - mean).square().sum() / std::max(1.0, n - 1) / n);
    return n >= 4 && mean > kSignificant * spread && mean > 0.01 * errors[low].mean();
  };
  for (std::size_t low = 0; low < errors.size(); ++low) {
    bool beaten = false;
    for (std::size_t high = low + 1; high < errors.size(); ++high) beaten |= beats(high, low);
    if (beaten) continue;
    words.push_back(fmt::format(
        "order {} is the lowest that no order up to {} beats on held-out blocks (rms {:.3g} against {:.3g} N m of order {})",
        low + 1, job.options.max_order, std::sqrt(errors[low].mean()),
        std::sqrt(errors.back().mean()), job.options.max_order));
    return static_cast<int>(low) + 1;
  }
  return job.options.max_order;
}

Estimate estimate_of(const std::string& name, const std::string& unit, Eigen::Index k,
                     const LinearSolution& s) {
  Estimate e;
  e.name = name;
  e.symbol = name;
  e.unit = unit;
  e.value = s.x(k);
  e.not_identifiable = s.not_identifiable[static_cast<std::size_t>(k)];
  if (!e.not_identifiable.empty()) return e;
  if (s.at_bound[static_cast<std::size_t>(k)]) {
    e.active_bound = name + " >= 0";
    e.sd = s.unbounded_sd(k);
    e.ci_low = 0;
    e.ci_high = std::max(0.0, s.unbounded_x(k) + t_quantile_975(s.degrees_of_freedom) * e.sd);
    return e;
  }
  e.sd = std::sqrt(s.covariance(k, k));
  e.sd_white = std::sqrt(s.covariance_white(k, k));
  const double t = t_quantile_975(s.degrees_of_freedom);
  e.ci_low = e.value - t * e.sd;
  e.ci_high = e.value + t * e.sd;
  return e;
}

std::string unit_of(const Candidate& candidate, std::size_t k, bool linear_motion, bool cable_space) {
  std::string unit;
  if (k < candidate.n_elastic) {
    if (candidate.model == "linear") {
      unit = "N m/rad";
    } else {
      std::size_t first = 0;
      for (const Cable& cable : candidate.transmission.cables) {
        const auto n = static_cast<std::size_t>(cable.n_coefficients());
        if (k < first + n) {
          unit = coefficient_unit(static_cast<int>(k - first), cable_space);
          break;
        }
        first += n;
      }
      if (cable_space) return unit;
    }
  } else {
    unit = candidate.names[k] == "theta_0" ? "rad" : candidate.names[k] == "f_vm" ? "N m s/rad" : "N m";
  }
  return linear_motion ? linear_unit(unit) : unit;
}

void fill_transmission(ElasticFit& fit, const Candidate& candidate, const LinearSolution& s) {
  fit.transmission = candidate.transmission;
  if (candidate.model == "linear") {
    fit.transmission.linear_stiffness(0) = s.x(0);
    return;
  }
  Eigen::Index next = 0;
  for (Cable& cable : fit.transmission.cables) {
    cable.coefficients.assign(static_cast<std::size_t>(cable.n_coefficients()), 0.0);
    for (double& coefficient : cable.coefficients) coefficient = s.x(next++);
  }
}

/// Where a cable pushes, over the elongations it really saw.
void check_passive(ElasticFit& fit, double low, double high) {
  if (fit.model == "linear") {
    fit.passive = fit.transmission.linear_stiffness(0) >= 0;
    if (!fit.passive)
      fit.warnings.push_back("the stiffness is negative: the sign of tau or of theta is turned round");
    return;
  }
  for (const Cable& cable : fit.transmission.cables) {
    const double at_low = cable.motor_radius(0) * low + cable.initial_elongation;
    const double at_high = cable.motor_radius(0) * high + cable.initial_elongation;
    const double longest = std::max(at_low, at_high);
    if (longest <= 0) {
      fit.warnings.push_back(fmt::format("cable {} was never taut in these logs", cable.name));
      continue;
    }
    double worst = 0, where = 0;
    for (int i = 1; i <= 200; ++i) {
      const double l = longest * i / 200;
      if (cable.secant(l) < worst) worst = cable.secant(l), where = l;
    }
    if (worst < 0) {
      fit.passive = false;
      fit.warnings.push_back(fmt::format(
          "cable {} would push: its stiffness k(l) is {:.4g} at an elongation of {:.4g}, which breaks (5) and "
          "(16) of the paper; do not use this fit, lower --order or record both sides of zero",
          cable.name, worst, where));
    }
  }
}

ElasticFit make_fit(const Job& job, const Candidate& candidate, const LinearSolution& s,
                    const BlockedRows& rows, bool theta_0) {
  ElasticFit fit;
  const Rig& rig = job.logs.front().plan.rig;
  fit.model = candidate.model;
  fit.order = candidate.order;
  fit.condition = s.condition_scaled;
  fit.effective_rows = s.effective_rows;
  fit.rms_error = s.rms();
  fill_transmission(fit, candidate, s);
  const auto n = static_cast<Eigen::Index>(candidate.n_elastic);
  fit.covariance = s.covariance.topLeftCorner(n, n);
  for (std::size_t k = 0; k < candidate.names.size(); ++k) {
    const auto index = static_cast<Eigen::Index>(k);
    Estimate e = estimate_of(candidate.names[k],
                             unit_of(candidate, k, rig.linear_motion, rig.cables_given), index, s);
    if (e.name == "f_vm") continue;  // a sweep this slow only keeps it out of f_sm
    if (e.name == "offset") fit.offset = e.value;
    if (e.name == "theta_0") {
      e.value += rows.transmission.theta_0(0);
      e.ci_low += rows.transmission.theta_0(0);
      e.ci_high += rows.transmission.theta_0(0);
      fit.transmission.theta_0(0) = e.value;
    }
    if (e.name == "offset" && theta_0) {
      // Linear spring with an arbitrary encoder zero: K (theta - theta_0 - q), delta method.
      const double stiffness = s.x(0);
      const double gradient_k = s.x(index) / (stiffness * stiffness);
      const double gradient_c = -1 / stiffness;
      const auto variance = [&](const Eigen::MatrixXd& c) {
        return gradient_k * gradient_k * c(0, 0) + gradient_c * gradient_c * c(index, index) +
               2 * gradient_k * gradient_c * c(0, index);
      };
      e.name = e.symbol = "theta_0";
      e.unit = rig.linear_motion ? "m" : "rad";
      e.value = rows.transmission.theta_0(0) - s.x(index) / stiffness;
      e.sd = std::sqrt(variance(s.covariance));
      e.sd_white = std::sqrt(variance(s.covariance_white));
      const double t = t_quantile_975(s.degrees_of_freedom);
      e.ci_low = e.value - t * e.sd;
      e.ci_high = e.value + t * e.sd;
      fit.transmission.theta_0(0) = e.value;
      fit.offset = 0;
    }
    fit.parameters.push_back(std::move(e));
  }
  fit.warnings.insert(fit.warnings.end(), s.warnings.begin(), s.warnings.end());
  return fit;
}

/// A second look at the rows: largest errors, of the fit and of the held-out blocks, and the ranges.
void measure_errors(const Job& job, const BlockedRows& rows, const std::vector<Candidate>& candidates,
                    const std::vector<LinearSolution>& solutions, ElasticPreload& preload) {
  const HeldOut held_out(*rows.rows);
  std::vector<std::vector<Eigen::VectorXd>> folds;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    folds.push_back(held_out.fits(candidates[k].regressors, torque_response(rows)));
    preload.fits[k].held_out_rms = std::sqrt(held_out.block_errors(folds[k]).mean());
  }
  struct Extremes {
    double low = kUnbounded, high = -kUnbounded, peak = 0;
    std::vector<double> worst, worst_held_out;
  };
  Extremes total;
  total.worst.assign(candidates.size(), 0);
  total.worst_held_out.assign(candidates.size(), 0);
  const double offset = preload.fits.front().offset;
  stream_rows(
      job.logs, job.wanted, job.settings.rows, rows.equations, job.options.samples.threads,
      [&](const RowBatch& batch) {
        const EquationBatch& e = batch.equations.front();
        Extremes found;
        found.worst.assign(candidates.size(), 0);
        found.worst_held_out.assign(candidates.size(), 0);
        if (e.rows.rows() == 0) return found;
        found.low = e.rows.col(rows.columns.deflection).minCoeff();
        found.high = e.rows.col(rows.columns.deflection).maxCoeff();
        found.peak = (e.rows.col(rows.columns.tau).array() - offset).abs().maxCoeff();
        for (std::size_t k = 0; k < candidates.size(); ++k) {
          found.worst[k] = (e.rows * solutions[k].residual_combination).cwiseAbs().maxCoeff();
          for (Eigen::Index i = 0; i < e.rows.rows(); ++i) {
            const auto fold = static_cast<std::size_t>(
                held_out.fold_of_row(e.numbers[static_cast<std::size_t>(i)]));
            found.worst_held_out[k] =
                std::max(found.worst_held_out[k], std::abs(e.rows.row(i).dot(folds[k][fold])));
          }
        }
        return found;
      },
      [&](const Extremes& found) {
        total.low = std::min(total.low, found.low);
        total.high = std::max(total.high, found.high);
        total.peak = std::max(total.peak, found.peak);
        for (std::size_t k = 0; k < candidates.size(); ++k) {
          total.worst[k] = std::max(total.worst[k], found.worst[k]);
          total.worst_held_out[k] = std::max(total.worst_held_out[k], found.worst_held_out[k]);
        }
      });
  preload.deflection_low = total.low;
  preload.deflection_high = total.high;
  preload.peak_torque = total.peak;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    preload.fits[k].max_abs_error = total.worst[k];
    preload.fits[k].held_out_max = total.worst_held_out[k];
  }
}

void select_model(const Job& job, ElasticPreload& preload) {
  const ElasticFit& linear = preload.fits.front();
  const ElasticFit& poly = preload.fits.back();
  const char* unit = preload.linear_motion ? "N" : "N m";
  const double allowed = job.options.materiality * preload.peak_torque;
  const double best = std::min(linear.held_out_max, poly.held_out_max);
  const bool linear_will_do = linear.held_out_max <= best + allowed;
  preload.selected = linear_will_do ? "linear" : "poly";
  preload.selection.push_back(fmt::format(
      "materiality: largest error on held-out blocks {:.3g} {} linear, {:.3g} {} poly; {:.3g} {} ({:g} % of the "
      "peak torque) may separate them: {}",
      linear.held_out_max, unit, poly.held_out_max, unit, allowed, unit, 100 * job.options.materiality,
      preload.selected));
  preload.selection.push_back(
      fmt::format("significance: rms on held-out blocks {:.3g} {} linear, {:.3g} {} poly: {}", linear.held_out_rms,
                  unit, poly.held_out_rms, unit,
                  poly.held_out_rms < linear.held_out_rms ? "poly" : "linear"));
}

void note_loop(ElasticPreload& preload, const BlockedRows& rows) {
  const char* unit = preload.linear_motion ? "N" : "N m";
  const ElasticFit& best = *preload.find(preload.selected);
  const Estimate* friction = find_estimate(best.parameters, "f_sm");
  preload.loop_half_width = friction != nullptr ? friction->value : 0;
  const double peak = preload.peak_torque;
  const double share = peak > 0 ? preload.loop_half_width / peak : 0;
  const double left = peak > 0 ? best.rms_error / peak : 0;
  // A friction band is as wide everywhere; what is left beyond it depends on the path.
  if (left > kPathShare && (share > kLoopShare || left > kLoopShare))
    preload.warnings.push_back(fmt::format(
        "no static law explains this loop: it is {:.3g} {} wide ({:.0f} % of the peak torque of {:.3g} {}) and {:.3g} "
        "{} rms remain beyond a constant friction band; suspect hysteresis or friction that grows with load",
        2 * preload.loop_half_width, unit, 200 * share, peak, unit, best.rms_error, unit));
  if (rows.plateaus)
    preload.warnings.push_back(
        "the motor hardly moves between plateaus: torques at rest lie within the friction band, so f_sm is a lower "
        "estimate; sweep slowly up and down instead");
}

void note_closure(ElasticPreload& preload) {
  const ElasticFit& poly = preload.fits.back();
  if (poly.model != "poly" || poly.transmission.cables.size() != 2) return;
  for (const Cable& cable : poly.transmission.cables)
    if (cable.initial_elongation != 0 || cable.coefficients.empty()) return;
  // With l_o = 0 each cable acts on its own side. A preloaded pair is about twice as stiff at zero as
  // where one cable has gone slack, so its slope FALLS away from zero on both sides.
  const double reach = std::min(-preload.deflection_low, preload.deflection_high);
  if (!(reach > 0)) return;
  int falling = 0;
  for (const Cable& cable : poly.transmission.cables)
    falling += cable.stiffness(0.2 * reach) < 0.9 * cable.stiffness(1e-6 * reach);
  if (falling == 2)
    preload.warnings.push_back(
        "the stiffness falls on both sides of zero, as with cables that are both taut there (preload): with l_o = 0 "
        "the coefficients describe the curve, not the cables");
}

std::optional<double> pilot_zero(const Job& job, const BlockedRows& rows, const Candidate& linear,
                                 const LinearSolution& s) {
  const double stiffness = s.x(0);
  if (!(std::abs(stiffness) > 0)) return std::nullopt;
  (void)job;
  (void)linear;
  return rows.transmission.theta_0(0) - s.x(1) / stiffness;
}

bool zero_is_arbitrary(const Job& job, const BlockedRows& rows, const LinearSolution& s) {
  if (job.options.zero != ZeroMode::automatic) return job.options.zero == ZeroMode::theta_0;
  const auto& r = rows.rows->r();
  const double n = static_cast<double>(rows.rows->n_rows());
  const double spread = (r.col(rows.columns.tau) - s.x(1) * r.col(rows.columns.offset)).norm() / std::sqrt(n);
  return std::abs(s.x(1)) > kArbitraryZero * std::sqrt(2.0) * spread;
}

ElasticPreload fit_preload(const Job& job, const std::string& name) {
  ElasticPreload preload;
  const Rig& rig = job.logs.front().plan.rig;
  preload.name = name;
  preload.linear_motion = rig.linear_motion;
  preload.unit = rig.linear_motion ? "m" : "rad";
  preload.rig_path = rig.path;
  preload.decisions = job.settings.decisions;

  BlockedRows rows = collect(job, 0, nullptr);
  if (rows.rows->n_rows() < 10)
    throw Error(ErrorKind::not_identifiable,
                fmt::format("preload '{}': {} usable rows of a blocked link are too few; {}", name,
                            rows.rows->n_rows(), "sweep the motor slowly up and down, several times"));
  preload.both_branches = has_both_branches(rows);
  if (!preload.both_branches)
    preload.warnings.push_back(
        "theta moves in one direction only: the motor's static friction cannot be told from the elastic torque; "
        "stiffness and offset may be off by it, f_sm is not estimated; sweep up and down");
  const bool speed = speed_tells_more(rows, preload.both_branches);

  Candidate linear = linear_candidate(rows);
  add_nuisance(linear, rows, false, preload.both_branches, speed);
  LinearSolution linear_solution = solve_candidate(rows, linear);
  const bool theta_0 = zero_is_arbitrary(job, rows, linear_solution);
  int order = job.options.order;
  std::unique_ptr<Transmission> pilot;
  if (theta_0) {
    // Gauss-Newton on theta_0: start where the straight line crosses zero, then let its own column
    // correct it together with everything else.
    double zero = pilot_zero(job, rows, linear, linear_solution).value_or(0);
    pilot = std::make_unique<Transmission>(linear.transmission);
    pilot->linear_stiffness(0) = linear_solution.x(0);
    for (int iteration = 0; iteration < 6; ++iteration) {
      pilot->theta_0 = Eigen::VectorXd::Constant(1, zero);
      rows = collect(job, zero, pilot.get());
      Candidate candidate = poly_candidate(job, rows, order > 0 ? order : 2);
      add_nuisance(candidate, rows, true, preload.both_branches, speed);
      const LinearSolution s = solve_candidate(rows, candidate);
      const double step = s.x(static_cast<Eigen::Index>(candidate.n_elastic));
      const double range = std::abs(linear_solution.x(0)) > 0 ? s.rms() / std::abs(linear_solution.x(0)) : 0;
      ElasticFit curve;
      fill_transmission(curve, candidate, s);
      *pilot = curve.transmission;
      if (!std::isfinite(step) || std::abs(step) < 1e-3 * range) break;
      zero += std::clamp(step, -5 * range, 5 * range);
    }
    linear = linear_candidate(rows);
    add_nuisance(linear, rows, false, preload.both_branches, speed);
    linear_solution = solve_candidate(rows, linear);
    preload.decisions.push_back({"zero", "theta_0",
                                 job.options.zero == ZeroMode::automatic
                                     ? "the torque is far from zero at zero deflection: the encoder's zero is arbitrary"
                                     : "given"});
  } else {
    preload.decisions.push_back({"zero", "offset", "the deflection's zero is known, the drive may have an offset"});
  }
  if (order == 0 && !job.orders_given)
    order = choose_order(job, rows, theta_0, preload.both_branches, speed, preload.selection);

  Candidate poly = poly_candidate(job, rows, std::max(1, order));
  add_nuisance(poly, rows, theta_0, preload.both_branches, speed);
  const LinearSolution poly_solution = solve_candidate(rows, poly);

  preload.fits.push_back(make_fit(job, linear, linear_solution, rows, theta_0));
  preload.fits.push_back(make_fit(job, poly, poly_solution, rows, theta_0));
  preload.counts = rows.counts;
  preload.windows = rows.windows;
  measure_errors(job, rows, {linear, poly}, {linear_solution, poly_solution}, preload);
  for (ElasticFit& fit : preload.fits) check_passive(fit, preload.deflection_low, preload.deflection_high);
  select_model(job, preload);
  note_loop(preload, rows);
  note_closure(preload);
  return preload;
}

std::set<std::string> preload_names(std::span<const LogSurvey> logs, const ElasticOptions& options) {
  std::set<std::string> names;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts)
      if (options.still || part.phase == Phase::blocked)
        if (options.preload.empty() || options.preload == part.preload) names.insert(part.preload);
  return names;
}

Job make_job(std::span<const LogSurvey> logs, const ElasticOptions& options, const std::string& name) {
  const bool still = options.still;
  Job job{logs,
          [name, still](const PartSurvey& part) {
            return part.preload == name && (still || part.phase == Phase::blocked);
          },
          options, {}, 0, {}, false};
  job.settings = blocked_settings(logs, job.wanted, options.samples);
  const Rig& rig = logs.front().plan.rig;
  job.orders_given = rig.cables_given && options.order == 0;
  job.basis = rig.transmission;
  if (!job.orders_given) job.basis = with_order(job.basis, options.order > 0 ? options.order : options.max_order);
  if (still) {
    job.still_speed = std::max(job.settings.rest_speed_q, 1e-12);
    // The link rests only for moments: keep more rows of them.
    if (!options.samples.decimate) job.settings.rows.decimate = std::max(1, job.settings.rows.decimate / 8);
  }
  return job;
}

}  // namespace

const ElasticFit* ElasticPreload::find(const std::string& model) const {
  for (const ElasticFit& fit : fits)
    if (fit.model == model) return &fit;
  return nullptr;
}

ElasticResult fit_elastic(std::span<const LogSurvey> logs, const ElasticOptions& options) {
  ElasticResult result;
  for (const LogSurvey& log : logs) {
    result.inputs.push_back({log.plan.path, log.sha256, log.n_rows});
    require_channel(log.plan, Channel::q, "the deflection theta - q");
    require_channel(log.plan, Channel::theta, "the deflection theta - q");
    require_channel(log.plan, Channel::tau, "the elastic torque");
  }
  const std::set<std::string> names = preload_names(logs, options);
  if (names.empty())
    throw input_error({logs.empty() ? "" : logs.front().plan.path, 0, 0},
                      options.preload.empty() ? "no log has a blocked link (q moves in all of them)"
                                              : fmt::format("no blocked log of preload '{}'", options.preload),
                      "give a blocked log, a 'phase' column, or --still to use the parts in which the link rests");
  for (const std::string& name : names) {
    const Job job = make_job(logs, options, name);
    result.preloads.push_back(fit_preload(job, name));
  }
  return result;
}

}  // namespace cablefit
