/// Composing a permutation: includes, parameters, roles and maps.
#include "relievo/compose.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "relievo/compile.hpp"
#include "relievo/trace.hpp"
#include "support/pipeline.hpp"

namespace relievo::test {
namespace {

/// Our own sources with some files of a technique `mine` on top; its main file is techniques/mine/mine.glsl.
Registry with_technique(const std::string& glsl, const SourceTree& more = {}) {
  SourceTree tree = embedded_sources();
  tree["techniques/mine/technique.toml"] =
      "schema = 1\nname = \"mine\"\ntitle = \"Mine\"\nclass = \"unsafe\"\nfirst_hit = \"never\"\n"
      "module = \"mine.glsl\"\nmaps = [\"height\"]\n";
  tree["techniques/mine/mine.glsl"] = glsl;
  for (const auto& [path, text] : more) tree[path] = text;
  auto loaded = load_registry(tree);
  EXPECT_TRUE(loaded) << (loaded ? "" : format(loaded.error()));
  return loaded ? std::move(*loaded) : Registry{};
}

Permutation ray_of(const std::string& technique) {
  Permutation permutation;
  permutation.stage = "ray";
  permutation.roles["view"] = technique;
  return permutation;
}

Error compose_error(const Registry& from, const Permutation& permutation) {
  const auto composed = compose(from, permutation);
  EXPECT_FALSE(composed) << "composes";
  return composed ? Error{} : composed.error();
}

constexpr const char* trace_function =
    "#include \"shaders/lib/search.glsl\"\n"
    "Hit mine_trace(Ray ray) { return relievo_hit_at(ray, RELIEVO_MISS, 0.0); }\n";

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(ComposeIncludes, AMissingFileIsAnsweredWithTheNearest) {
  const std::string glsl = std::string(trace_function) + "\n#include \"shaders/lib/serch.glsl\"\n";
  const Error error = compose_error(with_technique(glsl), ray_of("mine"));
  EXPECT_EQ(error.id, "compose.missing-include");
  EXPECT_EQ(error.code, ErrorCode::compile);
  EXPECT_EQ(error.file, "techniques/mine/mine.glsl");
  EXPECT_EQ(error.line, 4);
  EXPECT_NE(error.message.find("did you mean \"shaders/lib/search.glsl\"?"), std::string::npos) << error.message;
}

TEST(ComposeIncludes, NothingOutsideTheFolderIsReached) {
  for (const char* name : {"../relief/relief.glsl", "/etc/passwd", "shaders/lib/../../techniques/relief/relief.glsl",
                           "sub/../../relief/relief.glsl", ""}) {
    const std::string glsl = std::string(trace_function) + "#include \"" + name + "\"\n";
    const Error error = compose_error(with_technique(glsl), ray_of("mine"));
    EXPECT_TRUE(error.id == "compose.include-escapes" || error.id == "compose.missing-include") << name << error.id;
    EXPECT_EQ(error.file, "techniques/mine/mine.glsl") << name;
    EXPECT_EQ(error.line, 3) << name;
  }
  const Error escape = compose_error(
      with_technique(std::string(trace_function) + "#include \"../relief/relief.glsl\"\n"), ray_of("mine"));
  EXPECT_EQ(escape.id, "compose.include-escapes");
}

TEST(ComposeIncludes, AFileThatIncludesItselfIsNamedWithTheWholeCycle) {
  const Error self =
      compose_error(with_technique(std::string(trace_function) + "#include \"mine.glsl\"\n"), ray_of("mine"));
  EXPECT_EQ(self.id, "compose.include-cycle");
  EXPECT_EQ(self.line, 3);
  const Error cycle = compose_error(with_technique(std::string(trace_function) + "#include \"a.glsl\"\n",
                                                   {{"techniques/mine/a.glsl", "\n#include \"b.glsl\"\n"},
                                                    {"techniques/mine/b.glsl", "\n\n#include \"a.glsl\"\n"}}),
                                    ray_of("mine"));
  EXPECT_EQ(cycle.id, "compose.include-cycle");
  EXPECT_EQ(cycle.file, "techniques/mine/b.glsl");
  EXPECT_EQ(cycle.line, 3);
  EXPECT_NE(cycle.message.find("techniques/mine/a.glsl -> techniques/mine/b.glsl -> techniques/mine/a.glsl"),
            std::string::npos)
      << cycle.message;
}

TEST(ComposeIncludes, AFileIsIncludedOnce) {
  const std::string helper = "float mine_helper() { return 1.0; }\n";
  const Registry from = with_technique(
      "#include \"helper.glsl\"\n#include \"other.glsl\"\n" + std::string(trace_function),
      {{"techniques/mine/helper.glsl", helper}, {"techniques/mine/other.glsl", "#include \"helper.glsl\"\n"}});
  const auto composed = compose(from, ray_of("mine"));
  ASSERT_TRUE(composed) << format(composed.error());
  EXPECT_EQ(count(composed->shaders[0].text, "float mine_helper()"), 1U);
  EXPECT_EQ(count(composed->shaders[0].text, "struct Ray {"), 1U);
  const auto& files = composed->shaders[0].files;
  EXPECT_EQ(std::count(files.begin(), files.end(), "techniques/mine/helper.glsl"), 1);
  EXPECT_EQ(std::count(files.begin(), files.end(), "shaders/lib/search.glsl"), 1);
  EXPECT_TRUE(compile(*composed, {}));
}

/// `fault` at `line` of the technique's second included file, and what compile() says of it.
Error compile_error(const std::string& second, const std::string& main_tail = {}) {
  const Registry from =
      with_technique("#include \"first.glsl\"\n#include \"second.glsl\"\n" + std::string(trace_function) + main_tail,
                     {{"techniques/mine/first.glsl", "// one line\nfloat mine_first() { return 1.0; }\n"},
                      {"techniques/mine/second.glsl", second}});
  const auto composed = compose(from, ray_of("mine"));
  EXPECT_TRUE(composed) << (composed ? "" : format(composed.error()));
  if (!composed) return {};
  const auto compiled = compile(*composed, {});
  EXPECT_FALSE(compiled) << "compiles";
  return compiled ? Error{} : compiled.error();
}

TEST(ComposeIncludes, ErrorsNameTheAuthorsFileAndLineThroughIncludes) {
  const Error second = compile_error("// a comment\n\nfloat mine_second() { return missing_name; }\n");
  EXPECT_EQ(second.id, "compile.glsl");
  EXPECT_EQ(second.file, "techniques/mine/second.glsl");
  EXPECT_EQ(second.line, 3);
  EXPECT_NE(second.message.find("missing_name"), std::string::npos) << second.message;
  const Error after =
      compile_error("float mine_second() { return 1.0; }\n", "\nfloat mine_late() { return absent; }\n");
  EXPECT_EQ(after.file, "techniques/mine/mine.glsl");
  EXPECT_EQ(after.line, 6) << "lines are counted on after an include";
  const Error syntax = compile_error("float mine_second() { return 1.0 }\n");
  EXPECT_EQ(syntax.file, "techniques/mine/second.glsl");
  EXPECT_EQ(syntax.line, 1);
}

TEST(ComposeIncludes, AFileWithoutALastNewlineEndsWhereItEnds) {
  const Error error =
      compile_error("float mine_second() { return 1.0; }  // no newline", "float mine_late() { return absent; }");
  EXPECT_EQ(error.file, "techniques/mine/mine.glsl");
  EXPECT_EQ(error.line, 5);
}

TEST(ComposeParameters, AllBindingTimesGiveTheSameHits) {
  const HeightMap map{4,
                      4,
                      {0.1f, 0.9f, 0.3f, 0.5f, 0.2f, 0.8f, 0.6f, 0.4f, 0.7f, 0.1f, 0.9f, 0.2f, 0.5f, 0.3f, 0.8f, 0.6f},
                      AddressMode::repeat};
  const std::vector<Ray> rays = make_view_rays(40, 0.2, 16, 16);
  std::vector<std::vector<std::byte>> results;
  for (const BindingTime time : {BindingTime::uniform, BindingTime::specialization, BindingTime::macro}) {
    Permutation permutation = ray_of("relief");
    permutation.values["relief.linear_steps"] = 37;
    permutation.binding_times["relief.linear_steps"] = time;
    const auto prepared = prepare(registry(), permutation, "spirv");
    ASSERT_TRUE(prepared) << format(prepared.error());
    const auto& slots = prepared->composed.parameters;
    const auto slot =
        std::find_if(slots.begin(), slots.end(), [](const auto& s) { return s.name == "relief.linear_steps"; });
    ASSERT_NE(slot, slots.end());
    EXPECT_EQ(slot->value, 37);
    EXPECT_EQ(slot->offset >= 0, time == BindingTime::uniform);
    EXPECT_EQ(slot->constant_id >= 0, time == BindingTime::specialization);
    const TraceRequest request = request_of("relief", permutation.values);
    auto job = make_trace_job(registry(), map_set(map), rays, {&request, 1}, "spirv");
    ASSERT_TRUE(job) << format(job.error());
    job->programs[0] = prepared->program;
    // The job's own block was laid out for uniforms; the other times have fewer members or none.
    Dispatch& dispatch = std::get<Dispatch>(job->commands[0]);
    std::erase_if(dispatch.resources, [](const ResourceBinding& r) { return r.set == 0 && r.binding == 0; });
    const std::vector<std::byte> block = parameter_block(prepared->composed);
    const bool has_block = std::any_of(prepared->program.bindings.begin(), prepared->program.bindings.end(),
                                       [](const BindingSlot& s) { return s.set == 0 && s.binding == 0; });
    if (has_block) {
      dispatch.resources.push_back({0, 0, static_cast<int>(job->buffers.size())});
      job->buffers.push_back({"Parameters", block.size(), block});
    }
    const auto result = backend("vulkan").execute(*job);
    ASSERT_TRUE(result) << format(result.error());
    EXPECT_THAT(result->messages, ::testing::IsEmpty());
    results.push_back(result->read_backs.at(0));
  }
  EXPECT_EQ(results[0], results[1]) << "specialization";
  EXPECT_EQ(results[0], results[2]) << "macro";
  const TraceRequest fewer = request_of("relief", {{"relief.linear_steps", 3}});
  const auto job = make_trace_job(registry(), map_set(map), rays, {&fewer, 1}, "spirv");
  ASSERT_TRUE(job);
  EXPECT_NE(backend("vulkan").execute(*job)->read_backs.at(0), results[0]) << "the value does nothing";
}

TEST(MakeTraceJob, NamesTheMapThatIsMissing) {
  const Ray ray{0.5, 0.5, 1, 0, 0, -1};
  const TraceRequest request = request_of("exact", {});
  const auto without_height = make_trace_job(registry(), {}, {&ray, 1}, {&request, 1}, "spirv");
  ASSERT_FALSE(without_height);
  EXPECT_EQ(without_height.error().id, "maps.missing");
  const auto unbaked = make_trace_job(registry(), map_set(HeightMap{1, 1, {0.5f}}), {&ray, 1}, {&request, 1}, "spirv");
  ASSERT_FALSE(unbaked);
  EXPECT_EQ(unbaked.error().id, "maps.missing");
  EXPECT_NE(unbaked.error().message.find("'max_pyramid'"), std::string::npos) << unbaked.error().message;
}

TEST(ComposeParameters, AnUnknownNameIsAnsweredWithTheNearest) {
  Permutation permutation = ray_of("relief");
  permutation.values["relief.linear_stepz"] = 3;
  const Error value = compose_error(registry(), permutation);
  EXPECT_EQ(value.id, "compose.unknown-parameter");
  EXPECT_NE(value.message.find("'relief.linear_steps'"), std::string::npos) << value.message;
  permutation.values.clear();
  permutation.binding_times["relief.binary_step"] = BindingTime::macro;
  const Error time = compose_error(registry(), permutation);
  EXPECT_EQ(time.id, "compose.unknown-parameter");
  EXPECT_NE(time.message.find("'relief.binary_steps'"), std::string::npos) << time.message;
}

TEST(ComposeParameters, ValuesOutOfRangeAreRefusedWithTheRange) {
  for (const double bad :
       {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Permutation permutation = ray_of("relief");
    permutation.values["relief.linear_steps"] = bad;
    const Error error = compose_error(registry(), permutation);
    EXPECT_EQ(error.id, "compose.range") << bad;
    EXPECT_NE(error.message.find("1 to 65536"), std::string::npos) << error.message;
  }
  Permutation fraction = ray_of("relief");
  fraction.values["relief.linear_steps"] = 2.5;
  EXPECT_EQ(compose_error(registry(), fraction).id, "compose.type");
}

TEST(ComposeRoles, MissingAndUnknownRolesAreNamed) {
  Permutation none = ray_of("relief");
  none.roles.clear();
  const Error missing = compose_error(registry(), none);
  EXPECT_EQ(missing.id, "compose.role-missing");
  EXPECT_NE(missing.message.find("'view'"), std::string::npos) << missing.message;
  Permutation more = ray_of("relief");
  more.roles["vieww"] = "relief";
  const Error unknown = compose_error(registry(), more);
  EXPECT_EQ(unknown.id, "compose.role-unknown");
  EXPECT_NE(unknown.message.find("'vieww'"), std::string::npos) << unknown.message;
  const Error technique = compose_error(registry(), ray_of("releif"));
  EXPECT_EQ(technique.id, "describe.unknown-technique");
  EXPECT_NE(technique.message.find("relief"), std::string::npos) << technique.message;
  Permutation stage = ray_of("relief");
  stage.stage = "rays";
  EXPECT_EQ(compose_error(registry(), stage).id, "describe.unknown-stage");
  Permutation nothing_traced = ray_of("relief");
  nothing_traced.stage = "vertex";
  EXPECT_EQ(compose_error(registry(), nothing_traced).id, "compose.role-unknown");
}

std::string all_text(const ComposedProgram& program) {
  std::string text;
  for (const ComposedShader& shader : program.shaders) text += shader.text;
  return text;
}

TEST(ComposeMaps, AMapThatIsNotUsedIsNotDeclared) {
  const auto bump = compose(registry(), ray_of("bump")), relief = compose(registry(), ray_of("relief"));
  ASSERT_TRUE(bump && relief);
  EXPECT_EQ(all_text(*bump).find("sampler2D"), std::string::npos) << "bump reads no height";
  EXPECT_NE(all_text(*relief).find("relievo_height_map"), std::string::npos);
  EXPECT_EQ(all_text(*relief).find("relievo_normal_map"), std::string::npos) << "rays are not shaded";
  const auto compiled = compile(*bump, {});
  ASSERT_TRUE(compiled) << format(compiled.error());
  for (const BindingSlot& slot : compiled->bindings) EXPECT_NE(slot.kind, ResourceKind::sampled_texture) << slot.name;
  const auto sampled = compile(*relief, {});
  ASSERT_TRUE(sampled) << format(sampled.error());
  EXPECT_EQ(std::count_if(sampled->bindings.begin(), sampled->bindings.end(),
                          [](const BindingSlot& s) { return s.kind == ResourceKind::sampled_texture; }),
            1);
}

TEST(ComposeMaps, OnlyTheShaderThatTracesHoldsTheTechnique) {
  Permutation permutation = ray_of("relief");
  permutation.stage = "surface";
  const auto composed = compose(registry(), permutation);
  ASSERT_TRUE(composed) << format(composed.error());
  for (const ComposedShader& shader : composed->shaders) {
    const bool traces = shader.text.find("Hit relief_trace(Ray ray)") != std::string::npos;
    EXPECT_EQ(traces, shader.stage == ShaderStage::fragment) << to_string(shader.stage);
    const bool samples = shader.text.find("sampler2D") != std::string::npos;
    EXPECT_EQ(samples, shader.stage == ShaderStage::fragment) << to_string(shader.stage);
  }
}

TEST(ComposeMaps, CountingIsCompiledInOnRequestOnly) {
  Permutation counted = ray_of("relief");
  counted.count_cost = true;
  const auto with = compose(registry(), counted), without = compose(registry(), ray_of("relief"));
  ASSERT_TRUE(with && without);
  EXPECT_NE(all_text(*with).find("#define RELIEVO_COUNT 1"), std::string::npos);
  EXPECT_NE(all_text(*without).find("#define RELIEVO_COUNT 0"), std::string::npos);
  EXPECT_NE(with->key, without->key);
}

TEST(ComposeKey, PermutationsThatDifferHaveDifferentKeys) {
  std::set<std::string> keys;
  int permutations = 0;
  for (const char* technique : {"relief", "bump"}) {
    for (const HeightFilter filter : {HeightFilter::exact, HeightFilter::hardware}) {
      for (const AddressMode address : {AddressMode::repeat, AddressMode::clip}) {
        for (const bool counted : {false, true}) {
          Permutation permutation = ray_of(technique);
          permutation.filter = filter;
          permutation.address = address;
          permutation.count_cost = counted;
          keys.insert(permutation.key());
          permutation.values["ray.scale"] = 0.25;
          keys.insert(permutation.key());
          permutation.binding_times["ray.scale"] = BindingTime::macro;
          keys.insert(permutation.key());
          permutations += 3;
        }
      }
    }
  }
  EXPECT_EQ(keys.size(), static_cast<std::size_t>(permutations));
}

TEST(ComposeBake, AProvidedMapHasNothingToBake) {
  const auto height = compose_bake(registry(), "height", AddressMode::repeat);
  ASSERT_FALSE(height);
  EXPECT_EQ(height.error().id, "compose.provided-map");
  const auto unknown = compose_bake(registry(), "normals", AddressMode::repeat);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().id, "describe.unknown-map");
}

TEST(ComposeBake, EachPhaseIsAProgramOfItsOwn) {
  std::set<std::string> texts;
  const int phases = static_cast<int>(registry().maps.at("robust_cone").passes.size());
  for (int phase = 0; phase < phases; ++phase) {
    const auto composed = compose_bake(registry(), "robust_cone", AddressMode::repeat, {}, {phase, 1});
    ASSERT_TRUE(composed) << format(composed.error());
    texts.insert(all_text(*composed));
  }
  EXPECT_EQ(texts.size(), 3u);
  for (const BakeProgram wrong :
       {BakeProgram{phases, 1}, BakeProgram{-1, 1}, BakeProgram{0, 0}, BakeProgram{0, most_bake_buffers + 1}}) {
    const auto refused = compose_bake(registry(), "robust_cone", AddressMode::repeat, {}, wrong);
    ASSERT_FALSE(refused) << wrong.phase << ", " << wrong.buffers;
    EXPECT_EQ(refused.error().id, "compose.bake");
  }
}

/// Names of the textures that a program samples, rather than fetches.
std::vector<std::string> filtered_in(const Result<ComposedProgram>& composed) {
  EXPECT_TRUE(composed) << format(composed.error());
  const auto compiled = compile(*composed, {});
  EXPECT_TRUE(compiled) << format(compiled.error());
  std::vector<std::string> names;
  for (const BindingSlot& slot : compiled->bindings) {
    if (slot.is_filtered) names.push_back(slot.name);
  }
  return names;
}

TEST(ComposeFilters, NoBakeNeedsATextureUnitThatFilters) {
  for (const auto& [name, map] : registry().maps) {
    if (map.module.empty()) continue;
    EXPECT_THAT(filtered_in(compose_bake(registry(), name, AddressMode::repeat)), testing::IsEmpty()) << name;
  }
}

std::vector<std::string> filtered_by(const std::string& technique, HeightFilter filter) {
  Permutation permutation = ray_of(technique);
  permutation.filter = filter;
  return filtered_in(compose(registry(), permutation));
}

TEST(ComposeFilters, StagesThatTakeNormalsFromHeightsSampleNothingWithTheExactFilter) {
  for (const auto& [name, stage] : registry().stages) {
    const std::string axis = name + ".normal_source";
    const bool has_axis = std::any_of(stage.parameters.begin(), stage.parameters.end(),
                                      [](const Parameter& one) { return one.name == "normal_source"; });
    if (!has_axis) continue;
    Permutation permutation;
    permutation.stage = name;
    for (const std::string& role : stage.roles) permutation.roles[role] = "relief";
    EXPECT_THAT(filtered_in(compose(registry(), permutation)), testing::ElementsAre("relievo_normal_map")) << name;
    permutation.values[axis] = 1;
    EXPECT_THAT(filtered_in(compose(registry(), permutation)), testing::IsEmpty()) << name;
  }
}

TEST(ComposeFilters, TheExactFilterSamplesNothingButNormals) {
  for (const auto& [name, technique] : registry().techniques) {
    if (technique.technique_class == TechniqueClass::reference) continue;
    EXPECT_THAT(filtered_by(name, HeightFilter::exact), testing::Each("relievo_normal_map")) << name;
    if (technique.first_hit != FirstHit::always) continue;
    EXPECT_THAT(filtered_by(name, HeightFilter::hardware), testing::IsEmpty()) << name;
  }
  EXPECT_THAT(filtered_by("relief", HeightFilter::hardware), testing::ElementsAre("relievo_height_map"));
  EXPECT_THAT(filtered_by("sphere_tracing", HeightFilter::hardware), testing::Contains("relievo_distance_field_map"));
}

}  // namespace
}  // namespace relievo::test
