#include "job/program_cache.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <mutex>
#include <vector>

#include "relievo/permute.hpp"
#include "relievo/program_cache.hpp"

namespace relievo {

namespace {

std::mutex guard;
std::shared_ptr<Cache> programs = make_memory_cache(std::uint64_t{32} << 20);

std::shared_ptr<Cache> current() {
  const std::lock_guard lock(guard);
  return programs;
}

/// The shaders' text decides, with the values of macros and specialization constants in it; those of uniforms do not.
CacheKey key_of(const ComposedProgram& composed, std::string_view shader_target) {
  const std::string features = fmt::format("{}", fmt::join(composed.features, ","));
  std::vector<std::string_view> parts = {"job program", compiler_version(), shader_target, features};
  for (const ComposedShader& shader : composed.shaders) {
    parts.push_back(to_string(shader.stage));
    parts.push_back(shader.text);
  }
  return cache_key(parts);
}

}  // namespace

void use_program_cache(std::shared_ptr<Cache> cache) {
  const std::lock_guard lock(guard);
  programs = std::move(cache);
}

std::optional<ShaderProgram> load_program(const ComposedProgram& composed, std::string_view shader_target) {
  const std::shared_ptr<Cache> cache = current();
  if (!cache) return std::nullopt;
  const std::optional<std::string> payload = cache->load(key_of(composed, shader_target));
  if (!payload) return std::nullopt;
  Result<Job> kept = parse_job({payload->begin(), payload->end()});
  if (!kept || kept->programs.size() != 1) return std::nullopt;
  CompiledProgram compiled;
  compiled.key = composed.key;
  compiled.bindings = std::move(kept->programs.front().bindings);
  for (ShaderCode& shader : kept->programs.front().shaders)
    compiled.shaders.push_back({shader.stage, std::move(shader.spirv), std::move(shader.text)});
  return to_shader_program(composed, compiled);
}

void store_program(const ComposedProgram& composed, std::string_view shader_target, const ShaderProgram& program) {
  const std::shared_ptr<Cache> cache = current();
  if (!cache) return;
  Job kept;
  kept.programs.push_back({"", program.shaders, program.bindings, {}});
  const std::vector<std::uint8_t> bytes = serialize_job(kept);
  cache->store(key_of(composed, shader_target), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace relievo
