#include "support/target_checks.hpp"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <memory>
#include <set>
#include <spirv-tools/libspirv.hpp>
#include <sstream>

namespace relievo::testing {

namespace {

constexpr std::uint32_t kSpirv10 = 0x00010000u;

void initialize_once() {
  static const bool initialized = glslang::InitializeProcess();
  static_cast<void>(initialized);
}

EShLanguage language_of(ShaderStage stage) {
  constexpr EShLanguage kStages[] = {EShLangVertex,   EShLangTessControl, EShLangTessEvaluation,
                                     EShLangGeometry, EShLangFragment,    EShLangCompute};
  return kStages[static_cast<int>(stage)];
}

/// Registers of different classes get numbers of their own, as Direct3D has them.
void separate_register_classes(glslang::TShader& shader) {
  shader.setShiftBinding(glslang::EResUbo, 0);
  shader.setShiftBinding(glslang::EResTexture, 100);
  shader.setShiftBinding(glslang::EResSampler, 200);
  shader.setShiftBinding(glslang::EResUav, 300);
  shader.setShiftBinding(glslang::EResSsbo, 400);
  shader.setShiftBinding(glslang::EResImage, 500);
}

std::string validate(const std::vector<std::uint32_t>& words, bool from_hlsl) {
  std::string messages;
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_0);
  tools.SetMessageConsumer([&](spv_message_level_t level, const char*, const spv_position_t&, const char* message) {
    if (level <= SPV_MSG_ERROR) messages += fmt::format("{}\n", message);
  });
  spvtools::ValidatorOptions options;
  options.SetBeforeHlslLegalization(from_hlsl);
  options.SetSkipBlockLayout(from_hlsl);
  if (tools.Validate(words.data(), words.size(), options)) return {};
  return messages.empty() ? "invalid SPIR-V" : messages;
}

/// The user varyings that a text declares with `qualifier`, `in` or `out`.
std::set<std::string> declared_varyings(const std::string& text, const std::string& qualifier) {
  std::set<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line) && line.rfind("void ", 0) != 0;) {
    const std::size_t at = line.find("relievo_");
    const bool declares = (" " + line).find(" " + qualifier + " ") != std::string::npos;
    if (at == std::string::npos || !declares || line.find("_out_") == std::string::npos) continue;
    names.insert(line.substr(at, line.find_first_of("[;", at) - at));
  }
  return names;
}

/// Neither glslang nor Mesa refuses an input that no stage writes; it would silently read zero.
std::string check_varyings(const Target& target, const std::vector<CompiledShader>& shaders) {
  std::set<std::string> written;
  for (const CompiledShader& shader : shaders) {
    const std::string& text = shader.text.at(to_string(target));
    for (const std::string& name : declared_varyings(text, "in")) {
      if (written.count(name) == 0) return fmt::format("'{}' is read and never written", name);
    }
    written = declared_varyings(text, "out");
  }
  return {};
}

/// What a reader without Metal's compiler can tell.
std::string check_msl(const std::string& text) {
  if (text.find("main0(") == std::string::npos) return "no entry point main0";
  if (text.find("unknown") != std::string::npos) return "holds the word 'unknown', which SPIRV-Cross writes when lost";
  return {};
}

}  // namespace

std::string check_glsl_program(const Target& target, const std::vector<CompiledShader>& shaders) {
  initialize_once();
  constexpr auto kMessages = static_cast<EShMessages>(EShMsgDefault | EShMsgCascadingErrors);
  std::vector<std::unique_ptr<glslang::TShader>> parsed;
  glslang::TProgram program;
  for (const CompiledShader& shader : shaders) {
    const char* text = shader.text.at(to_string(target)).c_str();
    parsed.push_back(std::make_unique<glslang::TShader>(language_of(shader.stage)));
    parsed.back()->setStrings(&text, 1);
    if (!parsed.back()->parse(GetDefaultResources(), 100, false, kMessages)) {
      return fmt::format("{} {}: {}\n{}", to_string(target), to_string(shader.stage), parsed.back()->getInfoLog(),
                         text);
    }
    program.addShader(parsed.back().get());
  }
  if (!program.link(kMessages)) return fmt::format("{} does not link: {}", to_string(target), program.getInfoLog());
  return check_varyings(target, shaders);
}

std::string check_hlsl(ShaderStage stage, const std::string& text) {
  initialize_once();
  constexpr auto kMessages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules | EShMsgReadHlsl);
  glslang::TShader shader(language_of(stage));
  glslang::TProgram program;
  const char* strings = text.c_str();
  shader.setStrings(&strings, 1);
  shader.setEntryPoint("main");
  shader.setEnvInput(glslang::EShSourceHlsl, language_of(stage), glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_0);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_0);
  separate_register_classes(shader);
  if (!shader.parse(GetDefaultResources(), 500, false, kMessages))
    return fmt::format("{}\n{}", shader.getInfoLog(), text);
  program.addShader(&shader);
  if (!program.link(kMessages) || !program.mapIO()) return fmt::format("{}\n{}", program.getInfoLog(), text);
  std::vector<std::uint32_t> words;
  glslang::SpvOptions options;
  options.disableOptimizer = true;
  glslang::GlslangToSpv(*program.getIntermediate(language_of(stage)), words, &options);
  const std::string invalid = validate(words, true);
  return invalid.empty() ? invalid : fmt::format("{}\n{}", invalid, text);
}

std::string check_spirv(const std::vector<std::uint32_t>& words) {
  if (words.size() < 2 || words[1] != kSpirv10) return "the header does not say SPIR-V 1.0";
  return validate(words, false);
}

std::string check_program(const CompiledProgram& program) {
  std::set<std::string> target_names;
  for (const CompiledShader& shader : program.shaders) {
    if (std::string reason = check_spirv(shader.spirv); !reason.empty()) return reason;
    for (const auto& [name, text] : shader.text) {
      target_names.insert(name);
      const Target target = *parse_target(name);
      std::string reason;
      if (target.language == Language::hlsl) reason = check_hlsl(shader.stage, text);
      if (target.language == Language::msl) reason = check_msl(text);
      if (!reason.empty()) return fmt::format("{} {}: {}", name, to_string(shader.stage), reason);
    }
  }
  for (const std::string& name : target_names) {
    const Target target = *parse_target(name);
    if (target.language != Language::glsl && target.language != Language::essl) continue;
    if (std::string reason = check_glsl_program(target, program.shaders); !reason.empty()) return reason;
  }
  return {};
}

}  // namespace relievo::testing
