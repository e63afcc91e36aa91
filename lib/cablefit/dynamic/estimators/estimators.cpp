#include "cablefit/dynamic/estimators/estimators.hpp"

#include <array>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/estimators/rows.hpp"

namespace cablefit {
namespace {

const std::vector<Estimator>& table() {
  static const std::vector<Estimator> rows = {estimation::automatic(),    estimation::ols(),
                                              estimation::wls(),          estimation::iv(),
                                              estimation::output_error(), estimation::robust(),
                                              estimation::recursive(),    estimation::gradient()};
  return rows;
}

}  // namespace

std::span<const Estimator> estimators() { return table(); }

const Estimator& find_estimator(std::string_view name) {
  return find_row(estimators(), "estimator", name);
}

}  // namespace cablefit
