#include "cablefit/report/sections/proof_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/report/parts/numbers.hpp"

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

}  // namespace cablefit
