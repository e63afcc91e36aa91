// The "schema" of each kind of file.
#pragma once

#include <string_view>

namespace cablefit {

inline constexpr std::string_view kRigSchema = "cablefit/rig/1";
inline constexpr std::string_view kModelSchema = "cablefit/model/1";
inline constexpr std::string_view kElasticSchema = "cablefit/elastic/1";
inline constexpr std::string_view kDynamicSchema = "cablefit/dynamic/1";
inline constexpr std::string_view kIdentifySchema = "cablefit/identify/1";
inline constexpr std::string_view kBatchSchema = "cablefit/batch/1";
inline constexpr std::string_view kCampaignSchema = "cablefit/campaign/1";

}  // namespace cablefit
