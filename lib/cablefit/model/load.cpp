#include "cablefit/model/load.hpp"

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/model/load/laws.hpp"

namespace cablefit {
namespace {

const std::vector<LoadLaw>& table() {
  static const std::vector<LoadLaw> kRows{laws::column(),   laws::constant(), laws::hanging_mass(),
                                          laws::pendulum(), laws::table(),    laws::none()};
  return kRows;
}

}  // namespace

std::span<const LoadLaw> load_laws() { return table(); }

const LoadLaw& find_load_law(std::string_view name) {
  std::vector<std::string_view> known;
  for (const LoadLaw& law : load_laws()) {
    if (law.name == name) return law;
    known.push_back(law.name);
  }
  throw input_error({}, "unknown load '" + std::string(name) + "'", suggestion(name, known));
}

}  // namespace cablefit
