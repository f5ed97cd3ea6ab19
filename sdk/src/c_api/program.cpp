#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "c_api/boundary.hpp"
#include "c_api/permutation.hpp"
#include "c_api/program.hpp"
#include "c_api/registry.hpp"
#include "describe/origins.hpp"

namespace relievo::c_api {

static_assert(RELIEVO_VERTEX == static_cast<int>(ShaderStage::vertex));
static_assert(RELIEVO_COMPUTE == static_cast<int>(ShaderStage::compute));
static_assert(RELIEVO_UNIFORM_BUFFER == static_cast<int>(ResourceKind::uniform_buffer));
static_assert(RELIEVO_STORAGE_TEXTURE == static_cast<int>(ResourceKind::storage_texture));

namespace {

Result<std::unique_ptr<relievo_program>> compile_program(const Registry& registry, const relievo_program_desc& desc) {
  const Result<Permutation> permutation = permutation_of(registry, desc);
  if (!permutation) return tl::unexpected(permutation.error());
  const Result<std::vector<Target>> targets = targets_of(desc);
  if (!targets) return tl::unexpected(targets.error());
  Result<ComposedProgram> composed = compose(registry, *permutation);
  if (!composed) return tl::unexpected(composed.error());
  const std::string& fallback = (*registry.stage(desc.stage))->fallback;
  Result<CompiledProgram> compiled = compile(*composed, *targets, compile_options_of(desc), fallback);
  if (!compiled) return tl::unexpected(compiled.error());
  HotProgramState state{*std::move(composed), *std::move(compiled)};
  return std::make_unique<relievo_program>(std::make_shared<const HotProgramState>(std::move(state)));
}

/// Checks what every function on a program's list does: `get` answers with an element for an index in range.
template <class Element, class Get>
relievo_status element(const relievo_program* program, const Element* list, std::size_t index, std::size_t count,
                       relievo_error* error, const Get& get) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"program", program}, {"result", list}}); !status) return status;
    if (Status status = require_index(index, count); !status) return status;
    get();
    return {};
  });
}

template <class Value, class Get>
relievo_status value(const relievo_program* program, Value* result, relievo_error* error, const Get& get) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"program", program}, {"result", result}}); !status) return status;
    *result = get();
    return {};
  });
}

relievo_bytes bytes_of(const std::vector<std::uint32_t>& words) {
  return {words.data(), words.size() * sizeof(std::uint32_t)};
}

Result<relievo_bytes> output_of(const CompiledProgram& program, relievo_shader_stage stage, const char* name) {
  const Result<Target> target = parse_target(name);
  if (!target) return tl::unexpected(target.error());
  const auto shader = std::find_if(program.shaders.begin(), program.shaders.end(),
                                   [&](const CompiledShader& s) { return s.stage == static_cast<ShaderStage>(stage); });
  if (shader == program.shaders.end()) {
    return fail(
        ErrorCode::usage, "c.no-output",
        fmt::format("the program '{}' has no {} shader", program.key, to_string(static_cast<ShaderStage>(stage))));
  }
  if (target->language == Language::spirv) return bytes_of(shader->spirv);
  const auto text = shader->text.find(name);
  if (text == shader->text.end()) {
    return fail(ErrorCode::usage, "c.no-output",
                fmt::format("the program '{}' was not compiled for the target {}", program.key, name));
  }
  return relievo_bytes{text->second.data(), text->second.size()};
}

relievo_binding describe(const BindingSlot& slot, const ComposedProgram& composed) {
  const auto map = std::find_if(composed.maps.begin(), composed.maps.end(), [&](const MapSlot& candidate) {
    return candidate.set == slot.set && candidate.binding == slot.binding && candidate.sampler == slot.name;
  });
  const std::string_view name = map == composed.maps.end() ? std::string_view() : std::string_view(map->map);
  return {view(slot.name), view(name),      static_cast<relievo_resource_kind>(slot.kind), slot.set, slot.binding,
          slot.gl_slot,    slot.is_filtered};
}

relievo_program_parameter describe(const ParameterSlot& slot) {
  return {view(slot.name), static_cast<relievo_binding_time>(slot.binding),
          slot.is_integer, slot.is_loop,
          slot.offset,     slot.constant_id,
          slot.value,      slot.default_value};
}

}  // namespace

CompileOptions compile_options_of(const relievo_program_desc& desc) {
  CompileOptions options;
  options.optimize = desc.skip_optimizer == 0;
  options.threads = std::max(1u, desc.threads);
  return options;
}

}  // namespace relievo::c_api

using namespace relievo;
using namespace relievo::c_api;

relievo_status relievo_program_compile(const relievo_registry* registry, const relievo_program_desc* desc,
                                       relievo_program** program, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"registry", registry}, {"desc", desc}, {"program", program}}); !status) return status;
    auto compiled = compile_program(registry->registry, *desc);
    if (!compiled) return tl::unexpected(name_file_on_disk(compiled.error(), registry->registry));
    *program = compiled->release();
    return {};
  });
}

void relievo_program_free(relievo_program* program) {
  delete program;
}

relievo_status relievo_program_share(const relievo_program* program, relievo_program** another, relievo_error* error) {
  return value(program, another, error, [&] { return new relievo_program(*program); });
}

relievo_status relievo_program_key(const relievo_program* program, relievo_string* key, relievo_error* error) {
  return value(program, key, error, [&] { return view(program->state->compiled.key); });
}

relievo_status relievo_program_shader_count(const relievo_program* program, size_t* count, relievo_error* error) {
  return value(program, count, error, [&] { return program->state->compiled.shaders.size(); });
}

relievo_status relievo_program_shader_stage(const relievo_program* program, size_t index, relievo_shader_stage* stage,
                                            relievo_error* error) {
  return element(program, stage, index, program ? program->state->compiled.shaders.size() : 0, error,
                 [&] { *stage = static_cast<relievo_shader_stage>(program->state->compiled.shaders[index].stage); });
}

relievo_status relievo_program_output(const relievo_program* program, relievo_shader_stage stage, const char* target,
                                      relievo_bytes* output, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"program", program}, {"target", target}, {"output", output}}); !status) return status;
    if (Status status = require_enum("stage", stage, RELIEVO_COMPUTE + 1); !status) return status;
    const Result<relievo_bytes> found = output_of(program->state->compiled, stage, target);
    if (!found) return tl::unexpected(found.error());
    *output = *found;
    return {};
  });
}

relievo_status relievo_program_binding_count(const relievo_program* program, size_t* count, relievo_error* error) {
  return value(program, count, error, [&] { return program->state->compiled.bindings.size(); });
}

relievo_status relievo_program_binding(const relievo_program* program, size_t index, relievo_binding* binding,
                                       relievo_error* error) {
  return element(program, binding, index, program ? program->state->compiled.bindings.size() : 0, error,
                 [&] { *binding = describe(program->state->compiled.bindings[index], program->state->composed); });
}

relievo_status relievo_program_parameter_count(const relievo_program* program, size_t* count, relievo_error* error) {
  return value(program, count, error, [&] { return program->state->composed.parameters.size(); });
}

relievo_status relievo_program_parameter_at(const relievo_program* program, size_t index,
                                            relievo_program_parameter* parameter, relievo_error* error) {
  return element(program, parameter, index, program ? program->state->composed.parameters.size() : 0, error,
                 [&] { *parameter = describe(program->state->composed.parameters[index]); });
}

relievo_status relievo_program_parameter_block(const relievo_program* program, relievo_bytes* block,
                                               relievo_error* error) {
  return value(program, block, error, [&] { return relievo_bytes{program->block.data(), program->block.size()}; });
}

relievo_status relievo_program_reflection(const relievo_program* program, relievo_string* json, relievo_error* error) {
  return value(program, json, error, [&] { return view(program->state->compiled.reflection); });
}
