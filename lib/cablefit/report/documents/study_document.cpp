#include "cablefit/report/documents/study_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cablefit/report/documents/check_document.hpp"
#include "cablefit/report/documents/document_parts.hpp"
#include "cablefit/report/documents/dynamic_document.hpp"
#include "cablefit/report/documents/elastic_document.hpp"
#include "cablefit/report/documents/identify_document.hpp"
#include "cablefit/report/documents/refine_document.hpp"

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

/// Of refine what a reader acts upon.
void add_verdict(const Document& refine, bool is_named, Document& document) {
  for (const SummaryLine& line : refine.summary)
    if (line.label == "verdict")
      document.summary.push_back({"missing", line.text});
    else if (line.label == "next run")
      document.summary.push_back({"record next", line.text});
    else if (is_named && (line.label == "effect" || line.label == "gap"))
      document.summary.push_back(line);
}

/// `shown`: of its tables on the screen; the others are details.
void append_stage(const std::string& name, Document stage, std::size_t shown, Document& document) {
  for (std::size_t k = 0; k < stage.tables.size(); ++k) {
    Table& table = stage.tables[k];
    table.detail = table.detail || k >= shown;
    if (!table.title.empty()) table.title = fmt::format("{}: {}", name, table.title);
    std::erase_if(table.notes, [](const std::string& note) { return note.starts_with("rsd: "); });
  }
  stage.summary.clear();
  for (std::string& warning : stage.warnings) warning = fmt::format("{}: {}", name, warning);
  append(document, stage);
}

}  // namespace

Document study_document(const Study& study, const std::vector<std::string>& model_files) {
  Document document;
  document.title = "Study of the logs: how stiff, how heavy, how rough, and what is missing";
  document.summary.push_back({"logs", logs_text(study.check)});
  append_stage("check", check_document(study.check, study.predictions), 0, document);
  if (study.elastic) {
    const Document stage = elastic_document(*study.elastic);
    add_answers("stiffness", study.elastic->preloads.size(), stage, document);
    append_stage("stage 1", stage, 1, document);
  }
  if (study.dynamic) {
    const Document stage = dynamic_document(*study.dynamic);
    add_answers("dynamics", study.dynamic->preloads.size(), stage, document);
    append_stage("stage 2", stage, 1, document);
  }
  if (study.identify) {
    const Document stage = identify_document(*study.identify);
    if (!study.dynamic) add_answers("one step", study.identify->preloads.size(), stage, document);
    append_stage("one step", stage, study.dynamic ? 0 : 2, document);
  }
  if (study.refine) {
    const Document stage = refine_document(*study.refine, model_files);
    add_verdict(stage, !study.refine->effects.empty(), document);
    append_stage("refine", stage, 0, document);
  }
  for (const Study::NotDone& stage : study.not_done)
    document.summary.push_back({stage.stage, "not done: " + stage.reason});
  return document;
}

}  // namespace cablefit
