// Composes and compiles one technique through the installed headers, and prints how many bytes came out.
#include <cstdio>
#include <string>

#include "relievo/compile.hpp"
#include "relievo/compose.hpp"
#include "relievo/describe.hpp"

namespace {

relievo::Result<relievo::ComposedProgram> compose_relief(const relievo::Registry& registry) {
  const auto stage = registry.stage("surface");
  if (!stage) return tl::unexpected(stage.error());
  relievo::Permutation permutation;
  permutation.stage = (*stage)->name;
  for (const std::string& role : (*stage)->roles) permutation.roles[role] = "relief";
  return relievo::compose(registry, permutation);
}

/// The bytes of all shaders' text for the target, or 0 where one is missing.
std::size_t text_size(const relievo::CompiledProgram& program, const std::string& target) {
  std::size_t bytes = 0;
  for (const relievo::CompiledShader& shader : program.shaders) {
    const auto text = shader.text.find(target);
    if (text == shader.text.end() || text->second.empty()) return 0;
    std::printf("%s %s: %zu bytes\n", std::string(relievo::to_string(shader.stage)).c_str(), target.c_str(),
                text->second.size());
    bytes += text->second.size();
  }
  return bytes;
}

int report(const relievo::Error& error) {
  std::fprintf(stderr, "%s\n", relievo::format(error).c_str());
  return relievo::exit_code(error.code);
}

}  // namespace

int main() {
  const auto registry = relievo::load_registry();
  if (!registry) return report(registry.error());
  const auto composed = compose_relief(*registry);
  if (!composed) return report(composed.error());
  const auto target = relievo::parse_target("glsl-450");
  if (!target) return report(target.error());
  const auto compiled = relievo::compile(*composed, {&*target, 1});
  if (!compiled) return report(compiled.error());
  return text_size(*compiled, "glsl-450") > 0 ? 0 : 1;
}
