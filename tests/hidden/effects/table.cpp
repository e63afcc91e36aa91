#include <cmath>
#include <stdexcept>

#include "effects.hpp"

namespace hidden {

const std::vector<Row>& all_rows() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all;
    for (const auto part : {friction_rows(), drive_rows(), transmission_rows(), sensor_rows(),
                            event_rows(), outside_rows(), outside_law_rows()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return rows;
}

std::string id_of(const Row& row) {
  std::string id = std::string(row.name) + '.' + std::string(row.side);
  return row.variant.empty() ? id : id + '.' + std::string(row.variant);
}

const Row& row_of(std::string_view id) {
  std::string known;
  for (const Row& row : all_rows()) {
    if (id_of(row) == id) return row;
    known += ' ' + id_of(row);
  }
  throw std::invalid_argument("no effect '" + std::string(id) + "'; there are:" + known);
}

std::string_view to_string(Form form) {
  return form == Form::matched ? "matched" : form == Form::other ? "other" : "outside";
}

double value_at(const std::vector<double>& path, double t) {
  const double at = (t + 1) * kRate;
  const auto k = static_cast<std::size_t>(at);
  const double share = at - static_cast<double>(k);
  return (1 - share) * path[k] + share * path[k + 1];
}

double saturating(double t, double T) { return t > 0 ? 1 - std::exp(-t / T) : 0; }

}  // namespace hidden
