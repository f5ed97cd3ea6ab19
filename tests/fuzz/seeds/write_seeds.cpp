/// write_seeds CORPUS: the stored inputs that are not text.
#include <cstdio>

#include "support/archives.hpp"

int main(int argc, char** argv) {
  using namespace relievo;
  if (argc != 2) return std::fprintf(stderr, "usage: %s CORPUS\n", argv[0]), 1;
  const std::filesystem::path corpus = argv[1];
  std::filesystem::create_directories(corpus / "archive");
  std::filesystem::create_directories(corpus / "program");
  const auto write_bytes = [](const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  };
  test::write_archive(corpus / "archive/sample.rva", test::sample_archive());
  test::write_archive(corpus / "archive/empty.rva", {test::sample_axes(), {}});
  test::write_archive(corpus / "archive/no_axes.rva", {{}, {{{}, ProgramImage{}, {{test::kMsl, "no"}}}}});
  write_bytes(corpus / "program/sample.rvp", write_program(test::sample_program("stored")));
  write_bytes(corpus / "program/empty.rvp", write_program({}));
  return 0;
}
