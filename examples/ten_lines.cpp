/// A technique in an engine, in ten lines: relief mapping for the fragments of ordinary triangles.
#include <array>
#include <cstdio>

#include "relievo/compile.hpp"

namespace {

/// What an engine does with a shader; this one only says what it got.
void engine_add_shader(relievo::ShaderStage stage, const std::vector<std::uint32_t>& spirv, const std::string& glsl) {
  std::printf("%s: %zu words of SPIR-V, %zu bytes of GLSL\n", std::string(to_string(stage)).c_str(), spirv.size(),
              glsl.size());
}

void engine_bind(const std::vector<relievo::BindingSlot>& slots, const std::vector<std::byte>& uniforms) {
  for (const relievo::BindingSlot& slot : slots)
    std::printf("set %d binding %d: %s\n", slot.set, slot.binding, slot.name.c_str());
  std::printf("%zu bytes of uniforms\n", uniforms.size());
}

relievo::Status add_relief_mapping() {
  using namespace relievo;
  // clang-format off
  // ten lines: begin
  Result<Registry> registry = load_registry();  // every technique, map and stage; no data files are needed
  Permutation wanted;
  wanted.stage = "surface";                     // the fragments of ordinary triangles
  wanted.roles["view"] = "relief";              // the technique that traces the view ray
  wanted.values["relief.linear_steps"] = 64;
  auto source = registry.and_then([&](const Registry& r) { return compose(r, wanted); });
  auto program = source.and_then([](const ComposedProgram& s) { return compile(s, std::array{Target{Language::glsl, 450}}); });
  if (!program) return tl::unexpected(program.error());
  for (const CompiledShader& s : program->shaders) engine_add_shader(s.stage, s.spirv, s.text.at("glsl-450"));
  engine_bind(program->bindings, parameter_block(*source));
  // ten lines: end
  // clang-format on
  return {};
}

}  // namespace

int main() {
  if (relievo::Status status = add_relief_mapping(); !status) {
    std::fprintf(stderr, "%s\n", format(status.error()).c_str());
    return relievo::exit_code(status.error().code);
  }
  return 0;
}
