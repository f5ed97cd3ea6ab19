/// Every technique in every stage for every target: composed, compiled, and read again by a second front end.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/gl_compiler.hpp"
#include "support/height_maps.hpp"
#include "support/pipeline.hpp"
#include "support/target_checks.hpp"

namespace relievo::test {
namespace {

using relievo::testing::GlCompiler;

/// What was checked, so that a silent skip is seen.
struct Tally {
  int programs = 0, texts = 0, linked_by_driver = 0, refused = 0;
};

bool is_gl(const Target& target) {
  return target.language == Language::glsl || target.language == Language::essl;
}

/// What a target's refusal must look like, by the table of docs/targets.md: geometry has a fallback, compute a version.
void expect_refusal(const Error& error, const StageDescriptor& stage, const Target& target) {
  const std::string name = to_string(target);
  EXPECT_EQ(error.code, ErrorCode::unsupported) << name << ": " << format(error);
  EXPECT_TRUE(error.id.starts_with("capability.")) << error.id;
  const bool later_version = error.message.find(" or higher") != std::string::npos;
  const bool fallback = !stage.fallback.empty() && error.message.find("'" + stage.fallback + "'") != std::string::npos;
  EXPECT_TRUE(later_version || fallback) << error.message;
}

/// Splits the targets into those that compile and those that are refused, without compiling.
std::vector<Target> allowed_targets(const ComposedProgram& composed, const StageDescriptor& stage, Tally& tally) {
  std::vector<Target> allowed;
  for (const Target& target : all_targets()) {
    const Status status = check_capabilities(target, composed, stage.fallback);
    if (status) {
      allowed.push_back(target);
      continue;
    }
    ++tally.refused;
    expect_refusal(status.error(), stage, target);
    const auto compiled = compile(composed, {&target, 1}, {}, stage.fallback);
    EXPECT_TRUE(!compiled && compiled.error().id == status.error().id) << composed.key << " " << to_string(target);
  }
  return allowed;
}

void check_compiled(const ComposedProgram& composed, const StageDescriptor& stage, Tally& tally) {
  const std::vector<Target> targets = allowed_targets(composed, stage, tally);
  const auto compiled = compile(composed, targets, {}, stage.fallback);
  ASSERT_TRUE(compiled) << composed.key << ": " << format(compiled.error());
  EXPECT_EQ(relievo::testing::check_program(*compiled), "") << composed.key;
  ++tally.programs;
  for (const CompiledShader& shader : compiled->shaders) tally.texts += static_cast<int>(shader.text.size());
  for (const Target& target : targets) {
    if (!is_gl(target)) continue;
    std::string reason;
    const auto driver = GlCompiler::create(target.language, reason);
    ASSERT_TRUE(driver) << reason;
    EXPECT_EQ(driver->check(target, *compiled), "") << composed.key << " " << to_string(target);
    ++tally.linked_by_driver;
  }
}

Permutation permutation_of(const StageDescriptor& stage, const std::string& technique) {
  Permutation permutation;
  permutation.stage = stage.name;
  for (const std::string& role : stage.roles) permutation.roles[role] = technique;
  return permutation;
}

void check_permutation(const Permutation& permutation, const StageDescriptor& stage, Tally& tally) {
  const auto composed = compose(registry(), permutation);
  ASSERT_TRUE(composed) << permutation.key() << ": " << format(composed.error());
  check_compiled(*composed, stage, tally);
}

TEST(TechniquesTargets, EveryTechniqueInEveryStageCompilesForEveryTargetOrIsRefused) {
  Tally tally;
  int tracing = 0, displacing = 0, expected_outcomes = 0;
  for (const auto& [name, stage] : registry().stages) {
    const auto techniques = stage.roles.empty() ? std::vector<std::string>{""} : technique_names();
    (stage.roles.empty() ? displacing : tracing) += 1;
    for (const std::string& technique : techniques) {
      check_permutation(permutation_of(stage, technique), stage, tally);
      expected_outcomes += static_cast<int>(stage.shaders.size() * (all_targets().size() - 1));
    }
    (void)name;
  }
  const int techniques = static_cast<int>(technique_names().size());
  EXPECT_GE(techniques, 5);
  EXPECT_GE(tracing, 3) << "ray, surface, prism";
  EXPECT_GE(displacing, 1) << "vertex";
  EXPECT_EQ(tally.programs, tracing * techniques + displacing);
  // Each shader of each program has one text a target but SPIR-V, unless the target is refused.
  EXPECT_GE(tally.texts, expected_outcomes - tally.refused * 3);
  EXPECT_GE(tally.linked_by_driver, techniques * (3 + 5 + 4)) << "ray 3, surface 5, prism 4 versions";
  // ray: GLSL 330 and ESSL 300; prism: ESSL 300, HLSL and MSL.
  EXPECT_GE(tally.refused, techniques * (2 + 5));
  RecordProperty("programs", tally.programs);
  RecordProperty("texts", tally.texts);
  fmt::print("{} programs, {} texts, {} linked by the driver, {} refused\n", tally.programs, tally.texts,
             tally.linked_by_driver, tally.refused);
}

TEST(TechniquesTargets, FiltersAndAddressModesCompileForEveryTarget) {
  Tally tally;
  const StageDescriptor& stage = registry().stages.at("surface");
  for (const HeightFilter filter : {HeightFilter::hardware, HeightFilter::exact}) {
    for (const AddressMode address : all_address_modes) {
      for (const bool count : {false, true}) {
        Permutation permutation = permutation_of(stage, "relief");
        permutation.filter = filter;
        permutation.address = address;
        permutation.count_cost = count;
        check_permutation(permutation, stage, tally);
      }
    }
  }
  EXPECT_EQ(tally.programs, 16);
  EXPECT_EQ(tally.linked_by_driver, 16 * 5);
  EXPECT_EQ(tally.refused, 0);
}

TEST(TechniquesTargets, EveryAovOfEveryDrawingStageCompilesForEveryTarget) {
  Tally tally;
  int drawing = 0;
  for (const auto& [name, stage] : registry().stages) {
    if (stage.mesh == "none") continue;
    ++drawing;
    for (int aov = 0; aov < 8; ++aov) {
      Permutation permutation = permutation_of(stage, "relief");
      permutation.aov = static_cast<Aov>(aov);
      check_permutation(permutation, stage, tally);
    }
    (void)name;
  }
  EXPECT_EQ(tally.programs, 8 * drawing);
  EXPECT_GE(drawing, 3);
}

TEST(TechniquesTargets, EveryMapIsBakedByAProgramThatCompilesWhereComputeExists) {
  Tally tally;
  StageDescriptor bake;
  for (const auto& [name, map] : registry().maps) {
    if (map.module.empty()) continue;
    for (int phase = 0; phase < static_cast<int>(map.passes.size()); ++phase) {
      const auto composed = compose_bake(registry(), name, AddressMode::repeat, {}, {phase, 1});
      ASSERT_TRUE(composed) << format(composed.error());
      check_compiled(*composed, bake, tally);
    }
  }
  EXPECT_GE(tally.programs, 1);
  EXPECT_EQ(tally.refused, 2 * tally.programs) << "GLSL 330 and ESSL 300 have no compute";
}

TEST(TechniquesTargets, EveryBindingTimeOfEveryParameterCompilesForEveryTarget) {
  Tally tally;
  const StageDescriptor& stage = registry().stages.at("surface");
  for (const BindingTime time : {BindingTime::macro, BindingTime::specialization, BindingTime::uniform}) {
    Permutation permutation = permutation_of(stage, "relief");
    for (const Parameter& parameter : registry().techniques.at("relief").parameters)
      permutation.binding_times["relief." + parameter.name] = time;
    check_permutation(permutation, stage, tally);
  }
  EXPECT_EQ(tally.programs, 3);
}

TEST(TechniquesTargets, PrismIsRefusedOnHlslAndMetalWithPrismPulledNamed) {
  const auto composed = compose(registry(), permutation_of(registry().stages.at("prism"), "relief"));
  ASSERT_TRUE(composed) << format(composed.error());
  for (const char* name : {"hlsl-5.0", "hlsl-5.1", "hlsl-6.0", "msl-2.2"}) {
    const Status status = check_capabilities(*parse_target(name), *composed, registry().stages.at("prism").fallback);
    ASSERT_FALSE(status) << name;
    EXPECT_EQ(status.error().id, "capability.geometry");
    EXPECT_NE(status.error().message.find("prism_pulled"), std::string::npos) << status.error().message;
  }
}

/// The checks above can fail: each seeded fault in a technique or in an emitted text is caught by the same functions.
TEST(TechniquesTargets, TheChecksCatchSeededFaults) {
  const Target hlsl = *parse_target("hlsl-5.0"), glsl = *parse_target("glsl-450");
  const Target targets[] = {hlsl, glsl};
  const auto composed = compose(registry(), permutation_of(registry().stages.at("surface"), "relief"));
  ASSERT_TRUE(composed) << format(composed.error());
  ComposedProgram broken = *composed;
  broken.shaders[1].text += "\nvoid oops( {\n";
  EXPECT_FALSE(compile(broken, targets));
  const auto compiled = compile(*composed, targets);
  ASSERT_TRUE(compiled) << format(compiled.error());
  ASSERT_EQ(relievo::testing::check_program(*compiled), "");
  for (const char* target : {"hlsl-5.0", "glsl-450"}) {
    CompiledProgram damaged = *compiled;
    std::string& text = damaged.shaders[1].text.at(target);
    text.insert(text.rfind('}'), "undeclared_name = 1.0;");
    EXPECT_NE(relievo::testing::check_program(damaged), "") << target;
  }
  CompiledProgram damaged = *compiled;
  damaged.shaders[0].spirv.resize(damaged.shaders[0].spirv.size() - 2);
  EXPECT_NE(relievo::testing::check_program(damaged), "");
}

}  // namespace
}  // namespace relievo::test
