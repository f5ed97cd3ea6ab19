/// write_seeds CORPUS: the stored inputs that are not text.
#include <cstdio>

#include "support/archives.hpp"

int main(int argc, char** argv) {
  using namespace relievo;
  if (argc != 2) return std::fprintf(stderr, "usage: %s CORPUS\n", argv[0]), 1;
  const std::filesystem::path corpus = argv[1];
  for (const auto& [name, bytes] : test::stored_inputs()) {
    std::filesystem::create_directories((corpus / name).parent_path());
    std::ofstream(corpus / name, std::ios::binary) << bytes;
  }
  return 0;
}
