// Says what is wrong with a CSV line that could not be read.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "cablefit/log/csv_dialect.hpp"

namespace cablefit {

struct CsvLine {
  std::string_view text;
  std::uint64_t number = 0;
};

/// The error for a row that is ragged or has no number in one of the `numbers` columns, of which
/// cells may miss or not.
Error row_complaint(const CsvLine& line, const LogHeader& header, Delimiter delimiter,
                    const std::vector<std::size_t>& numbers, bool may_miss);

}  // namespace cablefit
