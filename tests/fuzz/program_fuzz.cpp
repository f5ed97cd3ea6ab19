/// Any bytes as a cached program: refused, or written again as the same bytes.
#include "fuzz/check.hpp"
#include "relievo/archive.hpp"
#include "support/damage.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  for (const bool mended : {false, true}) {
    if (mended) relievo::test::mend_program_hash(bytes);
    const auto program = relievo::read_program(bytes);
    if (program && relievo::write_program(*program) != bytes)
      relievo::fuzz::expect_none("the program is written otherwise");
    if (!program && program.error().id != "archive.program") relievo::fuzz::expect_none("another error");
  }
  return 0;
}
