#include "cablefit/base/files/streamed_file.hpp"

#include <optional>

#include "cablefit/base/files/file_descriptor.hpp"
#include "cablefit/base/files/output_file.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 16;

}  // namespace

class StreamedFile::Target {
 public:
  explicit Target(const std::string& path) {
    if (is_special_file(path)) {
      special_.emplace(open_in_place(path));
    } else {
      regular_.emplace(path);
    }
  }
  void append(std::string_view text) {
    if (special_) return special_->write_all(text);
    regular_->append(text);
  }
  void finish() {
    if (special_) return special_->close();
    regular_->rename_to_target();
  }

 private:
  std::optional<Descriptor> special_;
  std::optional<TemporaryFile> regular_;
};

template <typename Action>
void StreamedFile::guarded(Action action) {
  try {
    action();
  } catch (const std::system_error& failure) {
    throw output_error(path_, failure);
  }
}

StreamedFile::StreamedFile(const std::string& path) : path_(path) {
  guarded([&] { target_ = std::make_unique<Target>(path); });
}

StreamedFile::~StreamedFile() = default;

void StreamedFile::append(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= kBufferBytes) write_buffer();
}

void StreamedFile::finish() {
  write_buffer();
  guarded([&] { target_->finish(); });
}

void StreamedFile::write_buffer() {
  guarded([&] { target_->append(buffer_); });
  buffer_.clear();
}

}  // namespace cablefit
