#include <fmt/format.h>
#include <fmt/ranges.h>

#include "job/backend_table.hpp"
#include "relievo/backend.hpp"
#include "relievo/describe.hpp"

namespace relievo {

namespace {

tl::unexpected<Error> unknown_backend(std::string_view name) {
  std::vector<std::string> known;
  for (const BackendFactory* factory : backend_table()) known.emplace_back(factory->name);
  const std::string nearest = nearest_name(name, known);
  const std::string hint = nearest.empty() ? fmt::format("known backends are {}", fmt::join(known, ", "))
                                           : fmt::format("did you mean \"{}\"?", nearest);
  return fail(ErrorCode::usage, "backend.unknown", fmt::format("\"{}\" is not a backend; {}", name, hint));
}

}  // namespace

Result<JobResult> Backend::execute_once(Job job, const TakeReadBack& take) {
  Result<JobResult> result = execute(job);
  if (!result) return result;
  std::vector<std::vector<std::byte>> read_backs = std::exchange(result->read_backs, {});
  for (std::size_t i = 0; i < read_backs.size(); ++i) take(i, std::exchange(read_backs[i], {}));
  return result;
}

Result<JobResult> keep_read_backs(const std::function<Result<JobResult>(const TakeReadBack& keep)>& run) {
  std::vector<std::vector<std::byte>> read_backs;
  Result<JobResult> result =
      run([&](std::size_t, std::span<const std::byte> bytes) { read_backs.emplace_back(bytes.begin(), bytes.end()); });
  if (result) result->read_backs = std::move(read_backs);
  return result;
}

std::vector<BackendInfo> list_backends() {
  std::vector<BackendInfo> infos;
  for (const BackendFactory* factory : backend_table()) infos.push_back(factory->probe());
  return infos;
}

Result<std::unique_ptr<Backend>> open_backend(std::string_view name, const BackendOptions& options) {
  for (const BackendFactory* factory : backend_table()) {
    if (factory->name == name) return factory->open(options);
  }
  return unknown_backend(name);
}

}  // namespace relievo
