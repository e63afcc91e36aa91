#include "cablefit/results/read/proof_reader.hpp"

#include "cablefit/results/read/reader_parts.hpp"

namespace cablefit::result_file {
namespace {

ProvedParameter read_parameter(const JsonNode& node) {
  ProvedParameter p;
  p.name = node.at("name").text();
  p.unit = text_or_none(node, "unit");
  p.truth = number_or_nan(node, "truth");
  p.bias = number_or_nan(node, "bias");
  p.standard_error = number_or_nan(node, "bias_standard_error");
  p.scatter = number_or_nan(node, "scatter");
  p.mean_sd = number_or_nan(node, "mean_sd");
  p.n_runs = count_or_zero(node, "runs");
  p.n_covered = count_or_zero(node, "covered");
  const std::vector<double> band = node.at("coverage_band").numbers();
  if (band.size() == 2) p.coverage_band = {band[0], band[1]};
  p.factor = number_or_nan(node, "factor");
  p.verdict = text_or_none(node, "verdict");
  return p;
}

}  // namespace

std::optional<FitProof> read_proof(const JsonNode& fit) {
  const JsonNode* node = object_or_none(fit, "prove");
  if (node == nullptr) return std::nullopt;
  FitProof proof;
  proof.n_runs = count_or_zero(*node, "runs");
  proof.n_failed = count_or_zero(*node, "failed");
  proof.seed = count_or_zero(*node, "first_seed");
  proof.verdict = text_or_none(*node, "verdict");
  proof.notes = texts_or_none(*node, "simulated");
  for (const JsonNode& item : items_or_none(*node, "parameters"))
    proof.parameters.push_back(read_parameter(item));
  return proof;
}

}  // namespace cablefit::result_file
