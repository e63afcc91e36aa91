#include "cablefit/log/line_buffer.hpp"

#include <cstring>
#include <string_view>
#include <utility>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

const char* find_line_end(const char* begin, const char* end) {
  return static_cast<const char*>(std::memchr(begin, '\n', static_cast<std::size_t>(end - begin)));
}

}  // namespace

Error too_long_line(const Place& place) {
  return input_error(place, "line is longer than 1 MiB", "a log has one line per sample");
}

LineBuffer::LineBuffer(std::unique_ptr<ByteSource> source, std::string path,
                       std::size_t block_bytes)
    : source_(std::move(source)),
      path_(std::move(path)),
      block_bytes_(block_bytes),
      buffer_(2 * block_bytes),
      begin_(buffer_.data()),
      end_(begin_) {}

bool LineBuffer::next(std::string_view& line) {
  const char* line_end = find_line_end(begin_, end_);
  if (line_end == nullptr) return next_across_blocks(line);
  take(line_end, line_end + 1, line);
  return true;
}

bool LineBuffer::next_across_blocks(std::string_view& line) {
  const char* line_end = nullptr;
  bool has_more = true;
  while (line_end == nullptr && has_more) {
    const std::size_t n_searched = static_cast<std::size_t>(end_ - begin_);
    require_length(n_searched);
    has_more = refill();
    line_end = find_line_end(begin_ + n_searched, end_);
  }
  if (begin_ == end_) return false;
  // The last line may lack its line feed.
  const char* next_begin = line_end == nullptr ? end_ : line_end + 1;
  if (line_end == nullptr) line_end = end_;
  require_length(static_cast<std::size_t>(line_end - begin_));
  take(line_end, next_begin, line);
  return true;
}

void LineBuffer::take_lines(std::string& lines) {
  const auto last_line_end = [&](std::size_t n_searched) {
    const std::string_view text(begin_, static_cast<std::size_t>(end_ - begin_));
    const std::size_t at = text.substr(n_searched).rfind('\n');
    return at == std::string_view::npos ? nullptr : begin_ + n_searched + at;
  };
  const char* line_end = last_line_end(0);
  while (line_end == nullptr) {
    const std::size_t n_searched = static_cast<std::size_t>(end_ - begin_);
    if (n_searched > kMaxLineBytes || !refill()) break;
    line_end = last_line_end(n_searched);
  }
  const char* const next_begin = line_end == nullptr ? end_ : line_end + 1;
  lines.assign(begin_, next_begin);
  if (line_end == nullptr && !lines.empty()) lines += '\n';
  begin_ = next_begin;
}

std::string_view LineBuffer::ahead() {
  while (find_line_end(begin_, end_) == nullptr) {
    if (static_cast<std::size_t>(end_ - begin_) > kMaxLineBytes || !refill()) break;
  }
  return {begin_, static_cast<std::size_t>(end_ - begin_)};
}

void LineBuffer::require_length(std::size_t n_bytes) const {
  if (n_bytes <= kMaxLineBytes) return;
  throw too_long_line({path_, line_number_ + 1});
}

bool LineBuffer::refill() {
  const std::size_t n_kept = static_cast<std::size_t>(end_ - begin_);
  std::memmove(buffer_.data(), begin_, n_kept);
  // As long as no line is longer than a block, the buffer stays as it is.
  if (buffer_.size() < n_kept + block_bytes_) buffer_.resize(2 * n_kept + block_bytes_);
  const std::size_t n_read = source_->read(buffer_.data() + n_kept, block_bytes_);
  begin_ = buffer_.data();
  end_ = begin_ + n_kept + n_read;
  return n_read > 0;
}

void LineBuffer::take(const char* line_end, const char* next_begin, std::string_view& line) {
  const bool has_return = line_end != begin_ && line_end[-1] == '\r';
  line = {begin_, static_cast<std::size_t>(line_end - begin_) - (has_return ? 1 : 0)};
  begin_ = next_begin;
  ++line_number_;
}

}  // namespace cablefit
