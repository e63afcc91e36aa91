// A value of the rig file that is wrong, as several joints together show it, and the results of
// refine with the right value. To add one: one file, one line in rig_error.cpp, one row in
// model/catalogue/rig_errors.cpp. Internal to refine/.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

struct RigErrorSearch;

/// Of its sd: a value that changes less has settled.
inline constexpr double kSettledSd = 0.1;

struct WrongValue {
  std::string name;                ///< as that of a rival: "cable_radius[flexor]"
  EffectInstance instance;         ///< the right values; its row is one of rig_errors()
  std::vector<Estimate> given;     ///< the values of the rig file
  std::optional<int> joint;        ///< from 0, whose result lists it; none: whose gap falls most
  double chance = 1;               ///< of such a difference where the rig file is right
  double share = 0;                ///< of the squared residual that the right values remove
  std::vector<Rival> rivals = {};  ///< errors that explain the logs as well
  std::string reason;              ///< for the verdict
};

/// Values of one kind that were fitted together. Mostly there is one.
struct RigError {
  std::vector<WrongValue> values;
  std::function<void(Rig&)> change;  ///< gives a rig the right values
  std::vector<Model> models;         ///< those given to refine, with the right values
  /// The same values again, where `given` of the search has them and others right. Nothing where
  /// they are not determined.
  std::function<std::optional<RigError>(const RigErrorSearch&)> again = {};
  /// These values and one more of their kind, fitted together, where that explains more. Empty: not
  /// of this kind.
  std::function<std::optional<RigError>(const RigErrorSearch&)> with_one_more = {};
};

/// What the search for such an error starts from.
struct RigErrorSearch {
  std::span<const Model> given;      ///< models given to refine, one per preload
  const std::vector<Model>& fitted;  ///< the same with base fits of all joints
  const RefineLogs& logs;
  double significance = 0;
  int threads = 1;
  std::span<const WrongValue* const> found = {};  ///< they are right in `given`
  std::size_t n_most = 1;                         ///< so many more may be the answer

  /// Whether this value is found. `joint`: none where there is one for all joints.
  bool has(std::string_view name, Site site, std::optional<int> joint) const;
};

/// Errors that are significant, of as few values as possible, by the share of the residual that the
/// first of these removes, largest first.
std::vector<RigError> rig_errors_of(const RigErrorSearch& search);

/// The row of rig_errors() of this name and side.
const Effect& rig_error_row(std::string_view name, Site site);

/// Logs of a rig that `change` changes.
RefineLogs with_rig(RefineLogs logs, const std::function<void(Rig&)>& change);

/// Masses of coupled links as stage 2 finds them with the rig of these logs: no single joint
/// determines all of them. False: the logs do not determine them, and the models are as before.
bool take_arm(const RefineLogs& logs, int threads, std::vector<Model>& models);

/// Whether so many right values could be the answer at all, whatever they leave.
bool may_explain(const std::vector<RefineResult>& given, std::size_t n_values);

/// Whether so many right values explain the logs as well as the effects that were identified with
/// the given ones. `given`, `right`: results of each joint with either.
bool is_explained(const std::vector<RefineResult>& given, const std::vector<RefineResult>& right,
                  std::size_t n_values);

/// The joint (from 0) whose result lists the value.
int listing_joint(const WrongValue& value, const std::vector<RefineResult>& given,
                  const std::vector<RefineResult>& right);

/// Adds the values to the results with all of them right. Gaps before are those with the given
/// ones.
void name_rig_errors(const std::vector<WrongValue>& values, const std::vector<RefineResult>& given,
                     std::vector<RefineResult>& right);

}  // namespace cablefit
