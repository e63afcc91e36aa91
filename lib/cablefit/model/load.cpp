#include "cablefit/model/load.hpp"

#include "cablefit/base/catalog.hpp"
#include "cablefit/model/load/laws.hpp"

namespace cablefit {
namespace {

const std::vector<LoadLaw>& load_law_rows() {
  static const std::vector<LoadLaw> kRows{laws::column(),   laws::constant(), laws::hanging_mass(),
                                          laws::pendulum(), laws::table(),    laws::none()};
  return kRows;
}

}  // namespace

std::span<const LoadLaw> load_laws() { return load_law_rows(); }

const LoadLaw& find_load_law(std::string_view name) { return find_row(load_laws(), "load", name); }

}  // namespace cablefit
