#include <bit>
#include <cstdint>

#include "relievo/compile.hpp"

namespace relievo {

namespace {

std::uint32_t constant_bits(const ParameterSlot& slot) {
  if (slot.is_integer) return static_cast<std::uint32_t>(static_cast<std::int32_t>(slot.value));
  return std::bit_cast<std::uint32_t>(static_cast<float>(slot.value));
}

}  // namespace

ShaderProgram to_shader_program(const ComposedProgram& composed, const CompiledProgram& compiled) {
  ShaderProgram program;
  program.name = compiled.key;
  for (const CompiledShader& shader : compiled.shaders) {
    program.shaders.push_back({shader.stage, shader.spirv, shader.text});
  }
  program.bindings = compiled.bindings;
  for (const ParameterSlot& slot : composed.parameters) {
    if (slot.binding != BindingTime::specialization) continue;
    program.constants.push_back({static_cast<std::uint32_t>(slot.constant_id), constant_bits(slot)});
  }
  return program;
}

}  // namespace relievo
