#include "cablefit/report/documents/proof_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cablefit/report/documents/numbers.hpp"

namespace cablefit {
namespace {

double ratio(double a, double b) { return b != 0 ? a / b : std::nan(""); }

std::string signed_text(double value, int n_decimals) {
  return std::isfinite(value) ? fmt::format("{:+.{}f}", value, n_decimals) : kNoNumber;
}

std::vector<std::string> row_of(const ProvedParameter& p) {
  if (p.n_runs == 0)
    return {p.name, kNoNumber, kNoNumber, kNoNumber, kNoNumber, kNoNumber, p.verdict};
  return {p.name,
          signed_text(100 * ratio(p.bias, std::abs(p.truth)), 2),
          signed_text(ratio(p.bias, p.mean_sd), 2),
          significant(ratio(p.scatter, p.mean_sd), 2),
          fmt::format("{:.1f}", 100 * p.coverage()),
          fmt::format("{:.1f} to {:.1f}", 100 * p.coverage_band.low, 100 * p.coverage_band.high),
          p.verdict};
}

nlohmann::ordered_json parameter_json(const ProvedParameter& p) {
  return {{"name", p.name},
          {"unit", p.unit},
          {"truth", p.truth},
          {"bias", p.bias},
          {"bias_standard_error", p.standard_error},
          {"bias_percent", 100 * ratio(p.bias, std::abs(p.truth))},
          {"bias_sd", ratio(p.bias, p.mean_sd)},
          {"scatter", p.scatter},
          {"mean_sd", p.mean_sd},
          {"runs", p.n_runs},
          {"covered", p.n_covered},
          {"coverage", p.coverage()},
          {"coverage_band", {p.coverage_band.low, p.coverage_band.high}},
          {"factor", p.factor},
          {"verdict", p.verdict}};
}

}  // namespace

Table proof_table(const std::string& what, const FitProof& proof) {
  Table table;
  table.title =
      fmt::format("Proof: {}, rerun on {} simulated logs of its own model", what, proof.n_runs);
  table.columns = {{"", "parameter", "", true},      {"bias", "relative", "%"},
                   {"bias", "against sd", ""},       {"", "scatter / sd", ""},
                   {"95 % interval", "covers", "%"}, {"95 % interval", "band", "%"},
                   {"", "verdict", "", true}};
  for (const ProvedParameter& p : proof.parameters) table.rows.push_back(row_of(p));
  table.notes.push_back(proof.verdict);
  if (proof.n_failed > 0)
    table.notes.push_back(fmt::format("{} of {} runs failed, the first with: {}", proof.n_failed,
                                      proof.n_runs, proof.first_failure));
  table.notes.insert(table.notes.end(), proof.notes.begin(), proof.notes.end());
  return table;
}

nlohmann::ordered_json proof_json(const FitProof& proof) {
  nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
  for (const ProvedParameter& p : proof.parameters) parameters.push_back(parameter_json(p));
  return {{"runs", proof.n_runs},     {"failed", proof.n_failed}, {"first_seed", proof.seed},
          {"verdict", proof.verdict}, {"parameters", parameters}, {"simulated", proof.notes}};
}

}  // namespace cablefit
