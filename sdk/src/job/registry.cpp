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
