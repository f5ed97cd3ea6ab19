// Valid descriptors, one of each kind, and what the descriptor tests do with them.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <string_view>

#include "relievo/describe.hpp"

namespace relievo::examples {

inline constexpr std::string_view technique = R"(schema = 1
name = "relief"
title = "Relief mapping"
source = "Policarpo, Oliveira, Comba 2005"
summary = "Linear search, then binary refinement."
class = "combined"
first_hit = "if_steps_under_texel"
module = "relief.glsl"
maps = ["height"]
features = ["dynamic_loops", "explicit_lod"]

[loops.linear_steps]
title = "Equal steps"
bounds = "steps from entry to exit"
min = 1
max = 4096
default = 100
binding = "macro"

[parameters.bias]
title = "Bias"
unit = "texels"
type = "float"
min = 0
max = 1.5
default = 0.5
binding = "specialization"
)";

inline constexpr std::string_view map = R"(schema = 1
name = "normal"
title = "Normal map"
inputs = ["height"]
channels = 3
sampler = "relievo_normal_map"
binding = {set = 1, binding = 1}
module = "bake.glsl"
access = "normal.glsl"
)";

inline constexpr std::string_view provided_map = R"(schema = 1
name = "height"
title = "Height map"
channels = 1
sampler = "relievo_height_map"
binding = {set = 1, binding = 0}
)";

inline constexpr std::string_view stage = R"(schema = 1
name = "prism"
title = "Prisms by a geometry shader"
roles = ["view"]
maps = ["normal"]
fallback = "prism_pulled"
mesh = "base"

[[shader]]
stage = "vertex"
module = "prism.vert.glsl"

[[shader]]
stage = "geometry"
module = "prism.geom.glsl"

[[shader]]
stage = "fragment"
module = "prism.frag.glsl"
)";

/// `text` with the first `from` replaced; fails the test when there is none, so that no fault goes unseeded.
inline std::string with(std::string_view text, std::string_view from, std::string_view to) {
  std::string result(text);
  const std::size_t at = result.find(from);
  if (at == result.npos) {
    ADD_FAILURE() << "the example lacks " << from;
    return result;
  }
  return result.replace(at, from.size(), to);
}

/// A small tree that is complete: one technique, two maps, one stage.
inline SourceTree tree() {
  return {{"techniques/relief/technique.toml", std::string(technique)},
          {"techniques/relief/relief.glsl", "// trace\n"},
          {"shaders/maps/height/map.toml", std::string(provided_map)},
          {"shaders/maps/normal/map.toml", std::string(map)},
          {"shaders/maps/normal/bake.glsl", ""},
          {"shaders/maps/normal/normal.glsl", ""},
          {"shaders/stages/prism/stage.toml", std::string(stage)},
          {"shaders/stages/prism/prism.vert.glsl", ""},
          {"shaders/stages/prism/prism.geom.glsl", ""},
          {"shaders/stages/prism/prism.frag.glsl", ""}};
}

/// One fault seeded into an example, and the error it must give.
struct Fault {
  std::string_view name, from, to, id;
  int line, column;
  std::string_view words;
};

inline void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

inline std::string fault_name(const testing::TestParamInfo<Fault>& parameter) {
  return std::string(parameter.param.name);
}

/// Checks an error's id and place, and that its message has `words`.
inline void expect_error(const Error& error, std::string_view id, int line, int column, std::string_view words) {
  EXPECT_EQ(error.id, id) << format(error);
  EXPECT_EQ(error.line, line) << format(error);
  EXPECT_EQ(error.column, column) << format(error);
  EXPECT_NE(error.message.find(words), std::string::npos) << format(error) << "\nlacks: " << words;
}

}  // namespace relievo::examples
