#include "cablefit/report/writers/study_json.hpp"

#include <nlohmann/json.hpp>

#include "cablefit/results/write/json_list.hpp"
#include "cablefit/results/write/json_parts.hpp"

namespace cablefit {

namespace {

using result_json::Json;
using result_json::list_of;

Json not_done_json(const Study::NotDone& stage) {
  return Json{{"stage", stage.stage}, {"reason", stage.reason}};
}

Json missing_json(const Study::Missing& missing) {
  return Json{{"preload", missing.preload}, {"verdict", to_string(missing.result.verdict)}};
}

Json line_json(const SummaryLine& line) { return Json{{"label", line.label}, {"text", line.text}}; }

}  // namespace

std::string study_json(const Study& study, const Document& document,
                       const std::vector<std::string>& files) {
  std::vector<InputFile> inputs;
  if (study.check)
    for (const CheckedLog& log : study.check->logs)
      inputs.push_back({log.path, log.sha256, log.rows});
  for (const Study::Missing& missing : study.refine)  // has read the test logs too
    for (const InputFile& input : missing.result.inputs)
      if (std::none_of(inputs.begin(), inputs.end(),
                       [&](const InputFile& other) { return other.path == input.path; }))
        inputs.push_back(input);
  Json json = result_json::header("study", inputs, document.warnings);
  json["files"] = files;
  json["verdicts"] = list_of(study.refine, missing_json);
  json["not_done"] = list_of(study.not_done, not_done_json);
  json["summary"] = list_of(document.summary, line_json);
  return result_json::text(json);
}

}  // namespace cablefit
