/// The composed pipeline in tests: the registry, both backends with validation, and one call that must succeed
/// silently.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "relievo/measure.hpp"
#include "relievo/render.hpp"
#include "relievo/trace.hpp"

namespace relievo::test {

inline const std::vector<std::string> both_backends = {"vulkan", "opengl"};

inline const Registry& registry() {
  static const Result<Registry> loaded = load_registry();
  if (!loaded) throw std::runtime_error(format(loaded.error()));
  return *loaded;
}

/// With validation or debug output; opened once a process.
inline Backend& backend(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Backend>> opened;
  static const auto close_all = [] { opened.clear(); };
  std::unique_ptr<Backend>& slot = opened[name];
  if (!slot) {
    BackendOptions options;
    options.validation = true;
    Result<std::unique_ptr<Backend>> result = open_backend(name, options);
    if (!result) throw std::runtime_error(format(result.error()));
    slot = std::move(*result);
    std::atexit(close_all);  // before the statics of the drivers and layers that were loaded just now
  }
  return *slot;
}

/// Every technique that is an algorithm, not a reference.
inline std::vector<std::string> technique_names(const Registry& from = registry()) {
  std::vector<std::string> names;
  for (const auto& [name, technique] : from.techniques) {
    if (technique.technique_class != TechniqueClass::reference) names.push_back(name);
  }
  return names;
}

inline TraceRequest request_of(const std::string& technique, std::map<std::string, double> values = {},
                               HeightFilter filter = HeightFilter::exact) {
  TraceRequest request;
  request.technique = technique;
  request.filter = filter;
  request.values = std::move(values);
  return request;
}

/// Traces without an error and without a single validation or debug message.
inline std::vector<Hit> trace_on(const std::string& name, const HeightMap& map, const std::vector<Ray>& rays,
                                 const TraceRequest& request, const Registry& from = registry()) {
  MapSet maps = map_set(map);
  std::vector<std::string> messages;
  Result<std::vector<TraceResult>> traced = trace(backend(name), from, maps, rays, {&request, 1}, {}, &messages);
  EXPECT_THAT(messages, ::testing::IsEmpty()) << name;
  if (!traced) {
    ADD_FAILURE() << name << ": " << format(traced.error());
    return std::vector<Hit>(rays.size());
  }
  return std::move(traced->front().hits);
}

/// As above, for a picture.
inline RenderResult render_on(const std::string& name, const Scene& scene, const Mesh& mesh, const HeightMap& map,
                              const RenderRequest& request, const Registry& from = registry()) {
  MapSet maps = map_set(map);
  std::vector<std::string> messages;
  Result<RenderResult> rendered = render(backend(name), from, scene, mesh, maps, request, &messages);
  EXPECT_THAT(messages, ::testing::IsEmpty()) << name;
  if (!rendered) {
    ADD_FAILURE() << name << ": " << format(rendered.error());
    RenderResult empty;
    const auto pixels = static_cast<std::size_t>(scene.image.width) * static_cast<std::size_t>(scene.image.height);
    empty.image = {scene.image.width, scene.image.height, 4, std::vector<float>(4 * pixels)};
    empty.color.resize(4 * pixels);
    return empty;
  }
  return std::move(*rendered);
}

}  // namespace relievo::test
