// Reads the header line of a CSV log.
#pragma once

#include "cablefit/log/csv_dialect.hpp"
#include "cablefit/log/line_buffer.hpp"

namespace cablefit {

struct CsvHeader {
  LogHeader log;
  Delimiter delimiter = Delimiter::comma;
};

/// Takes lines up to and including the header line. Throws Error(input) when there is none, or
/// none that names the columns.
CsvHeader read_csv_header(LineBuffer& lines, const std::string& path);

}  // namespace cablefit
