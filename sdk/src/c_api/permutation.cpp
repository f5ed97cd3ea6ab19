#include "c_api/permutation.hpp"

#include "c_api/boundary.hpp"

namespace relievo::c_api {

static_assert(RELIEVO_REPEAT == static_cast<int>(AddressMode::repeat));
static_assert(RELIEVO_CLIP == static_cast<int>(AddressMode::clip));
static_assert(RELIEVO_AOV_COLOR == static_cast<int>(Aov::color));
static_assert(RELIEVO_AOV_RAY_DIRECTION == static_cast<int>(Aov::ray_direction));

namespace {

Status add_roles(const Registry& registry, const relievo_program_desc& desc, Permutation& permutation) {
  const Result<const StageDescriptor*> stage = registry.stage(desc.stage);
  if (!stage) return tl::unexpected(stage.error());
  if (desc.technique) {
    for (const std::string& role : (*stage)->roles) permutation.roles[role] = desc.technique;
  }
  if (Status status = require_list("roles", desc.roles, desc.role_count); !status) return status;
  for (std::size_t i = 0; i < desc.role_count; ++i) {
    const relievo_role& role = desc.roles[i];
    if (Status status = require({{"roles.role", role.role}, {"roles.technique", role.technique}}); !status)
      return status;
    permutation.roles[role.role] = role.technique;
  }
  return {};
}

Status add_bindings(const relievo_program_desc& desc, Permutation& permutation) {
  if (Status status = require_list("bindings", desc.bindings, desc.binding_count); !status) return status;
  for (std::size_t i = 0; i < desc.binding_count; ++i) {
    const relievo_binding_choice& choice = desc.bindings[i];
    if (Status status = require({{"bindings.parameter", choice.parameter}}); !status) return status;
    if (Status status = require_enum("bindings.binding", choice.binding, RELIEVO_UNIFORM + 1); !status) return status;
    permutation.binding_times[choice.parameter] = static_cast<BindingTime>(choice.binding);
  }
  return {};
}

Status add_axes(const relievo_program_desc& desc, Permutation& permutation) {
  if (Status status = require_enum("filter", desc.filter, RELIEVO_HARDWARE + 1); !status) return status;
  if (Status status = require_enum("address", desc.address, RELIEVO_CLIP + 1); !status) return status;
  if (Status status = require_enum("aov", desc.aov, RELIEVO_AOV_RAY_DIRECTION + 1); !status) return status;
  permutation.filter = desc.filter == RELIEVO_EXACT ? HeightFilter::exact : HeightFilter::hardware;
  permutation.address = static_cast<AddressMode>(desc.address);
  permutation.aov = static_cast<Aov>(desc.aov);
  permutation.count_cost = desc.count_cost != 0;
  return {};
}

}  // namespace

Result<Permutation> permutation_of(const Registry& registry, const relievo_program_desc& desc) {
  if (Status status = require({{"desc.stage", desc.stage}}); !status) return tl::unexpected(status.error());
  Permutation permutation;
  permutation.stage = desc.stage;
  if (Status status = add_axes(desc, permutation); !status) return tl::unexpected(status.error());
  if (Status status = add_roles(registry, desc, permutation); !status) return tl::unexpected(status.error());
  if (Status status = add_bindings(desc, permutation); !status) return tl::unexpected(status.error());
  Result<std::map<std::string, double>> values = values_of(desc.values, desc.value_count);
  if (!values) return tl::unexpected(values.error());
  permutation.values = *std::move(values);
  return permutation;
}

Result<std::vector<Target>> targets_of(const relievo_program_desc& desc) {
  const Result<std::vector<std::string>> names = texts_of("targets", desc.targets, desc.target_count);
  if (!names) return tl::unexpected(names.error());
  std::vector<Target> targets;
  for (const std::string& name : *names) {
    const Result<Target> target = parse_target(name);
    if (!target) return tl::unexpected(target.error());
    targets.push_back(*target);
  }
  return targets;
}

}  // namespace relievo::c_api
