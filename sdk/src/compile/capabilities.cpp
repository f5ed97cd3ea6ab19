#include "compile/capabilities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

namespace relievo {

namespace {

constexpr int kAll = 0;       ///< every version has it
constexpr int kNever = 9999;  ///< no version has it

/// One row: the first version of each language that has a feature. With a stage, the row is about that stage only.
struct Rule {
  std::string_view feature;
  std::optional<ShaderStage> stage;
  std::string_view words;  ///< "target X has no <words>"
  bool is_stage_shape;     ///< another stage avoids it
  int glsl, essl, hlsl, msl;
};

constexpr std::optional<ShaderStage> kAnyStage = std::nullopt;

// clang-format off
constexpr Rule kTable[] = {
    // feature           stage                 words                     shape  GLSL    ESSL    HLSL    MSL
    {"compute",          kAnyStage,            "compute shaders",        true,  430,    310,    kAll,   kAll},
    {"geometry",         kAnyStage,            "geometry shaders",       true,  kAll,   310,    kNever, kNever},
    {"tessellation",     kAnyStage,            "tessellation shaders",   true,  400,    310,    kNever, kNever},
    {"texture_3d",       kAnyStage,            "3D textures",            false, kAll,   kAll,   kAll,   kAll},
    {"explicit_lod",     kAnyStage,            "texture reads with explicit LOD", false, kAll, kAll, kAll, kAll},
    {"gather",           kAnyStage,            "texture gather",         false, 400,    310,    kAll,   kAll},
    {"dynamic_loops",    kAnyStage,            "dynamic loops",          false, kAll,   kAll,   kAll,   kAll},
    {"vertex_texture",   kAnyStage,            "textures in vertex shaders", false, kAll, kAll, kAll,   kAll},
    {"depth_write",      kAnyStage,            "depth writes",           false, kAll,   kAll,   kAll,   kAll},
    {"storage_buffer",   kAnyStage,            "storage buffers",        false, 430,    310,    kAll,   kAll},
    {"storage_image",    kAnyStage,            "storage images",         false, 420,    310,    kAll,   kAll},
    {"extended_images",  kAnyStage,            "storage images of all formats",  false, 420, kNever, kAll, kAll},
    {"storage_write",    ShaderStage::vertex,  "storage writes in vertex shaders", false, 430, 310, 51, kAll},
    {"query_lod",        kAnyStage,            "textureQueryLod",        false, 400,    kNever, kAll,   22},
    {"query_levels",     kAnyStage,            "textureQueryLevels",     false, 430,    kNever, kAll,   kAll},
    {"float64",          kAnyStage,            "double precision",       false, 400,    kNever, kAll,   kNever},
};
// clang-format on

int first_version(const Rule& rule, Language language) {
  switch (language) {
    case Language::spirv:
      return kAll;
    case Language::glsl:
      return rule.glsl;
    case Language::essl:
      return rule.essl;
    case Language::hlsl:
      return rule.hlsl;
    case Language::msl:
      return rule.msl;
  }
  return kAll;
}

/// The lowest target of the same language that has the feature.
std::optional<Target> better_target(const Rule& rule, const Target& target) {
  for (const Target& other : all_targets()) {
    if (other.language == target.language && other.version >= first_version(rule, other.language)) return other;
  }
  return std::nullopt;
}

Status refuse(const Rule& rule, const Target& target, const ComposedProgram& program, std::string_view fallback_stage) {
  std::string advice = "there is no fallback";
  if (rule.is_stage_shape && !fallback_stage.empty()) {
    advice = fmt::format("use stage '{}' instead", fallback_stage);
  } else if (const auto other = better_target(rule, target)) {
    advice = fmt::format("use target {} or higher", to_string(*other));
  }
  const std::string subject =
      program.stage.empty() ? fmt::format("permutation '{}'", program.key) : fmt::format("stage '{}'", program.stage);
  std::string id = fmt::format("capability.{}", rule.feature);
  std::replace(id.begin(), id.end(), '_', '-');
  return fail(ErrorCode::unsupported, std::move(id),
              fmt::format("target {} has no {} for {}; {}", to_string(target), rule.words, subject, advice));
}

Status check_feature(std::string_view feature, ShaderStage stage, const Target& target, const ComposedProgram& program,
                     std::string_view fallback_stage) {
  for (const Rule& rule : kTable) {
    if (rule.feature != feature || (rule.stage && *rule.stage != stage)) continue;
    if (target.version < first_version(rule, target.language)) return refuse(rule, target, program, fallback_stage);
  }
  return {};
}

/// The feature that the mere presence of a shader needs; empty for vertex and fragment.
std::string_view feature_of(ShaderStage stage) {
  switch (stage) {
    case ShaderStage::compute:
      return "compute";
    case ShaderStage::geometry:
      return "geometry";
    case ShaderStage::tessellation_control:
    case ShaderStage::tessellation_evaluation:
      return "tessellation";
    default:
      return {};
  }
}

std::string_view feature_of(const SpirvInstruction& instruction) {
  switch (instruction.opcode) {
    case spv::OpImageGather:
    case spv::OpImageDrefGather:
      return "gather";
    case spv::OpImageQueryLod:
      return "query_lod";
    case spv::OpImageQueryLevels:
      return "query_levels";
    case spv::OpCapability:
      if (instruction.operands[0] == spv::CapabilityFloat64) return "float64";
      if (instruction.operands[0] == spv::CapabilityStorageImageExtendedFormats) return "extended_images";
      return {};
    default:
      return {};
  }
}

bool writes_storage(const ShaderModule& module) {
  const auto& resources = module.resources;
  const auto& reflection = *module.reflection;
  return std::any_of(
             resources.storage_buffers.begin(), resources.storage_buffers.end(),
             [&](const auto& b) { return !reflection.get_buffer_block_flags(b.id).get(spv::DecorationNonWritable); }) ||
         std::any_of(resources.storage_images.begin(), resources.storage_images.end(),
                     [&](const auto& i) { return !reflection.has_decoration(i.id, spv::DecorationNonWritable); });
}

FeatureSet used_features(const ShaderModule& module) {
  FeatureSet features;
  for_each_instruction(*module.spirv, [&](const SpirvInstruction& instruction) {
    if (const std::string_view feature = feature_of(instruction); !feature.empty()) features.emplace(feature);
  });
  if (!module.resources.storage_buffers.empty()) features.insert("storage_buffer");
  if (!module.resources.storage_images.empty()) features.insert("storage_image");
  if (writes_storage(module)) features.insert("storage_write");
  return features;
}

}  // namespace

Status check_capabilities(const Target& target, const ComposedProgram& program, std::string_view fallback_stage) {
  // The stage's shape first: its fallback also answers for what else is missing.
  for (const ComposedShader& shader : program.shaders) {
    if (auto ok = check_feature(feature_of(shader.stage), shader.stage, target, program, fallback_stage); !ok)
      return ok;
  }
  for (const ComposedShader& shader : program.shaders) {
    for (const std::string& feature : program.features) {
      if (auto ok = check_feature(feature, shader.stage, target, program, fallback_stage); !ok) return ok;
    }
  }
  return {};
}

Status check_module_capabilities(const Target& target, const ShaderModule& module, const ComposedProgram& program,
                                 std::string_view fallback_stage) {
  for (const std::string& feature : used_features(module)) {
    if (auto ok = check_feature(feature, module.stage, target, program, fallback_stage); !ok) return ok;
  }
  return {};
}

}  // namespace relievo
