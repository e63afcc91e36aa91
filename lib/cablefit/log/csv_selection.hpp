// Which cells of a CSV row are wanted, and where they go.
#pragma once

#include <cstddef>
#include <vector>

#include "cablefit/log/log_reader.hpp"

namespace cablefit {

class CsvSelection {
 public:
  static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

  /// What is done with the cells of one column: the array of LogChunk they go to.
  struct Target {
    std::size_t number = kNowhere;
    std::size_t text = kNowhere;
    bool is_date = false;
  };

  CsvSelection(const std::vector<ColumnHeader>& columns, std::vector<std::size_t> numbers,
               std::vector<std::size_t> texts);

  const std::vector<Target>& targets() const { return targets_; }
  const std::vector<std::size_t>& numbers() const { return numbers_; }
  const std::vector<std::size_t>& texts() const { return texts_; }
  /// The array that text array `k` is a copy of: itself unless its column was selected before.
  std::size_t text_origin(std::size_t k) const { return targets_[texts_[k]].text; }
  /// Fills the arrays of columns that were selected more than once.
  void copy_repeats(LogChunk& chunk) const;

 private:
  std::vector<std::size_t> numbers_;
  std::vector<std::size_t> texts_;
  std::vector<Target> targets_;  // per column
};

}  // namespace cablefit
