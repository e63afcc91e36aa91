// The part of reading a campaign that needs more than its text: what is on disk, and which
// estimators there are.
#include <fmt/format.h>
#include <glob.h>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/campaign/campaign.hpp"
#include "cablefit/dynamic/estimators/estimators.hpp"

namespace cablefit {
namespace {

std::vector<std::string> files_on_disk(const std::string& pattern) {
  glob_t found{};
  std::vector<std::string> paths;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
    paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  return paths;
}

void require_estimator(const JsonNode& node) {
  std::vector<std::string_view> known;
  for (const Estimator& estimator : estimators()) {
    if (estimator.name == node.text()) return;
    known.push_back(estimator.name);
  }
  throw node.error(fmt::format("unknown estimator {}", in_quotes(node.text())),
                   suggestion(node.text(), known));
}

}  // namespace

Campaign read_campaign(const std::string& path) {
  const JsonNode root = read_json_file(path);
  Campaign campaign = parse_campaign(root, files_on_disk);
  if (const JsonNode* estimator = root.find("estimator")) require_estimator(*estimator);
  return campaign;
}

}  // namespace cablefit
