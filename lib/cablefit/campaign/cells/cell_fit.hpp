// The fit of one cell: stage 1, stage 2, and refine where it is asked for. Internal to campaign/.
#pragma once

#include "cablefit/campaign/cells/cell_key.hpp"

namespace cablefit {

/// Throws as the fits do, and Error(input) for a log whose content is no longer that of `key`.
/// Where refine gives no verdict, `error` has the reason.
CellResults fit_cell(const Campaign& campaign, const CampaignCell& cell, const CellKey& key,
                     const BatchOptions& options);

/// The fit that stands for a cell: stage 1's choice when it was fitted, else the last (richest).
/// nullptr when there is none.
const DynamicFit* chosen_fit(const ElasticResult& elastic, const DynamicPreload& preload);

}  // namespace cablefit
