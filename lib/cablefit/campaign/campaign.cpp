#include "cablefit/campaign/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/error.hpp"
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/json/schemas.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/campaign/plan/campaign_cell.hpp"
#include "cablefit/model/effects/effect_names.hpp"

namespace cablefit {
namespace {

CampaignLimits read_limits(const JsonNode& node) {
  node.allow_only({"rsd_percent", "torque_error", "drift", "new_effect"});
  CampaignLimits limits;
  if (const JsonNode* rsd = node.find("rsd_percent")) limits.rsd_percent = rsd->positive();
  if (const JsonNode* error = node.find("torque_error")) limits.torque_error = error->positive();
  if (const JsonNode* effect = node.find("new_effect")) limits.new_effect = effect->boolean();
  if (const JsonNode* drift = node.find("drift")) {
    drift->allow_only({"baseline", "percent"});
    limits.drift_baseline = beside(node.place.file, drift->at("baseline").text());
    limits.drift_percent = drift->at("percent").positive();
  }
  return limits;
}

void read_models(const JsonNode& node, Campaign& campaign) {
  campaign.models.clear();
  for (const JsonNode& item : node.items) {
    const std::string& model = item.text();
    if (model != "linear" && model != "poly")
      throw item.error(fmt::format("unknown model {}", in_quotes(model)), "known: linear, poly");
    campaign.models.push_back(model);
  }
  if (campaign.models.empty())
    throw node.error("'models' is empty", "write [\"linear\", \"poly\"]");
}

/// The equations of a straight spring leave more than any of them explains.
void read_effects(const JsonNode& node, Campaign& campaign) {
  for (const std::string& name : node.texts()) {
    const JsonNode& item = node.items[campaign.effects.size()];
    try {
      (void)wanted_effect(name);
    } catch (const Error& error) {
      throw item.error(error.what(), "see 'cablefit list effects'");
    }
    if (std::find(campaign.effects.begin(), campaign.effects.end(), name) != campaign.effects.end())
      throw item.error(fmt::format("effect {} is given twice", in_quotes(name)), "leave one out");
    campaign.effects.push_back(name);
  }
  if (!campaign.effects.empty() && campaign.models != std::vector<std::string>{"poly"})
    throw node.error("'effects' are fitted in one model", "write \"models\": [\"poly\"]");
}

}  // namespace

Campaign parse_campaign(const JsonNode& root, const FindFiles& find_files) {
  root.allow_only({"schema", "name", "cells", "models", "estimator", "effects", "limits"});
  const JsonNode& schema = root.at("schema");
  if (schema.text() != kCampaignSchema)
    throw schema.error(fmt::format("'schema' is {}, not a campaign", in_quotes(schema.text())),
                       fmt::format("a campaign file says \"{}\"", kCampaignSchema));
  Campaign campaign;
  campaign.path = root.place.file;
  if (const JsonNode* name = root.find("name")) campaign.name = name->text();
  if (const JsonNode* models = root.find("models")) read_models(*models, campaign);
  if (const JsonNode* estimator = root.find("estimator")) campaign.estimator = estimator->text();
  if (const JsonNode* effects = root.find("effects")) read_effects(*effects, campaign);
  if (const JsonNode* limits = root.find("limits")) campaign.limits = read_limits(*limits);
  campaign.cells = read_cells(root.at("cells"), find_files);
  return campaign;
}

}  // namespace cablefit
