/// Module + stage → one GLSL source a shader.
/// Every function and member function here is thread-safe.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "relievo/describe.hpp"
#include "relievo/height_map.hpp"

namespace relievo {

/// How heights are read: by the texture unit (about 8 fractional bits), or by texel fetches and float interpolation.
enum class HeightFilter { hardware, exact };
std::string_view to_string(HeightFilter filter);
Result<HeightFilter> parse_height_filter(std::string_view name);

/// What a fragment stage writes.
enum class Aov { color = 0, depth = 1, normal = 2, uv = 3, steps = 4, status = 5, ray_origin = 6, ray_direction = 7 };
std::string_view to_string(Aov aov);
Result<Aov> parse_aov(std::string_view name);

/// One permutation. `values` and `binding_times` are keyed by "owner.parameter" ("relief.linear_steps").
struct Permutation {
  std::string stage;
  std::map<std::string, std::string> roles;  ///< role → technique
  HeightFilter filter = HeightFilter::exact;
  AddressMode address = AddressMode::repeat;
  bool count_cost = false;  ///< instrumented: counts steps and fetches
  Aov aov = Aov::color;
  std::map<std::string, double> values;
  std::map<std::string, BindingTime> binding_times;

  /// A readable key, unique among permutations that differ: "surface/view=relief/exact/repeat/color".
  std::string key() const;
};

struct ComposedShader {
  ShaderStage stage = ShaderStage::compute;
  std::string text;                ///< complete Vulkan GLSL with #line directives to the author's files
  std::vector<std::string> files;  ///< every source path in it, for depfiles
};

/// Where a parameter of the permutation lives.
struct ParameterSlot {
  std::string name;  ///< "relief.linear_steps"
  bool is_integer = false;
  BindingTime binding = BindingTime::uniform;
  double value = 0;
  int constant_id = -1;                   ///< specialization
  int offset = -1;                        ///< bytes in the Parameters block (set 0, binding 0, std140)
  double default_value = 0;               ///< the descriptor's
  bool is_loop = false;                   ///< an iteration bound
  std::vector<std::string> choices = {};  ///< of an axis: the names of the values 0, 1, …
};

struct MapSlot {
  std::string map;
  std::string sampler;
  int set = 1, binding = 0;
};

struct ComposedProgram {
  std::string key;
  std::string stage;
  std::vector<ComposedShader> shaders;
  std::vector<ParameterSlot> parameters;
  std::vector<MapSlot> maps;
  int parameter_block_size = 0;  ///< bytes; 0 = no block
  FeatureSet features;           ///< of the stage and of every technique
};

/// Composes one permutation. Errors: unknown names (nearest one given), a role without a technique, a value out of
/// range, a rule of an axis that is broken, a missing or escaping or self-including file ("compose.*").
Result<ComposedProgram> compose(const Registry& registry, const Permutation& permutation);

/// Storage buffers that the texels of a map may be spread over.
constexpr int most_bake_buffers = 8;

struct BakeProgram {
  int phase = 0;    ///< which of MapDescriptor::passes
  int buffers = 1;  ///< 1 to most_bake_buffers
};

/// Composes the compute program of one phase of baking `map`; its parameters are keyed "map.parameter". It writes the
/// texels to storage buffers, from set 0, binding 2 on (lib/bake_buffers.glsl). Errors: unknown names (nearest one
/// given), a map that the caller provides, a phase or number of buffers out of range ("compose.bake"), a value out of
/// range.
Result<ComposedProgram> compose_bake(const Registry& registry, std::string_view map, AddressMode address,
                                     const std::map<std::string, double>& values = {}, BakeProgram program = {});

/// The Parameters block's bytes for the program's current values.
std::vector<std::byte> parameter_block(const ComposedProgram& program);

}  // namespace relievo
