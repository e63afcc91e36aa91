#include "cablefit/log/csv_selection.hpp"

#include <utility>

namespace cablefit {

CsvSelection::CsvSelection(const std::vector<ColumnHeader>& columns,
                           std::vector<std::size_t> numbers, std::vector<std::size_t> texts)
    : numbers_(std::move(numbers)), texts_(std::move(texts)), targets_(columns.size()) {
  for (std::size_t k = 0; k < columns.size(); ++k) targets_[k].is_date = columns[k].is_date;
  // Backwards, so that the first request for a column is the one that stays.
  for (std::size_t k = numbers_.size(); k-- > 0;) targets_.at(numbers_[k]).number = k;
  for (std::size_t k = texts_.size(); k-- > 0;) targets_.at(texts_[k]).text = k;
}

void CsvSelection::copy_repeats(LogChunk& chunk) const {
  for (std::size_t k = 0; k < numbers_.size(); ++k) {
    const std::size_t origin = targets_[numbers_[k]].number;
    if (origin != k) chunk.numbers[k] = chunk.numbers[origin];
  }
  for (std::size_t k = 0; k < texts_.size(); ++k) {
    if (text_origin(k) != k) chunk.texts[k] = chunk.texts[text_origin(k)];
  }
}

}  // namespace cablefit
