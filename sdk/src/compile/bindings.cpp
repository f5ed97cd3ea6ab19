#include "compile/bindings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "compile/filtered.hpp"

namespace relievo {

namespace {

using Place = std::pair<int, int>;  ///< set, binding
using Entries = std::map<Place, BoundResource>;

tl::unexpected<Error> collision(std::string_view key, const std::string& what) {
  return fail(ErrorCode::compile, "compile.binding-collision", fmt::format("{} (permutation '{}')", what, key));
}

int array_count(const spirv_cross::SPIRType& type) {
  int count = 1;
  for (std::size_t i = 0; i < type.array.size(); ++i) {
    if (type.array_size_literal[i]) count *= static_cast<int>(std::max(type.array[i], 1u));
  }
  return count;
}

BoundResource describe(const ShaderModule& module, const spirv_cross::Resource& resource, ResourceKind kind,
                       const std::set<std::uint32_t>& filtered) {
  const auto& reflection = *module.reflection;
  BoundResource entry;
  entry.slot.kind = kind;
  entry.slot.set = static_cast<int>(reflection.get_decoration(resource.id, spv::DecorationDescriptorSet));
  entry.slot.binding = static_cast<int>(reflection.get_decoration(resource.id, spv::DecorationBinding));
  entry.slot.name = resource.name;
  entry.slot.is_filtered = kind == ResourceKind::sampled_texture && filtered.contains(resource.id);
  entry.count = array_count(reflection.get_type(resource.type_id));
  entry.stages = {module.stage};
  if (kind == ResourceKind::storage_buffer) {
    entry.read_only = reflection.get_buffer_block_flags(resource.id).get(spv::DecorationNonWritable);
  } else if (kind == ResourceKind::storage_texture) {
    entry.read_only = reflection.has_decoration(resource.id, spv::DecorationNonWritable);
  }
  return entry;
}

/// Adds one shader's use; another shader may have declared the same entry, and then both must agree.
Status merge_entry(Entries& entries, BoundResource entry, std::string_view key) {
  const auto [known, inserted] = entries.try_emplace({entry.slot.set, entry.slot.binding}, entry);
  if (inserted) return {};
  BoundResource& other = known->second;
  if (other.slot.kind != entry.slot.kind || other.slot.name != entry.slot.name || other.count != entry.count) {
    return collision(
        key, fmt::format("set {} binding {} is {} '{}' and also {} '{}'", entry.slot.set, entry.slot.binding,
                         to_string(other.slot.kind), other.slot.name, to_string(entry.slot.kind), entry.slot.name));
  }
  other.read_only = other.read_only && entry.read_only;
  other.slot.is_filtered = other.slot.is_filtered || entry.slot.is_filtered;
  if (other.stages.back() != entry.stages.front()) other.stages.push_back(entry.stages.front());
  return {};
}

Status collect(Entries& entries, const ShaderModule& module, std::string_view key) {
  const auto& resources = module.resources;
  using List = const spirv_cross::SmallVector<spirv_cross::Resource>*;
  const std::pair<List, ResourceKind> kinds[] = {{&resources.uniform_buffers, ResourceKind::uniform_buffer},
                                                 {&resources.storage_buffers, ResourceKind::storage_buffer},
                                                 {&resources.sampled_images, ResourceKind::sampled_texture},
                                                 {&resources.storage_images, ResourceKind::storage_texture}};
  const std::set<std::uint32_t> filtered = filtered_variables(*module.spirv);
  for (const auto& [list, kind] : kinds) {
    for (const spirv_cross::Resource& resource : *list) {
      if (auto merged = merge_entry(entries, describe(module, resource, kind, filtered), key); !merged) return merged;
    }
  }
  return {};
}

Status refuse_unknown_kinds(const ShaderModule& module, std::string_view key) {
  const auto& r = module.resources;
  for (const auto* list :
       {&r.separate_images, &r.separate_samplers, &r.subpass_inputs, &r.atomic_counters, &r.acceleration_structures}) {
    if (list->empty()) continue;
    return fail(ErrorCode::compile, "compile.binding-kind",
                fmt::format("resource '{}' is of a kind that not every target has; expected a uniform block, a buffer "
                            "block, a combined sampler or a storage image (permutation '{}')",
                            list->front().name, key));
  }
  return {};
}

Status collect_push_constants(BindingLayout& layout, const ShaderModule& module, std::string_view key) {
  if (module.resources.push_constant_buffers.empty()) return {};
  const spirv_cross::Resource& block = module.resources.push_constant_buffers.front();
  const auto& type = module.reflection->get_type(block.base_type_id);
  PushConstants found;
  found.name = module.reflection->get_name(block.base_type_id);
  found.size = static_cast<int>(module.reflection->get_declared_struct_size(type));
  if (layout.push_constants &&
      (layout.push_constants->name != found.name || layout.push_constants->size != found.size)) {
    return collision(
        key, fmt::format("push constants are '{}' of {} bytes and also '{}' of {} bytes", layout.push_constants->name,
                         layout.push_constants->size, found.name, found.size));
  }
  layout.push_constants = std::move(found);
  return {};
}

/// Hands out consecutive numbers of one namespace.
struct Counter {
  int next = 0;
  int take(int count = 1) { return std::exchange(next, next + count); }
};

/// Direct3D 11 shares the pixel shader's u registers with its render targets, which come first.
int color_output_count(std::span<const ShaderModule> modules) {
  int count = 0;
  for (const ShaderModule& module : modules) {
    if (module.stage != ShaderStage::fragment) continue;
    for (const spirv_cross::Resource& output : module.resources.stage_outputs) {
      const auto location = module.reflection->get_decoration(output.id, spv::DecorationLocation);
      count = std::max(count, static_cast<int>(location) + 1);
    }
  }
  return count;
}

class Numbering {
 public:
  explicit Numbering(int first_u) { u_.next = first_u; }

  void number(BoundResource& entry) {
    const int n = entry.count;
    switch (entry.slot.kind) {
      case ResourceKind::uniform_buffer:
        entry.slot.gl_slot = uniform_block_.take(n);
        entry.hlsl.b = b_.take(n);
        entry.msl.buffer = buffer_.take(n);
        break;
      case ResourceKind::storage_buffer:
        entry.slot.gl_slot = storage_block_.take(n);
        (entry.read_only ? entry.hlsl.t : entry.hlsl.u) = (entry.read_only ? t_ : u_).take(n);
        entry.msl.buffer = buffer_.take(n);
        break;
      case ResourceKind::sampled_texture:
        entry.slot.gl_slot = texture_unit_.take(n);
        entry.hlsl.t = t_.take(n);
        entry.hlsl.s = s_.take(n);
        entry.msl.texture = texture_.take(n);
        entry.msl.sampler = sampler_.take(n);
        break;
      case ResourceKind::storage_texture:
        entry.slot.gl_slot = image_unit_.take(n);
        (entry.read_only ? entry.hlsl.t : entry.hlsl.u) = (entry.read_only ? t_ : u_).take(n);
        entry.msl.texture = texture_.take(n);
        break;
    }
  }

  void number(PushConstants& push) {
    push.gl_slot = uniform_block_.take();
    push.hlsl.b = b_.take();
    push.msl.buffer = buffer_.take();
  }

  int take_b() { return b_.take(); }
  int msl_buffers() const { return buffer_.next; }

 private:
  Counter uniform_block_, storage_block_, texture_unit_, image_unit_;
  Counter b_, t_, s_, u_;
  Counter buffer_, texture_, sampler_;
};

}  // namespace

const BoundResource* BindingLayout::find(int set, int binding) const {
  const auto found = std::find_if(resources.begin(), resources.end(), [&](const BoundResource& entry) {
    return entry.slot.set == set && entry.slot.binding == binding;
  });
  return found == resources.end() ? nullptr : &*found;
}

Result<BindingLayout> make_binding_layout(std::span<const ShaderModule> modules, std::string_view permutation_key) {
  BindingLayout layout;
  Entries entries;
  for (const ShaderModule& module : modules) {
    if (auto ok = refuse_unknown_kinds(module, permutation_key); !ok) return tl::unexpected(ok.error());
    if (auto ok = collect(entries, module, permutation_key); !ok) return tl::unexpected(ok.error());
    if (auto ok = collect_push_constants(layout, module, permutation_key); !ok) return tl::unexpected(ok.error());
  }

  Numbering numbering(color_output_count(modules));
  for (auto& [place, entry] : entries) {
    numbering.number(entry);
    layout.resources.push_back(std::move(entry));
  }
  if (layout.push_constants) numbering.number(*layout.push_constants);
  for (const ShaderModule& module : modules) {
    if (module.stage == ShaderStage::compute) layout.hlsl_workgroup_count = numbering.take_b();
  }
  if (numbering.msl_buffers() > kMslBufferSizes) {
    return collision(permutation_key,
                     fmt::format("the program has {} buffers, Metal has room for {} beside vertex data",
                                 numbering.msl_buffers(), kMslBufferSizes));
  }
  return layout;
}

}  // namespace relievo
