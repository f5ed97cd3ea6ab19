#include "permute/closure.hpp"

#include <fmt/format.h>

#include <bit>

#include "compose/resolve.hpp"
#include "relievo/compile.hpp"

#include "relievo/permute.hpp"

namespace relievo {

namespace {

std::uint32_t bits_of(const ParameterSlot& slot) {
  if (slot.is_integer) return static_cast<std::uint32_t>(static_cast<std::int32_t>(slot.value));
  return std::bit_cast<std::uint32_t>(static_cast<float>(slot.value));
}

}  // namespace

Result<Closure> compose_closure(const Registry& registry, const Permutation& permutation) {
  Result<Parts> parts = resolve(registry, permutation);
  if (!parts) return tl::unexpected(parts.error());
  Closure closure;
  closure.fallback = parts->stage->fallback;
  std::vector<bool> leaves_trace;
  for (ParameterSlot& slot : parts->parameters) {
    const bool is_frozen = slot.binding == BindingTime::specialization && permutation.values.contains(slot.name);
    if (is_frozen) closure.frozen.push_back({slot.constant_id, bits_of(slot)});
    if (slot.binding != BindingTime::macro) slot.value = slot.default_value;
    leaves_trace.push_back(!is_frozen && slot.binding != BindingTime::macro);
  }
  Result<ComposedProgram> program = compose_parts(registry, permutation, *parts);
  if (!program) return tl::unexpected(program.error());
  closure.program = *std::move(program);
  std::size_t i = 0;
  std::erase_if(closure.program.parameters, [&](const ParameterSlot&) { return !leaves_trace[i++]; });
  return closure;
}

std::string describe_contract(const ComposedProgram& program) {
  std::string text =
      fmt::format("{} {} {}\n", program.stage, program.parameter_block_size, fmt::join(program.features, ","));
  for (const ParameterSlot& slot : program.parameters) {
    text += fmt::format("{} {} {} {} {} {} {} {}\n", slot.name, slot.is_integer, to_string(slot.binding), slot.value,
                        slot.constant_id, slot.offset, slot.is_loop, fmt::join(slot.choices, ","));
  }
  for (const MapSlot& map : program.maps) {
    text += fmt::format("{} {} {} {}\n", map.map, map.sampler, map.set, map.binding);
  }
  return text;
}

CacheKey closure_key(const Closure& closure, std::span<const Target> targets, bool optimize) {
  std::string options = fmt::format("{}", optimize ? "optimized" : "as written");
  for (const Target& target : targets) options += " " + to_string(target);
  for (const FrozenConstant& constant : closure.frozen) options += fmt::format(" {}:{}", constant.id, constant.bits);
  const std::string contract = describe_contract(closure.program);
  std::vector<std::string_view> parts = {compiler_version(), options, contract};
  for (const ComposedShader& shader : closure.program.shaders) {
    parts.push_back(to_string(shader.stage));
    parts.push_back(shader.text);
  }
  return cache_key(parts);
}

}  // namespace relievo
