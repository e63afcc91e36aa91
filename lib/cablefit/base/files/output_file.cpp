#include "cablefit/base/files/output_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <optional>
#include <system_error>
#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/base/files/file_descriptor.hpp"
#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

void write_stdout(std::string_view content) {
  // By stdio, so that the order with what was printed before is kept.
  const bool all = std::fwrite(content.data(), 1, content.size(), stdout) == content.size();
  if (all && std::fflush(stdout) == 0) return;
  if (errno == EPIPE) return;  // the reader has seen enough, as `head` has
  throw std::system_error(errno, std::generic_category());
}

void write_in_place(const std::string& path, std::string_view content) {
  Descriptor file(open_in_place(path));
  file.write_all(content);
  file.close();
}

void write_by_rename(const std::string& path, std::string_view content) {
  TemporaryFile temporary(path);
  temporary.append(content);
  temporary.rename_to_target();
}

/// Runs `write`; what the system refuses becomes an Error about `path`.
template <typename Write>
void guarded(const std::string& path, const Write& write) {
  try {
    write();
  } catch (const std::system_error& failure) {  // also fs::filesystem_error
    throw output_error(path, failure);
  }
}

void write_to(const std::string& path, std::string_view content) {
  if (path == "-") return write_stdout(content);
  // A device or a pipe (/dev/null, /dev/stdout) must not be replaced by a file.
  if (is_special_file(path)) return write_in_place(path, content);
  write_by_rename(path, content);
}

}  // namespace

Error output_error(const std::string& path, const std::system_error& failure) {
  return {ErrorKind::output,
          fmt::format("cannot write {}: {}", path == "-" ? "standard output" : printable(path),
                      failure.code().message())};
}

void write_whole(const std::string& path, std::string_view content) {
  guarded(path, [&] { write_to(path, content); });
}

struct WholeFiles::File {
  std::string path, content;               // content: of what cannot be renamed
  std::optional<TemporaryFile> temporary;  // of what can
};

WholeFiles::WholeFiles() = default;
WholeFiles::~WholeFiles() = default;

void WholeFiles::add(const std::string& path, std::string content) {
  guarded(path, [&] {
    auto file = std::make_unique<File>();
    file->path = path;
    if (path == "-" || is_special_file(path)) {
      file->content = std::move(content);
    } else {
      file->temporary.emplace(path);
      file->temporary->append(content);
    }
    files_.push_back(std::move(file));
  });
}

void WholeFiles::finish() {
  for (const auto& file : files_)
    guarded(file->path, [&] {
      if (file->temporary)
        file->temporary->rename_to_target();
      else
        write_to(file->path, file->content);
    });
}

}  // namespace cablefit
