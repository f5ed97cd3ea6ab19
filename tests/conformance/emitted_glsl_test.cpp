/// Every emitted GLSL and ESSL goes through the driver's own compiler and linker.
#include <gtest/gtest.h>

#include "support/gl_compiler.hpp"
#include "support/sample_programs.hpp"

namespace relievo {
namespace {

using testing::GlCompiler;

std::vector<Target> targets_of(std::initializer_list<const char*> names) {
  std::vector<Target> targets;
  for (const char* name : names) targets.push_back(*parse_target(name));
  return targets;
}

/// Compiles the sample for each target, optimized and not, and gives the texts to the driver.
void expect_linked(const ComposedProgram& program, const std::vector<Target>& targets) {
  std::string reason;
  for (const Target& target : targets) {
    const auto driver = GlCompiler::create(target.language, reason);
    ASSERT_TRUE(driver) << reason;
    for (const bool optimize : {true, false}) {
      const auto compiled = compile(program, {&target, 1}, {optimize, true});
      ASSERT_TRUE(compiled) << compiled.error().message;
      EXPECT_EQ(driver->check(target, *compiled), "");
    }
  }
}

TEST(EmittedGlsl, ComputeLinks) {
  const auto targets = targets_of({"glsl-430", "glsl-450", "essl-310"});
  expect_linked(testing::ray_sample(), targets);
  expect_linked(testing::bake_sample(), targets);
}

TEST(EmittedGlsl, SurfaceLinks) {
  expect_linked(testing::surface_sample(), targets_of({"glsl-330", "glsl-430", "glsl-450", "essl-300", "essl-310"}));
}

TEST(EmittedGlsl, GeometryLinksOnDesktopAndOnEssl310) {
  expect_linked(testing::prism_sample(), targets_of({"glsl-330", "glsl-430", "glsl-450", "essl-310"}));
}

TEST(EmittedGlsl, TessellationLinksOnDesktopAndOnEssl310) {
  expect_linked(testing::tessellation_sample(), targets_of({"glsl-430", "glsl-450", "essl-310"}));
}

TEST(EmittedGlsl, TheDriverCatchesASeededFault) {
  std::string reason;
  const auto driver = GlCompiler::create(Language::glsl, reason);
  ASSERT_TRUE(driver) << reason;
  const Target target = *parse_target("glsl-330");
  auto compiled = compile(testing::surface_sample(), {&target, 1});
  ASSERT_TRUE(compiled) << compiled.error().message;
  CompiledProgram retyped = *compiled;
  std::string& text = retyped.shaders[1].text.at("glsl-330");
  text.replace(text.find("in vec2 relievo_vertex_out_1"), 7, "in vec3");
  EXPECT_NE(driver->check(target, retyped), "") << "a varying of two types";
  compiled->bindings[0].name = "Lost";
  EXPECT_NE(driver->check(target, *compiled), "") << "a block that is not there";
}

}  // namespace
}  // namespace relievo
