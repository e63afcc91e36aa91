#include "cablefit/report/documents/study_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

#include "cablefit/report/documents/check_document.hpp"
#include "cablefit/report/documents/dynamic_document.hpp"
#include "cablefit/report/documents/elastic_document.hpp"
#include "cablefit/report/documents/identify_document.hpp"
#include "cablefit/report/documents/refine_document.hpp"
#include "cablefit/report/parts/document_parts.hpp"

namespace cablefit {
namespace {

/// "3 files: 1 part with the link blocked, 2 moving".
std::string logs_text(const CheckResult& check) {
  std::size_t blocked = 0, moving = 0;
  for (const CheckedLog& log : check.logs)
    for (const CheckedPart& part : log.parts)
      (part.survey.phase == Phase::blocked ? blocked : moving) += 1;
  return fmt::format("{} file{}: {} part{} with the link blocked, {} moving", check.logs.size(),
                     check.logs.size() == 1 ? "" : "s", blocked, blocked == 1 ? "" : "s", moving);
}

/// Under one label what a stage answers of each preload; what stands beside an answer, with a label
/// that is indented, is left to the stage's own command.
void add_answers(const std::string& label, std::size_t n_preloads, const Document& stage,
                 Document& document) {
  bool is_first = true;
  for (const SummaryLine& line : stage.summary) {
    if (line.label.starts_with(' ')) continue;
    const bool needs_name = n_preloads > 1 && !line.label.empty();
    document.summary.push_back(
        {is_first ? label : "", (needs_name ? line.label + ": " : "") + line.text});
    is_first = false;
  }
}

/// Of refine what a reader acts upon. `of`: "low: ", or nothing.
void add_verdict(const Document& refine, const std::string& of, bool is_named, Document& document) {
  for (const SummaryLine& line : refine.summary)
    if (line.label == "verdict")
      document.summary.push_back({"missing", of + line.text});
    else if (line.label == "next run")
      document.summary.push_back({"record next", of + line.text});
    else if (is_named && (line.label == "effect" || line.label == "gap"))
      document.summary.push_back({line.label, of + line.text});
}

/// What is left to do, of several answers: a green one is the least.
int urgency(const Headline& headline) {
  switch (headline.tone) {
    case Tone::good:
      return 0;
    case Tone::neutral:
      return 1;
    case Tone::bad:
      break;
  }
  return 2;
}

/// The verdict of refine above the numbers of the fits; of several preloads the one that asks most
/// of the reader.
void add_missing(const Headline& refine, const std::string& of, bool is_first, Headline& headline) {
  if (!is_first && urgency(refine) <= urgency(headline)) return;
  headline.word = refine.word;
  headline.tone = refine.tone;
  headline.verdict = of + refine.verdict;
}

/// The stages' tables, plots and warnings, behind each other.
class Appendix {
 public:
  /// The page begins with the plot of the stage `leader`.
  Appendix(Document& document, std::string leader)
      : document_(document), leader_(std::move(leader)) {}

  /// `is_shown`: its tables and plots are not all details, but for its main plots. `own_sections`:
  /// another stage has plots of the same titles.
  void add(const std::string& name, Document stage, bool is_shown, bool own_sections = false) {
    for (Figure& figure : stage.figures)
      if (figure.rank == FigureRank::main && name != leader_)
        figure.rank = FigureRank::shown;
      else if (!is_shown)
        figure.rank = FigureRank::detail;
    if (own_sections)
      for (Figure& figure : stage.figures)
        figure.section = fmt::format("{}: {}", name, figure.section);
    for (Table& table : stage.tables) {
      table.detail = table.detail || !is_shown;
      if (!table.title.empty()) table.title = fmt::format("{}: {}", name, table.title);
      std::erase_if(table.notes, [](const std::string& note) { return note.starts_with("rsd: "); });
    }
    warnings_.emplace_back();
    for (const std::string& warning : stage.warnings)
      if (known_.insert(warning).second)  // each stage repeats those of a log
        warnings_.back().push_back(fmt::format("{}: {}", name, warning));
    stage.warnings.clear();
    append(document_, stage);
  }

  /// The first of each stage, the second of each, ...: a screen shows the first ones.
  void add_warnings() {
    std::size_t most = 0;
    for (const auto& some : warnings_) most = std::max(most, some.size());
    for (std::size_t k = 0; k < most; ++k)
      for (const auto& some : warnings_)
        if (k < some.size()) document_.warnings.push_back(some[k]);
  }

 private:
  Document& document_;
  std::string leader_;
  std::vector<std::vector<std::string>> warnings_;
  std::set<std::string> known_;
};

}  // namespace

Document study_document(const Study& study, const std::vector<std::string>& model_files) {
  Document document;
  document.title = "Study of the logs: stiffness, inertia, friction, and what is missing";
  Appendix appendix(document, study.dynamic ? "stage 2" : study.elastic ? "stage 1" : "check");
  if (study.check) {
    document.summary.push_back({"logs", logs_text(*study.check)});
    Document stage = check_document(*study.check, study.predictions);
    document.headline = stage.headline;
    lead_with(stage, study.dynamic || study.elastic ? 0 : 1);
    stage.tidy = {};  // channels and predictions, where the other stages have estimates
    appendix.add("check", std::move(stage), false);
  }
  if (study.elastic) {
    Document stage = elastic_document(*study.elastic);
    for (Table& table : stage.tables) table.is_optional = study.dynamic.has_value();
    document.headline = stage.headline;
    add_answers("stiffness", study.elastic->preloads.size(), stage, document);
    appendix.add("stage 1", stage, true);
  }
  if (study.dynamic) {
    const Document stage = dynamic_document(*study.dynamic);
    document.headline = stage.headline;
    add_answers("dynamics", study.dynamic->preloads.size(), stage, document);
    appendix.add("stage 2", stage, true);
  }
  if (study.identify) {
    const Document stage = identify_document(*study.identify);
    if (!study.dynamic) add_answers("one step", study.identify->preloads.size(), stage, document);
    appendix.add("one step", stage, !study.dynamic);
  }
  for (std::size_t k = 0; k < study.refine.size(); ++k) {
    const Study::Missing& missing = study.refine[k];
    const Document stage = refine_document(missing.result, {model_files[k]});
    const bool several = study.refine.size() > 1;
    const std::string of = several ? missing.preload + ": " : "";
    add_missing(stage.headline, of, k == 0, document.headline);
    add_verdict(stage, of, !missing.result.effects.empty(), document);
    appendix.add(several ? "refine of " + missing.preload : "refine", stage, false, several);
  }
  appendix.add_warnings();
  for (const Study::NotDone& stage : study.not_done)
    document.summary.push_back({stage.stage, "not done: " + stage.reason});
  return document;
}

}  // namespace cablefit
