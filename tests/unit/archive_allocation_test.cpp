/// Look-ups in an archive allocate nothing: every `new` of this program is counted.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "support/archives.hpp"

namespace {
thread_local std::size_t allocations = 0;
}

// Not inlined: the compiler would see malloc's memory deleted, or new's freed.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new[](std::size_t size) {
  return operator new(size);
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void* operator new[](std::size_t size, const std::nothrow_t& none) noexcept {
  return operator new(size, none);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace relievo {
namespace {

template <class Action>
std::size_t allocations_of(const Action& action) {
  const std::size_t before = allocations;
  action();
  return allocations - before;
}

TEST(ArchiveLookUp, AllocatesNothing) {
  const test::TemporaryFolder folder;
  write_archive(folder / "a.rva", test::sample_archive());
  const Archive archive = test::expect_value(Archive::open(folder / "a.rva"));
  const std::pair<std::string_view, std::string_view> assignment[] = {{"technique", "relief"}, {"address", "clamp"}};
  bool found = true;
  const std::size_t count = allocations_of([&] {
    const std::uint64_t key = archive.key(assignment);
    const auto by_key = archive.find(key);
    const auto by_name = archive.find(assignment);
    found = by_key && by_name && *by_key == *by_name && !archive.find(key + 1) && archive.key(*by_key) == key &&
            !archive.values(*by_key).empty() &&
            archive.output(*by_key, ShaderStage::fragment, test::kGlsl).has_value() && archive.reflection(*by_key) &&
            archive.cost(*by_key);
  });
  EXPECT_TRUE(found);
  EXPECT_EQ(count, 0u);
  // The library's allocations are counted: a name is a string.
  EXPECT_GT(allocations_of([&] { EXPECT_EQ(archive.name(4), "technique=relief address=clamp steps=8"); }), 0u);
}

}  // namespace
}  // namespace relievo
