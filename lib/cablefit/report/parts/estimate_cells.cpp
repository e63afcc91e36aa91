#include "cablefit/report/parts/estimate_cells.hpp"

#include <fmt/format.h>

#include "cablefit/report/parts/numbers.hpp"

namespace cablefit {
namespace {

std::string bound_note(const Estimate& e) {
  return fmt::format("at its bound {}: 95 % interval up to {} {}", e.active_bound,
                     significant(e.ci_high, kRsdDigits), e.unit);
}

EstimateCells known_cells(const Estimate& e) {
  return {value_text(e.value, e.sd), significant(e.rsd_percent(), kRsdDigits)};
}

}  // namespace

EstimateCells cells_of(const Estimate* e, Footnotes& notes) {
  if (e == nullptr) return {kNoNumber, ""};
  if (!e->not_identifiable.empty())
    return {kNoNumber, notes.mark("not identifiable: " + e->not_identifiable)};
  if (!e->active_bound.empty())
    return {significant(e->value, kRsdDigits), notes.mark(bound_note(*e))};
  return known_cells(*e);
}

EstimateCells cells_without_load(const Estimate* e, double load_inertia) {
  if (e == nullptr || !e->not_identifiable.empty()) return {kNoNumber, ""};
  Estimate net = *e;
  net.value -= load_inertia;
  return known_cells(net);
}

}  // namespace cablefit
