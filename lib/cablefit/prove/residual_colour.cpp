#include "cablefit/prove/residual_colour.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

/// rows * this = residual of the fit's values.
Eigen::VectorXd residual_combination(const DynamicColumns& columns, const DynamicJob& job,
                                     const DynamicFit& fit) {
  Eigen::VectorXd combination = dynamic_response(columns, job.elastic, 0);
  for (std::size_t k = 0; k < columns.parameters.size(); ++k) {
    const Estimate* e = find_estimate(fit.parameters, columns.parameters[k].name);
    if (e != nullptr && std::isfinite(e->value))
      combination(static_cast<Eigen::Index>(k)) -= e->value;
  }
  return combination;
}

struct Piece {
  std::vector<Eigen::Index> numbers;
  Eigen::VectorXd residual;
};

}  // namespace

std::string disturbance_note(const std::string& of, double residual, const ArModel& disturbance,
                             const std::string& unit) {
  std::string text =
      fmt::format("{}{}residual {:.3g} {} rms", of, of.empty() ? "" : ": ", residual, unit);
  if (!(disturbance.sd > 0)) return text + "; as large in a simulated copy without disturbance";
  const std::size_t order = disturbance.coefficients.size();
  return text +
         fmt::format("; simulated disturbance: {:.3g} {} rms, {}", disturbance.sd, unit,
                     order == 0 ? "white" : fmt::format("autoregressive of order {}", order));
}

std::map<std::string, ResidualColour> residual_colours(std::span<const LogSurvey> logs,
                                                       const std::string& preload,
                                                       const ElasticResult& elastic,
                                                       const DynamicFit& fit,
                                                       const DynamicOptions& options) {
  DynamicPreload scratch;
  DynamicJob job{logs, options, preload, {}, {}, {fit.model}, !fit.elastic, {}, {}};
  job.wanted = [&preload](const PartSurvey& part) {
    return part.phase == Phase::moving && part.preload == preload;
  };
  if (fit.elastic) job.elastic = {&*fit.elastic};
  choose_settings(job, scratch, elastic);
  const std::vector<EquationRows> equations = make_equations(job);
  std::vector<Equation> plain;
  std::vector<Eigen::VectorXd> combinations;
  for (const EquationRows& e : equations) {
    plain.push_back(e.equation);
    combinations.push_back(residual_combination(e.columns, job, fit));
  }
  std::vector<Autocovariance> sums(equations.size(), Autocovariance(kLags));
  stream_rows(
      logs, job.wanted, job.settings.rows, plain, options.samples.threads,
      [&](const RowBatch& batch) {
        std::vector<Piece> pieces;
        for (std::size_t k = 0; k < plain.size(); ++k)
          pieces.push_back({batch.equations[k].numbers, batch.equations[k].rows * combinations[k]});
        return pieces;
      },
      [&](const std::vector<Piece>& pieces) {
        for (std::size_t k = 0; k < plain.size(); ++k)
          sums[k].add(pieces[k].numbers, pieces[k].residual);
      });
  const double period = job.settings.rows.decimate / sample_rates(logs, job.wanted).highest;
  std::map<std::string, ResidualColour> colours;
  for (std::size_t k = 0; k < equations.size(); ++k)
    colours[plain[k].name] = {equations[k].columns.side, equations[k].columns.place.joint,
                              sums[k].values(), period, sums[k].n_values()};
  return colours;
}

}  // namespace cablefit
