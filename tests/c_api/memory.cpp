/// A lack of memory is a status: the n-th allocation of a call on an archive fails, for every n.
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>

#include "relievo.h"
#include "relievo/archive.hpp"

namespace {

/// Counts down; at 0 an allocation fails, and all after it do not.
thread_local long until_failure = -1;

void* allocate(std::size_t size) {
  if (until_failure >= 0 && until_failure-- == 0) throw std::bad_alloc();
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

// Not inlined: the compiler would see malloc's memory deleted, or new's freed.
[[gnu::noinline]] void* operator new(std::size_t size) {
  return allocate(size);
}
[[gnu::noinline]] void* operator new[](std::size_t size) {
  return allocate(size);
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

namespace {

/// Calls until no allocation fails any more. Returns how many allocations there are, or −1 for a status that is wrong.
template <class Call>
long failing_calls(const char* name, const Call& call) {
  for (long n = 0;; ++n) {
    relievo_error error{};
    until_failure = n;
    const relievo_status status = call(&error);
    const bool failed = until_failure < 0;
    until_failure = -1;
    if (!failed) {
      std::printf("%s: %ld allocations, each of which failed once\n", name, n);
      return status == RELIEVO_OK ? n : -1;
    }
    // What was wrong may also be said as an error of its own, or not matter at all.
    if (status == RELIEVO_OK || error.code == status) continue;
    std::printf("%s: allocation %ld fails; status %d, error %d\n", name, n, status, error.code);
    return -1;
  }
}

bool write_sample(const std::string& path) {
  const relievo::ProgramImage program{
      {{relievo::ShaderStage::fragment, {relievo::Language::glsl, 450}, "void main() {}\n"}}, "{}", "{}"};
  auto writer = relievo::ArchiveWriter::create(path, {{"technique", {"bump", "relief"}, 0}});
  const std::uint16_t values[] = {1};
  const auto number = writer->add_program(program);
  return writer->add_permutation(values, *number).has_value() && writer->finish().has_value();
}

bool archives_survive(const std::string& path) {
  relievo_archive* archive = nullptr;
  if (failing_calls("open", [&](relievo_error* error) {
        relievo_archive_free(archive);
        archive = nullptr;
        return relievo_archive_open(path.c_str(), &archive, error);
      }) <= 0)
    return false;
  const relievo_assignment assignment[] = {{"technique", "relief"}};
  const relievo_assignment missing[] = {{"technique", "cone"}};
  relievo_entry entry = 0;
  const long found = failing_calls(
      "find", [&](relievo_error* error) { return relievo_archive_find(archive, assignment, 1, &entry, error); });
  const long not_found = failing_calls("find what is missing", [&](relievo_error* error) {
    const relievo_status status = relievo_archive_find(archive, missing, 1, &entry, error);
    return status == RELIEVO_ERROR_USAGE ? RELIEVO_OK : status;
  });
  relievo_archive_free(archive);
  return found > 0 && not_found > 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::string path = std::string(argv[1]) + "/memory.rla";
  return write_sample(path) && archives_survive(path) ? 0 : 1;
}
