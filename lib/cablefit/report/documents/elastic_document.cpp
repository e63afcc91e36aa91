#include "cablefit/report/documents/elastic_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/model/modes.hpp"
#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"
#include "cablefit/report/sections/proof_report.hpp"

namespace cablefit {
namespace {

std::string error_text(double error) { return significant(error, kDigits); }

/// "0.012 +- 0.003", "-" when the fit has no such parameter. `scale`: mrad instead of rad.
std::string estimate_text(const ElasticFit& fit, const std::string& name, double scale,
                          Footnotes& notes) {
  const Estimate* e = find_estimate(fit.parameters, name);
  if (e == nullptr) return kNoNumber;
  if (!e->not_identifiable.empty()) {
    return "not identifiable " + notes.mark(e->not_identifiable);
  }
  if (!e->active_bound.empty()) {
    return "0 " + notes.mark(fmt::format("at its bound {}; 95 % interval up to {}", e->active_bound,
                                         significant(e->ci_high, 2)));
  }
  return value_with_sd(scale * e->value, scale * e->sd);
}

/// A row of the table of fits: the whole fit, or of several joints one of them.
struct FitRow {
  std::string joint;  ///< empty: there is one
  ElasticJointErrors errors;
  std::string name(const char* parameter) const {
    return joint.empty() ? parameter : fmt::format("{}[{}]", parameter, joint);
  }
};

std::vector<FitRow> rows_of(const ElasticFit& fit) {
  if (fit.joints.empty())
    return {{"", {fit.rms_error, fit.max_abs_error, fit.held_out_rms, fit.held_out_max}}};
  std::vector<FitRow> rows;
  for (std::size_t k = 0; k < fit.joints.size(); ++k)
    rows.push_back({std::to_string(k + 1), fit.joints[k]});
  return rows;
}

bool has_several_joints(const ElasticResult& result) {
  return std::any_of(result.preloads.begin(), result.preloads.end(),
                     [](const ElasticPreload& preload) { return !preload.joints.empty(); });
}

Table fits_table(const ElasticResult& result) {
  const Axes axes = axes_of(result.preloads);
  const std::string torque = torque_unit(axes);
  Table table;
  Footnotes notes;
  table.title = "Fits";
  table.columns = {{"", "preload", "", true},
                   {"", "model", "", true},
                   {"", "offset", torque},
                   {"", "theta_0", unit_for(axes, "mrad")},
                   {"", "f_sm", torque},
                   {"error", "rms", torque},
                   {"error", "max", torque},
                   {"held-out blocks", "rms", torque},
                   {"held-out blocks", "max", torque},
                   {"", "", "", true}};
  const bool by_joint = has_several_joints(result);
  if (by_joint) table.columns.insert(table.columns.begin() + 2, {"", "joint", "", true});
  for (const ElasticPreload& preload : result.preloads) {
    for (const ElasticFit& fit : preload.fits) {
      std::string remark = fit.model == preload.selected ? "selected" : "";
      const auto add = [&remark](const char* more) {
        remark += (remark.empty() ? "" : ", ") + std::string(more);
      };
      if (!fit.passive) add("pushes");
      if (!fit.active_bounds.empty()) add("at bounds");
      for (const FitRow& row : rows_of(fit)) {
        std::vector<std::string> cells = {preload.name,
                                          model_text(fit),
                                          estimate_text(fit, row.name("offset"), 1, notes),
                                          estimate_text(fit, row.name("theta_0"), 1e3, notes),
                                          estimate_text(fit, row.name("f_sm"), 1, notes),
                                          error_text(row.errors.rms_error),
                                          error_text(row.errors.max_abs_error),
                                          error_text(row.errors.held_out_rms),
                                          error_text(row.errors.held_out_max),
                                          remark};
        if (by_joint) cells.insert(cells.begin() + 2, row.joint);
        table.rows.push_back(std::move(cells));
      }
    }
  }
  table.notes = notes.lines();
  return table;
}

/// Lines and cables on the logs of the fit, and on test logs: Figs. 6b and 7b as numbers.
Table scores_table(const ElasticResult& result) {
  const Axes axes = axes_of(result.preloads);
  const std::string torque = torque_unit(axes);
  Table table;
  table.title = "Errors of the elastic torque (Figs. 6b, 7b)";
  table.columns = {{"", "preload", "", true},   {"", "model", "", true},
                   {"", "fitted to", "", true}, {"", "K", unit_for(axes, "N m/rad")},
                   {"", "on", "", true},        {"error", "rms", torque},
                   {"error", "max", torque},    {"error", "at", unit_for(axes, "mrad")}};
  for (const ElasticPreload& preload : result.preloads)
    for (const ElasticScore& score : preload.scores)
      table.rows.push_back(
          {preload.name, score.model, score.fitted,
           std::isfinite(score.stiffness) ? fmt::format("{:.1f}", score.stiffness) : kNoNumber,
           score.is_test ? "test logs" : "these logs", error_text(score.rms_error),
           error_text(score.max_abs_error), fmt::format("{:.1f}", 1e3 * score.at)});
  return table;
}

/// "4 + 4" terms of the cables.
std::string terms_text(const BasisScore& score) {
  return fmt::format("{}", fmt::join(score.cable_terms, " + "));
}

/// Bases of the cable force: the answer of --bases.
Table bases_table(const ElasticResult& result) {
  const Axes axes = axes_of(result.preloads);
  const std::string torque = torque_unit(axes);
  Table table;
  table.title = "Bases of the cable force";
  table.columns = {{"", "preload", "", true},
                   {"", "basis", "", true},
                   {"", "terms", "", true},
                   {"error", "rms", torque},
                   {"held-out blocks", "rms", torque},
                   {"held-out blocks", "best polynomial of as many terms", torque},
                   {"k(l) = f(l)/l", "least", unit_for(axes, "N m/rad")},
                   {"k(l) = f(l)/l", ">= 0", "", true}};
  for (const ElasticPreload& preload : result.preloads) {
    if (!preload.bases) continue;
    for (const BasisScore& score : preload.bases->scores)
      table.rows.push_back({preload.name, score.basis, terms_text(score),
                            error_text(score.rms_error), error_text(score.held_out_rms),
                            error_text(preload.bases->polynomial_rms(score.n_terms)),
                            error_text(score.lowest_secant), score.pulls ? "yes" : "no"});
    if (std::isfinite(preload.bases->floor))
      table.notes.push_back(
          fmt::format("{}: scatter about short lines {} {} rms, which no curve "
                      "explains",
                      preload.name, error_text(preload.bases->floor), torque));
  }
  if (!table.rows.empty())
    table.notes.emplace_back(
        "terms: of each cable, chosen one by one; their number by block cross-validation");
  return table;
}

/// "0.1", or of several joints "0.1, -0.2".
std::string numbers_text(const Eigen::VectorXd& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + significant(number, 2);
  return text;
}

/// (8c): what the preload alone does in the reference pose.
std::string balance_text(const ElasticPreload& preload, const ElasticFit& fit) {
  PreloadTorques alone = preload_torques(fit.transmission);
  for (Eigen::VectorXd* torques : {&alone.link, &alone.motor})
    *torques = (torques->array().abs() < kEquilibriumMet).select(0, *torques);
  return fmt::format(
      "{}, {}: in the reference pose the preload alone gives {} {} on the link and "
      "{} on the motor; 0 in equilibrium (8c)",
      preload.name, fit.model, numbers_text(alone.link), torque_unit(preload.axes),
      numbers_text(alone.motor));
}

/// "all cables taut (force closure) in 12.0 % of the samples; slack: 1 in 44.1 %, ...".
std::string modes_text(const ElasticPreload& preload) {
  const auto percent = [&](std::size_t rows) {
    const auto all = static_cast<double>(preload.counts.rows_used);
    return fmt::format("{:.1f} %", 100 * static_cast<double>(rows) / std::max(1.0, all));
  };
  std::string slack;
  for (const ModeCounts::Slack& own : preload.modes.slack)
    slack += fmt::format("{}{} in {}", slack.empty() ? "" : ", ", own.cable, percent(own.rows));
  return fmt::format("all cables taut (force closure) in {} of the samples; slack: {}",
                     percent(preload.modes.closure), slack);
}

/// Where cables of a preloaded fit go slack, within the deflections of the logs; no rows otherwise:
/// with every l_o = 0 each cable ends at zero deflection by definition.
Table slack_table(const ElasticResult& result) {
  const Axes axes = axes_of(result.preloads);
  Table table;
  table.title = "Cables go slack (force disclosure) at";
  table.columns = {{"", "preload", "", true},
                   {"", "model", "", true},
                   {"", "cable", "", true},
                   {"", "deflection", unit_for(axes, "mrad")},
                   {"", "elastic torque", torque_unit(axes)},
                   {"", "slack", "", true}};
  for (const ElasticPreload& preload : result.preloads) {
    for (const ElasticFit& fit : preload.fits) {
      if (!is_preloaded(fit.transmission)) continue;
      if (fit.transmission.n_joints > 1) continue;  // a pose, not one deflection, makes them slack
      table.notes.push_back(balance_text(preload, fit));
      for (const SlackPoint& point :
           slack_points(fit.transmission, preload.deflection_low, preload.deflection_high)) {
        table.rows.push_back({preload.name, fit.model, fit.transmission.cables[point.cable].name,
                              significant(1e3 * point.deflection, kDigits),
                              significant(point.motor, kDigits),
                              point.slack_above ? "above" : "below"});
      }
    }
  }
  return table;
}

Table sd_table(const ElasticResult& result) {
  Table table = both_sd_table({"preload", "model"});
  for (const ElasticPreload& preload : result.preloads)
    for (const ElasticFit& fit : preload.fits)
      add_sd_rows(table, {preload.name, fit.model}, fit.parameters);
  return table;
}

void add_tidy_rows(Table& table, const ElasticPreload& preload, const ElasticFit& fit) {
  const std::string method = order_text(fit);
  for (const Estimate& e : fit.parameters) add_tidy(table, preload.name, fit.model, method, e);
  for (const Estimate& e : fit.derived) add_tidy(table, preload.name, fit.model, method, e);
  const auto add = [&](const char* name, const std::string& unit, double value) {
    add_tidy_number(table, preload.name, fit.model, method, name, unit, value);
  };
  const std::string torque = torque_unit(preload.axes);
  add("rms_error", torque, fit.rms_error);
  add("max_abs_error", torque, fit.max_abs_error);
  add("held_out_rms", torque, fit.held_out_rms);
  add("held_out_max", torque, fit.held_out_max);
  add("deflection_low", preload.unit, preload.deflection_low);
  add("deflection_high", preload.unit, preload.deflection_high);
}

/// What to take, and by how much it is better.
SummaryLine answer_of(const ElasticPreload& preload) {
  const std::string torque = torque_unit(preload.axes);
  std::string text, others;
  for (const ElasticFit& fit : preload.fits) {
    const std::string error = fmt::format("{} {}", error_text(fit.held_out_max), torque);
    if (fit.model == preload.selected || preload.fits.size() == 1)
      text =
          fmt::format("use {}: its largest error on held-out blocks is {}", model_text(fit), error);
    else
      others += fmt::format("{}{} {}", others.empty() ? "" : ", ", model_text(fit), error);
  }
  if (!others.empty()) text += fmt::format(" ({})", others);
  return {preload.name, text};
}

Headline headline_of(const ElasticResult& result) {
  constexpr std::size_t kMostNumbers = 3;
  Headline headline{"fitted", Tone::good, "", {}};
  for (const ElasticPreload& preload : result.preloads) {
    const ElasticFit* fit = preload.find(preload.selected);
    if (fit == nullptr) continue;
    if (!fit->passive || !preload.shape_doubt.empty()) {
      headline.word = fit->passive ? "doubtful" : "not physical";
      headline.tone = Tone::bad;
    }
    headline.verdict += fmt::format("{}{}: use {}", headline.verdict.empty() ? "" : "; ",
                                    preload.name, model_text(*fit));
    if (headline.numbers.size() < kMostNumbers)
      headline.numbers.push_back(
          {fmt::format("largest error on held-out blocks, {}", preload.name),
           fmt::format("{} {}", error_text(fit->held_out_max), torque_unit(preload.axes))});
  }
  return headline;
}

/// Initial elongations and motor radii that were searched, and how often all cables are taut; no
/// lines without.
void add_elongations(const ElasticPreload& preload, Document& document) {
  if (preload.fits.empty()) return;
  const ElasticFit& cables =
      preload.fits.back();  // the straight line, where there is one, is first
  std::string found = elongations_text(cables.parameters);
  for (const Estimate& e : cables.parameters)
    if (e.name.starts_with("r_m["))
      found += fmt::format("{}{} = {} {}", found.empty() ? "" : ", ", e.name,
                           value_with_sd(e.value, e.sd), e.unit);
  if (!found.empty()) document.summary.push_back({"", found});
  if (is_preloaded(cables.transmission)) document.summary.push_back({"", modes_text(preload)});
}

}  // namespace

Document elastic_document(const ElasticResult& result) {
  Document document;
  document.title = "Stage 1, link blocked: elastic torque against deflection theta - q";
  document.tidy = tidy_table();
  Table counts = counts_table(), derived = derived_table();
  add_warnings(document, "", result.warnings);
  for (const ElasticPreload& preload : result.preloads) {
    add_counts(counts, preload.name, "blocked", preload.counts, preload.windows);
    document.summary.push_back(answer_of(preload));
    add_elongations(preload, document);
    add_decisions(document, preload.name, preload.decisions);
    for (const std::string& words : preload.selection) {
      document.paragraphs.push_back(preload.name + ": " + words);
    }
    add_warnings(document, preload.name, preload.warnings);
    add_figures(document, preload.figures);
    for (const ElasticFit& fit : preload.fits) {
      if (fit.transmission.n_joints > 1 && is_preloaded(fit.transmission))
        document.paragraphs.push_back(balance_text(preload, fit));
      add_warnings(document, preload.name + ", " + fit.model, fit.warnings);
      add_tidy_rows(document.tidy, preload, fit);
      add_derived(derived, preload.name + ", " + fit.model, fit.derived);
    }
  }
  finish_decisions(document, result.preloads.size());
  document.headline = headline_of(result);
  lead_with(document, 1);
  document.tables = stiffness_tables(result);
  add_table(document, scores_table(result));
  add_table(document, bases_table(result));
  add_detail(document, fits_table(result));
  add_detail(document, slack_table(result));
  for (const ElasticPreload& preload : result.preloads)
    for (const ElasticFit& fit : preload.fits)
      if (fit.proof)
        add_table(document,
                  proof_table(fmt::format("{}, {}", preload.name, fit.model), *fit.proof));
  add_detail(document, std::move(derived));
  add_detail(document, sd_table(result));
  add_detail(document, std::move(counts));
  return document;
}

}  // namespace cablefit
