// Do two results differ by more than their uncertainty?
//
// Every parameter that both have gets a t test of its difference d = second - first with
// sd^2 = sd_1^2 + sd_2^2 and Welch-Satterthwaite degrees of freedom (Welch 1947). All parameters
// are judged together: "different" keeps the probability of one false alarm among them all below
// `significance` (Sidak 1967, which holds for correlated estimates too), "equal" needs two
// one-sided tests that the difference is within the margin (Schuirmann 1987), and what is neither
// is "undecided": the data are too few.
#pragma once

#include <string>
#include <vector>

#include "cablefit/campaign/compare/recorded_estimates.hpp"

namespace cablefit {

struct CompareOptions {
  /// "Equal" is closer than this share of the first value; of an offset or an encoder's zero, whose
  /// ideal value is 0, this share of the torque or deflection that the result was fitted on.
  double margin = 0.05;
  double significance = 0.05;  ///< of all "different" together, and of each "equal"
  std::string model;           ///< empty: stage 1's choice, else the richest that both have
  /// Which preload (of a campaign: which cell) of the first and of the second result; empty: every
  /// one with its namesake, or the only ones of both.
  std::string first_preload, second_preload;
};

enum class Sameness { equal, different, undecided };
std::string_view to_string(Sameness sameness);

struct ComparedParameter {
  std::string stage, preload, model;  ///< of both, or "FIRST / SECOND"
  std::string name, unit;
  double first = 0, first_sd = 0, second = 0, second_sd = 0;
  double difference = 0;  ///< second - first
  double sd = 0;          ///< of the difference; 0: from the same logs, nothing random between them
  double dof = 0;
  double low = 0,
         high = 0;  ///< all parameters together cover their true differences with 1 - significance
  double p_value = 1;             ///< of this one alone
  double p_together = 1;          ///< with all the others in mind
  double margin = 0;              ///< NaN: nothing to measure it by
  bool is_within_margin = false;  ///< two one-sided tests
  Sameness sameness = Sameness::undecided;
  double more_data =
      0;  ///< undecided: how many times the data would show that they are equal, if so

  /// In per cent of the first value; NaN where that is no measure.
  double percent() const;
  bool is_relative = true;
};

struct Uncompared {
  std::string preload, name, reason;
};

struct CompareResult {
  RecordedResult first, second;  ///< without their sets
  CompareOptions options;
  std::vector<ComparedParameter> parameters;
  std::vector<Uncompared> not_compared;
  std::vector<std::string> settings;  ///< what else is not the same: "estimator: iv, then wls"
  std::vector<std::string> warnings;

  std::size_t count(Sameness sameness) const;
  /// Different when any parameter is, equal when all are.
  Sameness sameness() const;
};

/// Throws Error(usage) for a preload or model that a result does not have, Error(input) when they
/// have no parameter in common.
CompareResult compare(RecordedResult first, RecordedResult second, const CompareOptions& options);

/// The test of one pair of estimates among `n_tests`. `same_logs`: both come from the same logs, so
/// that their difference is no matter of chance and only the margin counts.
void judge_difference(ComparedParameter& parameter, double first_dof, double second_dof,
                      std::size_t n_tests, bool same_logs, const CompareOptions& options);

}  // namespace cablefit
