#include "cablefit/log/log_reader.hpp"

#include <utility>

#include "cablefit/log/byte_source.hpp"
#include "cablefit/log/log_formats.hpp"

namespace cablefit {
namespace {

void check_is_text(std::string_view head, const std::string& path) {
  if (head.empty()) {
    throw input_error({path}, "file is empty", "give a log with a header line and samples");
  }
  if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff")) {
    throw input_error({path}, "is UTF-16", "save it as UTF-8");
  }
  if (head.find('\0') != std::string_view::npos) {
    throw input_error({path}, "is not text",
                      "give CSV or JSON in UTF-8, plain or packed by gzip or zstd");
  }
}

std::unique_ptr<LogReader> open_unpacked(std::unique_ptr<PeekableSource> source,
                                         const std::string& path, const LogText& text) {
  const std::string_view head = source->peek(kHeadBytes);
  check_is_text(head, path);
  for (const LogFormatRow& row : log_format_rows()) {
    if (row.format.recognises(head)) return row.open(std::move(source), path, text);
  }
  throw input_error({path}, "format is not known", "give CSV or JSON");
}

}  // namespace

bool LogReader::next(LogChunk& chunk) {
  while (const std::unique_ptr<LogPiece> piece = take()) {
    piece->parse();
    finish(*piece, chunk);
    if (chunk.n_rows > 0) return true;
  }
  return false;
}

std::unique_ptr<LogReader> open_log(const std::string& path, const LogText& text, Sha256* digest) {
  return open_unpacked(open_bytes(path, digest), path, text);
}

std::unique_ptr<LogReader> open_log(std::unique_ptr<ByteSource> bytes, const std::string& path,
                                    const LogText& text) {
  return open_unpacked(unpacked(std::move(bytes), path), path, text);
}

}  // namespace cablefit
