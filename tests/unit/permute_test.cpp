/// Compiling the permutations of a manifest into an archive.
#include "relievo/permute.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <spirv_cross/spirv.hpp>
#include <thread>

#include "compile/front_end.hpp"
#include "permute/cost.hpp"
#include "permute/freeze.hpp"
#include "permute/shards.hpp"
#include "support/files.hpp"
#include "support/pipeline.hpp"

namespace relievo::test {
namespace {

constexpr const char* small =
    "schema = 1\nname = \"small\"\ntargets = [\"spirv-1.0\", \"glsl-450\", \"essl-300\"]\n"
    "[axes]\ntechnique = [\"relief\", \"parallax\"]\nstage = [\"surface\", \"prism\"]\n"
    "depth_write = [\"on\", \"off\"]\n"
    "[axes.\"relief.linear_steps\"]\nvalues = [29753, 31357]\nbinding = \"specialization\"\n"
    "[axes.\"relief.binary_steps\"]\nvalues = [4, 8]\n";

/// A run of the manifest into `path`.
Result<PermuteSummary> run(const Registry& registry, const std::string& text, const std::filesystem::path& path,
                           const PermuteOptions& options = {}) {
  const auto manifest = parse_manifest(text, "relievo.toml");
  if (!manifest) return tl::unexpected(manifest.error());
  const auto plan = plan_permutations(registry, *manifest);
  if (!plan) return tl::unexpected(plan.error());
  return permute(registry, *manifest, *plan, path, options);
}

using Assignment = std::vector<std::pair<std::string_view, std::string_view>>;

std::string glsl(const Archive& archive, const Assignment& assignment) {
  const auto entry = archive.find(assignment);
  EXPECT_TRUE(entry) << (entry ? "" : format(entry.error()));
  if (!entry) return {};
  const auto text = archive.output(*entry, ShaderStage::fragment, *parse_target("glsl-450"));
  EXPECT_TRUE(text) << (text ? "" : format(text.error()));
  return text ? std::string(*text) : std::string();
}

TEST(Permute, RunsAtOnceMayWriteOneArchive) {
  const TemporaryFolder folder;
  std::vector<std::thread> runs;
  for (int i = 0; i < 3; ++i) runs.emplace_back([&] { EXPECT_TRUE(run(registry(), small, folder / "small.rla")); });
  for (std::thread& thread : runs) thread.join();
  ASSERT_TRUE(run(registry(), small, folder / "alone.rla"));
  EXPECT_EQ(TemporaryFolder::read(folder / "small.rla"), TemporaryFolder::read(folder / "alone.rla"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2) << "something is left behind";
}

TEST(Permute, CompilesEveryProgramOnceAndKeepsTheRestAsAliases) {
  TemporaryFolder folder;
  const auto path = folder.path() / "small.rla";
  const auto summary = run(registry(), small, path);
  ASSERT_TRUE(summary) << format(summary.error());
  EXPECT_TRUE(summary->errors.empty());
  // relief: surface 2 × 2 × 2, prism 2 × 2; parallax: surface 2, prism 1; binary steps are a uniform.
  EXPECT_EQ(summary->asked, 15u);
  EXPECT_EQ(summary->pruned, 0u);
  EXPECT_EQ(summary->closures, 4u + 2u + 2u + 1u);
  EXPECT_EQ(summary->programs, summary->closures);
  const auto archive = Archive::open(path);
  ASSERT_TRUE(archive) << format(archive.error());
  EXPECT_EQ(archive->size(), 15u);
  const Assignment four = {{"technique", "relief"}, {"relief.binary_steps", "4"}};
  const Assignment eight = {{"technique", "relief"}, {"relief.binary_steps", "8"}};
  EXPECT_EQ(archive->program(*archive->find(four)), archive->program(*archive->find(eight)));
}

TEST(Permute, FreezesSpecializationConstants) {
  TemporaryFolder folder;
  const auto path = folder.path() / "small.rla";
  ASSERT_TRUE(run(registry(), small, path));
  const auto archive = Archive::open(path);
  ASSERT_TRUE(archive);
  const std::string text = glsl(*archive, {{"relief.linear_steps", "31357"}});
  EXPECT_NE(text.find("31357"), std::string::npos);
  EXPECT_EQ(text.find("29753"), std::string::npos);
  EXPECT_EQ(text.find("constant_id"), std::string::npos);
  const auto entry = archive->find(Assignment{{"relief.linear_steps", "31357"}});
  const auto reflection = nlohmann::json::parse(*archive->reflection(*entry));
  EXPECT_TRUE(reflection.at("specialization_constants").empty());
  for (const auto& parameter : reflection.at("parameters")) EXPECT_NE(parameter.at("name"), "relief.linear_steps");
}

TEST(Permute, SaysWhyATargetIsAbsent) {
  TemporaryFolder folder;
  const auto path = folder.path() / "small.rla";
  ASSERT_TRUE(run(registry(), small, path));
  const auto archive = Archive::open(path);
  const auto entry = archive->find(Assignment{{"stage", "prism"}});
  ASSERT_TRUE(entry) << format(entry.error());
  const auto output = archive->output(*entry, ShaderStage::fragment, *parse_target("essl-300"));
  ASSERT_FALSE(output);
  EXPECT_NE(output.error().message.find("geometry shaders"), std::string::npos) << output.error().message;
}

TEST(Permute, WritesTheSameBytesWhateverTheThreadsTheCacheAndTheShards) {
  TemporaryFolder folder;
  const auto at = [&](const std::string& name) { return folder.path() / name; };
  PermuteOptions options;
  options.threads = 1;
  ASSERT_TRUE(run(registry(), small, at("one"), options));
  const std::string bytes = TemporaryFolder::read(at("one"));
  CacheOptions cache_options;
  cache_options.folder = at("cache");
  const auto cache = open_cache(cache_options);
  ASSERT_TRUE(cache);
  for (const unsigned threads : {2u, 3u}) {
    options.threads = threads;
    options.cache = cache->get();
    const auto summary = run(registry(), small, at("more"), options);
    ASSERT_TRUE(summary);
    EXPECT_EQ(summary->from_cache, threads == 2 ? 0u : summary->closures);
    EXPECT_EQ(TemporaryFolder::read(at("more")), bytes);
  }
  options.cache = nullptr;
  std::vector<std::filesystem::path> parts;
  std::size_t closures = 0;
  for (unsigned i = 0; i < 3; ++i) {
    options.shard = {i, 3};
    parts.push_back(at("part" + std::to_string(i)));
    const auto summary = run(registry(), small, parts.back(), options);
    ASSERT_TRUE(summary);
    EXPECT_GT(summary->closures, 0u);
    closures += summary->closures;
  }
  EXPECT_EQ(closures, 9u);
  ASSERT_TRUE(merge_archives(parts, at("merged")));
  EXPECT_EQ(TemporaryFolder::read(at("merged")), bytes);
}

/// Our own registry with a technique `mine` of this text.
Registry with_technique(const std::string& glsl_text) {
  SourceTree tree = embedded_sources();
  tree["techniques/mine/technique.toml"] =
      "schema = 1\nname = \"mine\"\ntitle = \"Mine\"\nclass = \"unsafe\"\nfirst_hit = \"never\"\n"
      "module = \"mine.glsl\"\nmaps = [\"height\"]\n[loops.steps]\ntitle = \"S\"\nbounds = \"b\"\nmin = 1\nmax = 99\n"
      "default = 7\nbinding = \"macro\"\n";
  tree["techniques/mine/mine.glsl"] = glsl_text;
  return *load_registry(tree);
}

constexpr const char* faulty_manifest =
    "schema = 1\nname = \"faulty\"\ntargets = [\"spirv-1.0\"]\n"
    "[axes]\ntechnique = [\"mine\", \"relief\"]\naddress = [\"repeat\", \"clamp\"]\n\"mine.steps\" = [1, 2, 3, 4]\n";

TEST(Permute, ReportsAnErrorOnceWithItsPlaceAndCount) {
  const Registry faulty = with_technique(
      "#include \"shaders/lib/search.glsl\"\nHit mine_trace(Ray ray) {\n"
      "  return relievo_hit_at(ray, RELIEVO_MISS, undeclared_thing);\n}\n");
  TemporaryFolder folder;
  const auto path = folder.path() / "faulty.rla";
  const auto summary = run(faulty, faulty_manifest, path);
  ASSERT_TRUE(summary) << format(summary.error());
  ASSERT_EQ(summary->errors.size(), 1u);
  const FoldedError& folded = summary->errors[0];
  EXPECT_EQ(folded.count, 8u);
  EXPECT_EQ(summary->failed, 8u);
  EXPECT_EQ(folded.permutations.size(), 3u);
  EXPECT_EQ(folded.error.file, "techniques/mine/mine.glsl");
  EXPECT_EQ(folded.error.line, 3);
  EXPECT_EQ(folded.error.column, 44);
  EXPECT_EQ(folded.error.message.find("permutation"), std::string::npos) << folded.error.message;
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));

  PermuteOptions options;
  options.keep_going = true;
  const auto kept = run(faulty, faulty_manifest, path, options);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->failed, 8u);
  EXPECT_EQ(Archive::open(path)->size(), 2u);
}

TEST(Permute, FindsProgramsThatTextsDoNotTellApart) {
  // The macro is in the text, and does nothing.
  const Registry idle = with_technique(
      "#include \"shaders/lib/search.glsl\"\nHit mine_trace(Ray ray) {\n"
      "  return relievo_hit_at(ray, RELIEVO_MISS, 0.0 * float(mine_steps));\n}\n");
  const Registry unused = with_technique(
      "#include \"shaders/lib/search.glsl\"\nHit mine_trace(Ray ray) {\n"
      "  return relievo_hit_at(ray, RELIEVO_MISS, 0.0);\n}\n");
  TemporaryFolder folder;
  const auto told_apart = run(idle, faulty_manifest, folder.path() / "a.rla");
  ASSERT_TRUE(told_apart);
  EXPECT_EQ(told_apart->closures, 10u);
  const auto same = run(unused, faulty_manifest, folder.path() / "b.rla");
  ASSERT_TRUE(same);
  EXPECT_EQ(same->closures, 10u);
  EXPECT_EQ(same->programs, 4u);
}

TEST(Permute, TakesTheAxisThatATechniqueAdds) {
  SourceTree tree = embedded_sources();
  tree["techniques/mine/technique.toml"] =
      "schema = 1\nname = \"mine\"\ntitle = \"Mine\"\nclass = \"unsafe\"\nfirst_hit = \"never\"\n"
      "module = \"mine.glsl\"\nmaps = [\"height\"]\n[axes.shadow]\ntitle = \"Shadows\"\nvalues = [\"none\", \"hard\", "
      "\"soft\"]\ndefault = \"none\"\nbinding = \"macro\"\n[[axes.shadow.rule]]\nvalues = [\"soft\"]\nrequires = "
      "{filter = "
      "\"exact\"}\n";
  tree["techniques/mine/mine.glsl"] =
      "#include \"shaders/lib/search.glsl\"\nHit mine_trace(Ray ray) {\n#if mine_shadow == mine_shadow_soft\n"
      "  return relievo_hit_at(ray, RELIEVO_MISS, 0.28125);\n#endif\n  return relievo_hit_at(ray, RELIEVO_MISS, "
      "0.0);\n}\n";
  const Registry with_axis = *load_registry(tree);
  const char* manifest =
      "schema = 1\nname = \"axis\"\ntargets = [\"glsl-450\"]\n[axes]\ntechnique = \"mine\"\n"
      "filter = [\"exact\", \"hardware\"]\nshadow = \"all\"\n";
  TemporaryFolder folder;
  const auto summary = run(with_axis, manifest, folder.path() / "axis.rla");
  ASSERT_TRUE(summary) << format(summary.error());
  EXPECT_EQ(summary->asked, 6u);
  EXPECT_EQ(summary->pruned, 1u);
  const auto archive = Archive::open(folder.path() / "axis.rla");
  EXPECT_NE(glsl(*archive, {{"shadow", "soft"}}).find("0.28125"), std::string::npos);
  EXPECT_EQ(glsl(*archive, {{"shadow", "hard"}}).find("0.28125"), std::string::npos);
  EXPECT_EQ(archive->program(*archive->find(Assignment{{"shadow", "hard"}})),
            archive->program(*archive->find(Assignment{})));
}

TEST(Freeze, TurnsOneConstantIntoAnOrdinaryOneAndLeavesTheOther) {
  ComposedProgram program;
  program.key = "freeze";
  program.shaders.push_back(
      {ShaderStage::compute,
       "#version 450\nlayout(local_size_x = 1) in;\nlayout(constant_id = 0) const int a = 3;\n"
       "layout(constant_id = 1) const float b = 2.0;\n"
       "layout(set = 0, binding = 0) buffer Out { float x; };\nvoid main() { x = float(a) * b; }\n",
       {}});
  Crew crew(1);
  const auto words = run_front_end(program, crew);
  ASSERT_TRUE(words);
  const FrozenConstant frozen[] = {{0, 41}};
  const SpirvWords after = freeze(words->front(), frozen);
  int open = 0, spec_ids = 0;
  bool has_value = false;
  for_each_instruction(after, [&](const SpirvInstruction& instruction) {
    open += instruction.opcode == spv::OpSpecConstant ? 1 : 0;
    has_value = has_value || (instruction.opcode == spv::OpConstant && instruction.operands[2] == 41);
    spec_ids += instruction.opcode == spv::OpDecorate && instruction.operands[1] == spv::DecorationSpecId ? 1 : 0;
  });
  EXPECT_EQ(open, 1);
  EXPECT_EQ(spec_ids, 1);
  EXPECT_TRUE(has_value);
  EXPECT_EQ(freeze(words->front(), {}), words->front());
}

nlohmann::json cost_of(const std::string& body) {
  ComposedProgram program;
  program.key = "cost";
  program.parameter_block_size = 16;
  program.parameters.push_back({"mine.steps", true, BindingTime::uniform, 9, -1, 0, 9, true});
  program.shaders.push_back(
      {ShaderStage::fragment,
       "#version 450\nlayout(set = 0, binding = 0) uniform Parameters { int steps; };\n"
       "layout(set = 1, binding = 0) uniform sampler2D map;\nlayout(location = 0) out vec4 color;\n" +
           body,
       {}});
  Crew crew(1);
  const auto words = run_front_end(program, crew);
  EXPECT_TRUE(words) << (words ? "" : format(words.error()));
  return nlohmann::json::parse(describe_cost(program, *words)).at("shaders").at(0);
}

TEST(Cost, BoundsFetchesByLoopsThatCount) {
  const auto constant = cost_of(
      "void main() {\n  color = texelFetch(map, ivec2(0), 0);\n  for (int i = 0; i < 10; ++i)\n    for (int k = 2; k "
      "<= 8; k "
      "+= 2) color += textureLod(map, vec2(i, k), 0.0);\n}\n");
  EXPECT_EQ(constant.at("fetches"), 2);
  EXPECT_EQ(constant.at("fetch_bound"), 1 + 10 * 4);
  const auto uniform = cost_of(
      "float march(int n) {\n  float sum = 0.0;\n  for (int i = 0; i < n; ++i) {\n    sum += texelFetch(map, ivec2(i), "
      "0).r;\n"
      "    if (sum > 3.0) break;\n  }\n  return sum;\n}\nvoid main() { color = vec4(march(steps) + march(2)); }\n");
  EXPECT_EQ(uniform.at("fetch_bound"), 9 + 2);
}

TEST(Cost, HasNoBoundForALoopThatDoesNotCount) {
  const auto cost = cost_of(
      "void main() {\n  color = vec4(0.0);\n  while (color.r < 1.0) color += texelFetch(map, ivec2(color.g), 0);\n}\n");
  EXPECT_TRUE(cost.at("fetch_bound").is_null());
  // A counter that the loop itself sets back counts nothing.
  const auto reset = cost_of(
      "void main() {\n  color = vec4(0.0);\n  for (int i = 0; i < 10; ++i) {\n    color += texelFetch(map, ivec2(i), "
      "0);\n"
      "    if (color.r > 1.0) i = 0;\n  }\n}\n");
  EXPECT_TRUE(reset.at("fetch_bound").is_null());
}

TEST(Shards, AreBalancedByCost) {
  const std::vector<double> seconds = {5, 1, 1, 1, 4, 3, 3, 2};
  const std::vector<unsigned> shards = assign_shards(seconds, 3);
  std::vector<double> load(3);
  for (std::size_t i = 0; i < seconds.size(); ++i) load[shards[i]] += seconds[i];
  EXPECT_LE(*std::max_element(load.begin(), load.end()), 8);
  EXPECT_EQ(shards, assign_shards(seconds, 3));
}

}  // namespace
}  // namespace relievo::test
