// Reads the header line of a CSV log.
#pragma once

#include "cablefit/log/csv_dialect.hpp"
#include "cablefit/log/line_buffer.hpp"

namespace cablefit {

struct CsvHeader {
  LogHeader log;
  Delimiter delimiter = Delimiter::comma;
  long date_origin = 0;  ///< day that columns of dates count from
};

/// Takes lines up to and including the header line, and a row of units behind it where `text` says
/// so. Throws Error(input) when there is none, or none that names the columns.
CsvHeader read_csv_header(LineBuffer& lines, const std::string& path, const LogText& text);

}  // namespace cablefit
