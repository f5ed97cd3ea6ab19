#include "compile/emit_memo.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace relievo {

namespace {

std::string_view bytes_of(const SpirvWords& words) {
  return {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(words[0])};
}

/// Where the module's own resources lie: all that an emitter reads of a layout.
std::string places_of(const ShaderModule& module, const BindingLayout& layout) {
  std::string text;
  for (const BoundResource& resource : layout.resources) {
    const auto& stages = resource.stages;
    if (std::find(stages.begin(), stages.end(), module.stage) == stages.end()) continue;
    const BindingSlot& slot = resource.slot;
    text +=
        fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {}\n", slot.set, slot.binding, slot.name, slot.gl_slot,
                    static_cast<int>(slot.kind), resource.count, resource.read_only, resource.hlsl.b, resource.hlsl.t,
                    resource.hlsl.s, resource.hlsl.u, resource.msl.buffer, resource.msl.texture, resource.msl.sampler);
  }
  if (layout.push_constants) {
    const PushConstants& push = *layout.push_constants;
    text += fmt::format("{} {} {} {} {}\n", push.name, push.size, push.gl_slot, push.hlsl.b, push.msl.buffer);
  }
  return text + fmt::format("{}", layout.hlsl_workgroup_count);
}

std::string neighbours_text(const StageNeighbours& neighbours) {
  const auto number = [](const std::optional<ShaderStage>& stage) { return stage ? static_cast<int>(*stage) : -1; };
  return fmt::format("{} {} {}", number(neighbours.producer), number(neighbours.consumer),
                     fmt::join(neighbours.unread_outputs, ","));
}

}  // namespace

EmitMemo::Texts EmitMemo::texts(const TargetFamily& family, const ShaderModule& module, const BindingLayout& layout,
                                const StageNeighbours& neighbours, const std::function<Texts()>& emit) {
  if (!shared_.contains(module.spirv.get())) return emit();
  std::string targets;
  for (const Target& target : family) targets += to_string(target) + " ";
  const CacheKey key = cache_key({bytes_of(*module.spirv), to_string(module.stage), targets, places_of(module, layout),
                                  neighbours_text(neighbours)});
  {
    std::scoped_lock lock(mutex_);
    if (const auto known = texts_.find(key); known != texts_.end()) return known->second;
  }
  Texts made = emit();
  std::scoped_lock lock(mutex_);
  if (made) texts_.emplace(key, *made);
  return made;
}

}  // namespace relievo
