/// The binding contract: the author's (set, binding, name) of every resource → flat registers and slots of every
/// target.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compile/shader_module.hpp"
#include "relievo/compile.hpp"

namespace relievo {

/// A register or index that a resource does not have.
constexpr int kNoSlot = -1;

/// Registers of HLSL by class, all in space 0.
struct HlslRegisters {
  int b = kNoSlot, t = kNoSlot, s = kNoSlot, u = kNoSlot;
};

/// Indices into Metal's argument tables.
struct MslIndices {
  int buffer = kNoSlot, texture = kNoSlot, sampler = kNoSlot;
};

/// One entry of the contract. An array of `count` resources takes that many consecutive slots.
struct BoundResource {
  BindingSlot slot;
  int count = 1;
  bool read_only = true;            ///< storage: no shader of the program writes it
  std::vector<ShaderStage> stages;  ///< the shaders that use it
  HlslRegisters hlsl;
  MslIndices msl;
};

/// A push-constant block; OpenGL gets it as a uniform block.
struct PushConstants {
  std::string name;  ///< of the block
  int size = 0;      ///< bytes
  int gl_slot = 0;
  HlslRegisters hlsl;
  MslIndices msl;
};

/// Where every resource of a program lives on every target. The same for all its shaders.
struct BindingLayout {
  std::vector<BoundResource> resources;  ///< sorted by (set, binding)
  std::optional<PushConstants> push_constants;
  int hlsl_workgroup_count =
      kNoSlot;  ///< b register of gl_NumWorkGroups, which HLSL lacks; reserved by compute programs

  const BoundResource* find(int set, int binding) const;
};

/// Metal's vertex buffers start here; resources count from 0 upwards and stay below.
constexpr int kMslVertexBuffer = 30;
/// The buffer that Metal needs for `.length()` of runtime-sized arrays.
constexpr int kMslBufferSizes = 29;

/// Collects the union over all shaders and numbers it: dense in each namespace, in the order of (set, binding).
/// Errors: "compile.binding-collision" when two shaders disagree about a (set, binding);
/// "compile.binding-kind" for kinds the contract does not know (separate textures, subpass inputs, …).
Result<BindingLayout> make_binding_layout(std::span<const ShaderModule> modules, std::string_view permutation_key);

}  // namespace relievo
