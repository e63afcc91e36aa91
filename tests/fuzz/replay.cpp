// Feeds files to a target without libFuzzer, so that every compiler can run the corpus as a test:
// replay FILE|FOLDER...
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n_bytes);

namespace {

namespace fs = std::filesystem;

void replay(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(file), {}};
  std::printf("%s\n", path.c_str());
  std::fflush(stdout);  // the last line printed is the input that failed
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
}

int replay_all(const fs::path& path) {
  if (!fs::is_directory(path)) return replay(path), 1;
  int n_files = 0;
  for (const auto& entry : fs::directory_iterator(path)) {
    replay(entry.path());
    ++n_files;
  }
  return n_files;
}

}  // namespace

int main(int argc, char** argv) {
  int n_files = 0;
  try {
    for (int k = 1; k < argc; ++k) n_files += replay_all(argv[k]);
  } catch (const std::exception& error) {
    std::printf("threw %s\n", error.what());
    return 1;
  }
  std::printf("%d inputs\n", n_files);
  return n_files > 0 ? 0 : 1;
}
