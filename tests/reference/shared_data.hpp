// Real logs that lie beside the project (data/README.md there); tests go without when they do not.
#pragma once

#include <filesystem>

#include "tests/support/recover.hpp"

namespace cablefit::test {

/// Path of a shared file; empty, with a printed word, when it is not there.
inline std::string shared_file(const std::string& name) {
  const std::string path = std::string(CABLEFIT_SHARED_DATA) + '/' + name;
  if (std::filesystem::exists(path)) return path;
  WARN("skipped: " << path << " is not there");
  return "";
}

/// The settings of the EMPS authors.
inline DynamicOptions emps_options() {
  DynamicOptions options;
  options.models = {"rigid"};
  options.estimator = "ols";
  options.samples.cutoff = 100;
  options.samples.filter_order = 4;
  options.samples.decimate = 10;
  options.samples.drop_edge = 49;
  options.samples.rest_speed = 0;
  options.samples.torque_hold = TorqueHold::none;
  return options;
}

}  // namespace cablefit::test
