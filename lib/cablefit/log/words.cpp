#include "cablefit/log/words.hpp"

#include <fmt/format.h>

#include "cablefit/base/quote.hpp"

namespace cablefit {

std::uint32_t Words::find_or_add(std::string_view word) {
  if (const auto found = indices_.find(word); found != indices_.end()) return found->second;
  const auto index = static_cast<std::uint32_t>(list_.size());
  list_.emplace_back(word);
  n_bytes_ += word.size();
  indices_.emplace(word, index);
  return index;
}

Error too_many_words(const ColumnHeader& column) {
  return input_error(column.place,
                     fmt::format("column {} holds more than {} different texts, or 16 MiB of them",
                                 in_quotes(column.name), Words::kMaxWords - 1),
                     "use a column of labels, one per run");
}

}  // namespace cablefit
