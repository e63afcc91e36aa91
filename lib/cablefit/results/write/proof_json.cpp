#include "cablefit/results/write/proof_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cablefit/results/write/json_list.hpp"

namespace cablefit::result_json {
namespace {

double ratio(double a, double b) { return b != 0 ? a / b : std::nan(""); }

Json proved_json(const ProvedParameter& p) {
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

Json proof(const FitProof& proof) {
  return {{"runs", proof.n_runs},
          {"failed", proof.n_failed},
          {"first_seed", proof.seed},
          {"verdict", proof.verdict},
          {"parameters", list_of(proof.parameters, proved_json)},
          {"simulated", proof.notes}};
}

}  // namespace cablefit::result_json
