/// Any text as a descriptor of a technique, map or stage: a valid value, or an error with a place.
#include "fuzz/check.hpp"
#include "support/descriptor_faults.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  relievo::fuzz::expect_none(relievo::test::fault_of_all(text));
  return 0;
}
