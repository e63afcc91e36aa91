// The lines of a text in blocks of memory: no copy of a line is made, only the part of a line that
// a block cuts off is moved to the front.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/log/byte_source.hpp"

namespace cablefit {

class LineBuffer {
 public:
  static constexpr std::size_t kBlockBytes = 1u << 18;
  static constexpr std::size_t kMaxLineBytes = 1u << 20;

  LineBuffer(std::unique_ptr<ByteSource> source, std::string path,
             std::size_t block_bytes = kBlockBytes);

  /// The next line without its end (LF or CRLF); false at the end of the text. The line is valid
  /// until the next call. Throws Error(input) for a line of more than 1 MiB.
  bool next(std::string_view& line);
  /// Whole lines as they stand, about a block of them, at least one; a last line that lacks its
  /// line feed gets one. Empty at the end of the text. A line of more than 1 MiB comes cut off
  /// there: it is for the caller, who counts lines, to refuse it.
  void take_lines(std::string& lines);
  /// What is in memory already of the text to come, at least a line of it; empty at its end. Valid
  /// until the next call.
  std::string_view ahead();
  /// Of the line that next() gave last; counted from 1.
  std::uint64_t line_number() const { return line_number_; }

 private:
  bool next_across_blocks(std::string_view& line);
  bool refill();
  void require_length(std::size_t n_bytes) const;
  void take(const char* line_end, const char* next_begin, std::string_view& line);

  std::unique_ptr<ByteSource> source_;
  std::string path_;
  std::size_t block_bytes_;
  std::vector<char> buffer_;
  const char* begin_;  // of the bytes not given out yet
  const char* end_;
  std::uint64_t line_number_ = 0;
};

/// For a line of more than LineBuffer::kMaxLineBytes.
Error too_long_line(const Place& place);

}  // namespace cablefit
