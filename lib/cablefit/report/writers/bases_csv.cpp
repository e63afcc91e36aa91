#include "cablefit/report/writers/bases_csv.hpp"

#include <fmt/format.h>

#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/escape.hpp"

namespace cablefit {

std::string bases_csv(const ElasticResult& result) {
  std::string text;
  for (const ElasticPreload& preload : result.preloads) {
    if (!preload.bases) continue;
    const std::vector<BasisScore>& scores = preload.bases->scores;
    if (text.empty()) {
      text = fmt::format("preload,deflection [{}]", preload.unit);
      for (const BasisScore& score : scores)
        text += fmt::format(",{0} torque [{1}],{0} stiffness [{1}/{2}]", score.basis,
                            torque_unit(preload.axes), preload.unit);
      text += '\n';
    }
    for (std::size_t i = 0; i < scores.front().curve.deflection.size(); ++i) {
      text += fmt::format("{},{:.17g}", csv_cell(preload.name), scores.front().curve.deflection[i]);
      for (const BasisScore& score : scores)
        text += fmt::format(",{:.17g},{:.17g}", score.curve.torque[i], score.curve.stiffness[i]);
      text += '\n';
    }
  }
  return text;
}

}  // namespace cablefit
