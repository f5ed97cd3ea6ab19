/// What the C API does with arguments that are wrong; tests/c_api uses it as it is meant.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "relievo.h"
#include "relievo/describe.hpp"
#include "support/archives.hpp"

namespace relievo {
namespace {

/// Live handles, and an address to write to.
struct Handles {
  Handles() {
    relievo_registry_load(nullptr, 0, &registry, nullptr);
    const relievo_program_desc desc = [] {
      relievo_program_desc d{};
      d.stage = "surface";
      d.technique = "parallax";
      return d;
    }();
    relievo_program_compile(registry, &desc, &program, nullptr);
    relievo_manifest_load(RELIEVO_SOURCE_DIR "/tests/c_api/broken.toml", nullptr, 0, &manifest, nullptr);
    relievo_permute_desc permute{};
    const std::string path = (folder / "none.rla").string();
    permute.archive = path.c_str();
    relievo_manifest_permute(manifest, &permute, &summary, nullptr);
    write_archive(folder / "a.rla", test::sample_archive());
    relievo_archive_open((folder / "a.rla").c_str(), &archive, nullptr);
    const relievo_reload_desc reload{};
    relievo_reloader_create(&reload, &reloader, nullptr);
    const float height = 0.5f;
    relievo_trace_desc rays{};
    rays.backend = "oracle";
    rays.heights = &height;
    rays.width = rays.height = 1;
    relievo_tracer_create(registry, &rays, &tracer, nullptr);
  }
  ~Handles() {
    relievo_registry_free(registry);
    relievo_program_free(program);
    relievo_manifest_free(manifest);
    relievo_summary_free(summary);
    relievo_archive_free(archive);
    relievo_reloader_free(reloader);
    relievo_tracer_free(tracer);
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;

  test::TemporaryFolder folder;
  relievo_registry* registry = nullptr;
  relievo_program* program = nullptr;
  relievo_manifest* manifest = nullptr;
  relievo_summary* summary = nullptr;
  relievo_archive* archive = nullptr;
  relievo_reloader* reloader = nullptr;
  relievo_tracer* tracer = nullptr;
};

/// A call of which the pointers whose bit is set in `nulls` are NULL.
struct Call {
  unsigned pointers = 0;
  std::function<relievo_status(unsigned nulls, relievo_error* error)> run;
};

template <class T>
T* unless(unsigned nulls, unsigned bit, T* pointer) {
  return (nulls >> bit & 1u) != 0 ? nullptr : pointer;
}

/// Where results go that nobody looks at.
struct Results {
  relievo_registry* registry = nullptr;
  relievo_program *program = nullptr, *shared = nullptr;
  relievo_manifest* manifest = nullptr;
  relievo_summary* summary = nullptr;
  relievo_archive* archive = nullptr;
  relievo_map* map = nullptr;
  relievo_reloader* reloader = nullptr;
  relievo_reload_id id = 0;
  relievo_reload_counts reload_counts{};
  relievo_tracer* tracer = nullptr;
  relievo_ray ray{0.25, 0.25, 1, 0, 0, -1, 2};
  relievo_hit hit{};
  relievo_description description{};
  relievo_parameter parameter{};
  relievo_program_parameter slot{};
  relievo_binding binding{};
  relievo_string text{};
  relievo_bytes bytes{};
  relievo_shader_stage stage = 0;
  relievo_counts counts{};
  relievo_error folded{};
  relievo_axis axis{};
  relievo_map_info info{};
  relievo_entry entry = 0;
  std::uint64_t key = 0;
  std::uint32_t number = 0;
  std::size_t count = 0, count2 = 0;
};

#define RELIEVO_CALL(name, pointers, ...)                                                       \
  {                                                                                             \
#name, {                                                                                    \
      pointers, [&h, &r](unsigned n, relievo_error* error) { return name(__VA_ARGS__, error); } \
    }                                                                                           \
  }

/// Every function that takes pointers, with each that must not be NULL.
std::map<std::string, Call> calls(Handles& h, Results& r) {
  static const relievo_program_desc program_desc{};
  static const relievo_permute_desc permute_desc{};
  static const relievo_bake_desc bake_desc{};
  static const relievo_reload_desc reload_desc{};
  static const relievo_trace_desc trace_desc{};
  return {
      RELIEVO_CALL(relievo_registry_load, 1, nullptr, 0, unless(n, 0, &r.registry)),
      RELIEVO_CALL(relievo_registry_count, 2, unless(n, 0, h.registry), RELIEVO_MAP, unless(n, 1, &r.count)),
      RELIEVO_CALL(relievo_registry_at, 2, unless(n, 0, h.registry), RELIEVO_MAP, 0, unless(n, 1, &r.description)),
      RELIEVO_CALL(relievo_registry_find, 3, unless(n, 0, h.registry), RELIEVO_STAGE, unless(n, 1, "surface"),
                   unless(n, 2, &r.description)),
      RELIEVO_CALL(relievo_registry_parameter, 3, unless(n, 0, h.registry), RELIEVO_TECHNIQUE, unless(n, 1, "relief"),
                   0, unless(n, 2, &r.parameter)),
      RELIEVO_CALL(relievo_program_compile, 3, unless(n, 0, h.registry), unless(n, 1, &program_desc),
                   unless(n, 2, &r.program)),
      RELIEVO_CALL(relievo_program_share, 2, unless(n, 0, h.program), unless(n, 1, &r.shared)),
      RELIEVO_CALL(relievo_program_key, 2, unless(n, 0, h.program), unless(n, 1, &r.text)),
      RELIEVO_CALL(relievo_program_shader_count, 2, unless(n, 0, h.program), unless(n, 1, &r.count)),
      RELIEVO_CALL(relievo_program_shader_stage, 2, unless(n, 0, h.program), 0, unless(n, 1, &r.stage)),
      RELIEVO_CALL(relievo_program_output, 3, unless(n, 0, h.program), RELIEVO_VERTEX, unless(n, 1, "spirv-1.0"),
                   unless(n, 2, &r.bytes)),
      RELIEVO_CALL(relievo_program_binding_count, 2, unless(n, 0, h.program), unless(n, 1, &r.count)),
      RELIEVO_CALL(relievo_program_binding, 2, unless(n, 0, h.program), 0, unless(n, 1, &r.binding)),
      RELIEVO_CALL(relievo_program_parameter_count, 2, unless(n, 0, h.program), unless(n, 1, &r.count)),
      RELIEVO_CALL(relievo_program_parameter_at, 2, unless(n, 0, h.program), 0, unless(n, 1, &r.slot)),
      RELIEVO_CALL(relievo_program_parameter_block, 2, unless(n, 0, h.program), unless(n, 1, &r.bytes)),
      RELIEVO_CALL(relievo_program_reflection, 2, unless(n, 0, h.program), unless(n, 1, &r.text)),
      RELIEVO_CALL(relievo_manifest_load, 2, unless(n, 0, "relievo.toml"), nullptr, 0, unless(n, 1, &r.manifest)),
      RELIEVO_CALL(relievo_manifest_counts, 3, unless(n, 0, h.manifest), unless(n, 1, &r.count),
                   unless(n, 2, &r.count2)),
      RELIEVO_CALL(relievo_manifest_name, 2, unless(n, 0, h.manifest), unless(n, 1, &r.text)),
      RELIEVO_CALL(relievo_manifest_permute, 3, unless(n, 0, h.manifest), unless(n, 1, &permute_desc),
                   unless(n, 2, &r.summary)),
      RELIEVO_CALL(relievo_summary_counts, 2, unless(n, 0, h.summary), unless(n, 1, &r.counts)),
      RELIEVO_CALL(relievo_summary_error, 3, unless(n, 0, h.summary), 0, unless(n, 1, &r.folded),
                   unless(n, 2, &r.count)),
      RELIEVO_CALL(relievo_reloader_create, 2, unless(n, 0, &reload_desc), unless(n, 1, &r.reloader)),
      RELIEVO_CALL(relievo_reloader_add, 3, unless(n, 0, h.reloader), unless(n, 1, &program_desc), unless(n, 2, &r.id)),
      RELIEVO_CALL(relievo_reloader_remove, 1, unless(n, 0, h.reloader), 7),
      RELIEVO_CALL(relievo_reloader_current, 2, unless(n, 0, h.reloader), 7, unless(n, 1, &r.program)),
      RELIEVO_CALL(relievo_reloader_poll, 2, unless(n, 0, h.reloader), unless(n, 1, &r.count)),
      RELIEVO_CALL(relievo_reloader_counts, 2, unless(n, 0, h.reloader), unless(n, 1, &r.reload_counts)),
      RELIEVO_CALL(relievo_archive_open, 2, unless(n, 0, "none.rla"), unless(n, 1, &r.archive)),
      RELIEVO_CALL(relievo_archive_counts, 3, unless(n, 0, h.archive), unless(n, 1, &r.count), unless(n, 2, &r.count2)),
      RELIEVO_CALL(relievo_archive_axis_count, 2, unless(n, 0, h.archive), unless(n, 1, &r.count)),
      RELIEVO_CALL(relievo_archive_axis, 2, unless(n, 0, h.archive), 0, unless(n, 1, &r.axis)),
      RELIEVO_CALL(relievo_archive_axis_value, 2, unless(n, 0, h.archive), 0, 0, unless(n, 1, &r.text)),
      RELIEVO_CALL(relievo_archive_target_count, 2, unless(n, 0, h.archive), unless(n, 1, &r.count)),
      RELIEVO_CALL(relievo_archive_target, 2, unless(n, 0, h.archive), 0, unless(n, 1, &r.text)),
      RELIEVO_CALL(relievo_archive_key, 2, unless(n, 0, h.archive), nullptr, 0, unless(n, 1, &r.key)),
      RELIEVO_CALL(relievo_archive_find_key, 2, unless(n, 0, h.archive), 0, unless(n, 1, &r.entry)),
      RELIEVO_CALL(relievo_archive_find, 2, unless(n, 0, h.archive), nullptr, 0, unless(n, 1, &r.entry)),
      RELIEVO_CALL(relievo_archive_entry, 3, unless(n, 0, h.archive), 0, unless(n, 1, &r.key), unless(n, 2, &r.number)),
      RELIEVO_CALL(relievo_archive_entry_name, 2, unless(n, 0, h.archive), 0, nullptr, 0, unless(n, 1, &r.count)),
      RELIEVO_CALL(relievo_archive_outputs, 2, unless(n, 0, h.archive), 0, nullptr, 0, unless(n, 1, &r.count)),
      RELIEVO_CALL(relievo_archive_output, 3, unless(n, 0, h.archive), 0, RELIEVO_VERTEX, unless(n, 1, "glsl-450"),
                   unless(n, 2, &r.bytes)),
      RELIEVO_CALL(relievo_archive_reflection, 2, unless(n, 0, h.archive), 0, unless(n, 1, &r.bytes)),
      RELIEVO_CALL(relievo_archive_cost, 2, unless(n, 0, h.archive), 0, unless(n, 1, &r.bytes)),
      RELIEVO_CALL(relievo_archive_verify, 1, unless(n, 0, h.archive)),
      RELIEVO_CALL(relievo_map_bake, 3, unless(n, 0, h.registry), unless(n, 1, &bake_desc), unless(n, 2, &r.map)),
      RELIEVO_CALL(relievo_map_get, 2, static_cast<const relievo_map*>(nullptr), unless(n, 1, &r.info)),
      RELIEVO_CALL(relievo_tracer_create, 3, unless(n, 0, h.registry), unless(n, 1, &trace_desc),
                   unless(n, 2, &r.tracer)),
      RELIEVO_CALL(relievo_tracer_trace, 3, unless(n, 0, h.tracer), unless(n, 1, &r.ray), 1, unless(n, 2, &r.hit)),
  };
}

/// The functions of the header that return a status.
std::vector<std::string> declared_functions() {
  const std::string header = test::TemporaryFolder::read(RELIEVO_SOURCE_DIR "/sdk/include/relievo.h");
  const std::string returns = "\nrelievo_status ";
  std::vector<std::string> names;
  for (std::size_t at = header.find(returns); at != std::string::npos; at = header.find(returns, at + 1)) {
    const std::size_t begin = at + returns.size();
    names.push_back(header.substr(begin, header.find('(', begin) - begin));
  }
  return names;
}

TEST(CApi, EveryFunctionRefusesEveryNull) {
  Handles handles;
  ASSERT_TRUE(handles.registry && handles.program && handles.manifest && handles.summary && handles.archive &&
              handles.reloader && handles.tracer);
  Results results;
  const std::map<std::string, Call> table = calls(handles, results);
  const std::vector<std::string> names = declared_functions();
  EXPECT_GT(names.size(), 35u);
  for (const std::string& name : names) {
    const auto call = table.find(name);
    ASSERT_NE(call, table.end()) << name << " is not tested";
    for (unsigned nulls = 1; nulls < 1u << call->second.pointers; ++nulls) {
      relievo_error error{};
      EXPECT_EQ(call->second.run(nulls, &error), RELIEVO_ERROR_USAGE) << name << " " << nulls;
      EXPECT_STREQ(error.id, "c.null") << name << " " << nulls;
      EXPECT_NE(std::strstr(error.message, "' is NULL"), nullptr) << name << " " << nulls;
      EXPECT_EQ(call->second.run(nulls, nullptr), RELIEVO_ERROR_USAGE) << name << " " << nulls;
    }
  }
}

/// So that the test above is seen to tell: with nothing NULL, the same calls give another answer.
TEST(CApi, TheSameCallsWithoutNullsAreNotRefused) {
  Handles handles;
  Results results;
  int successes = 0;
  for (const auto& [name, call] : calls(handles, results)) {
    relievo_error error{};
    const relievo_status status = call.run(0, &error);
    successes += status == RELIEVO_OK ? 1 : 0;
    EXPECT_EQ(status, error.code) << name;
    const bool is_in_a_description = std::string(error.message).starts_with("'desc.");
    EXPECT_TRUE(std::strcmp(error.id, "c.null") != 0 || is_in_a_description || name == "relievo_map_get") << name;
  }
  EXPECT_GT(successes, 25);
  relievo_registry_free(results.registry);
  relievo_program_free(results.shared);
  relievo_reloader_free(results.reloader);
}

TEST(CApi, FreeingNullDoesNothing) {
  relievo_registry_free(nullptr);
  relievo_program_free(nullptr);
  relievo_manifest_free(nullptr);
  relievo_summary_free(nullptr);
  relievo_archive_free(nullptr);
  relievo_map_free(nullptr);
  relievo_reloader_free(nullptr);
  relievo_tracer_free(nullptr);
}

class CApiPrograms : public ::testing::Test {
 protected:
  CApiPrograms() {
    desc_.stage = "surface";
    desc_.technique = "parallax";
  }
  /// The error's id; empty when it compiles.
  std::string id_of_compiling() {
    relievo_program* program = nullptr;
    relievo_error error{};
    const relievo_status status = relievo_program_compile(handles_.registry, &desc_, &program, &error);
    EXPECT_EQ(program != nullptr, status == RELIEVO_OK);
    relievo_program_free(program);
    return error.id;
  }
  Handles handles_;
  relievo_program_desc desc_{};
};

TEST_F(CApiPrograms, NullsInsideOfListsAreRefused) {
  EXPECT_EQ(id_of_compiling(), "");
  const relievo_program_desc good = desc_;
  const relievo_role roles[] = {{"view", nullptr}, {nullptr, "parallax"}};
  const relievo_value value{nullptr, 1};
  const relievo_binding_choice binding{nullptr, RELIEVO_MACRO};
  const char* target = nullptr;
  const std::vector<std::function<void(relievo_program_desc&)>> faults = {
      [&](auto& d) { d.roles = roles, d.role_count = 1; },
      [&](auto& d) { d.roles = roles + 1, d.role_count = 1; },
      [&](auto& d) { d.values = &value, d.value_count = 1; },
      [&](auto& d) { d.bindings = &binding, d.binding_count = 1; },
      [&](auto& d) { d.targets = &target, d.target_count = 1; },
      [&](auto& d) { d.role_count = 1; },
      [&](auto& d) { d.value_count = 1; },
      [&](auto& d) { d.binding_count = 1; },
      [&](auto& d) { d.target_count = 1; },
      [&](auto& d) { d.stage = nullptr; },
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    desc_ = good;
    faults[i](desc_);
    EXPECT_EQ(id_of_compiling(), "c.null") << i;
  }
}

TEST_F(CApiPrograms, NumbersOutsideOfEnumerationsAreRefused) {
  const relievo_program_desc good = desc_;
  const relievo_binding_choice binding{"surface.depth_write", 3};
  for (const std::int32_t wrong : {-1, 8, INT32_MAX, INT32_MIN}) {
    desc_ = good, desc_.filter = wrong;
    EXPECT_EQ(id_of_compiling(), "c.enum");
    desc_ = good, desc_.address = wrong;
    EXPECT_EQ(id_of_compiling(), "c.enum");
    desc_ = good, desc_.aov = wrong;
    EXPECT_EQ(id_of_compiling(), "c.enum");
    std::size_t count = 0;
    EXPECT_EQ(relievo_registry_count(handles_.registry, wrong, &count, nullptr), RELIEVO_ERROR_USAGE);
    relievo_bytes bytes{};
    EXPECT_EQ(relievo_program_output(handles_.program, wrong, "spirv-1.0", &bytes, nullptr), RELIEVO_ERROR_USAGE);
    EXPECT_EQ(relievo_archive_output(handles_.archive, 0, wrong, "glsl-450", &bytes, nullptr), RELIEVO_ERROR_USAGE);
  }
  desc_ = good, desc_.bindings = &binding, desc_.binding_count = 1;
  EXPECT_EQ(id_of_compiling(), "c.enum");
}

TEST_F(CApiPrograms, NamesThatNobodyKnowsAreErrorsOfTheirOwn) {
  const relievo_program_desc good = desc_;
  const char* target = "glsl-460";
  const relievo_value value{"parallax.nothing", 1};
  desc_.stage = "nowhere";
  EXPECT_EQ(id_of_compiling(), "describe.unknown-stage");
  desc_ = good, desc_.technique = "nothing";
  EXPECT_EQ(id_of_compiling(), "describe.unknown-technique");
  desc_ = good, desc_.targets = &target, desc_.target_count = 1;
  EXPECT_EQ(id_of_compiling(), "compile.unknown-target");
  desc_ = good, desc_.values = &value, desc_.value_count = 1;
  EXPECT_NE(id_of_compiling(), "");
}

TEST(CApi, ABackendWithoutADriverIsUnsupported) {
  ::setenv("VK_DRIVER_FILES", "/nonexistent", 1);
  ::setenv("VK_ICD_FILENAMES", "/nonexistent", 1);
  relievo_registry* registry = nullptr;
  ASSERT_EQ(relievo_registry_load(nullptr, 0, &registry, nullptr), RELIEVO_OK);
  const float height = 0.5f;
  relievo_bake_desc desc{};
  desc.map = "normal";
  desc.heights = &height;
  desc.width = desc.height = 1;
  desc.backend = "vulkan";
  relievo_map* map = nullptr;
  relievo_error error{};
  EXPECT_EQ(relievo_map_bake(registry, &desc, &map, &error), RELIEVO_ERROR_UNSUPPORTED);
  EXPECT_STREQ(error.id, "backend.unavailable");
  EXPECT_EQ(map, nullptr);
  relievo_registry_free(registry);
  ::unsetenv("VK_DRIVER_FILES");
  ::unsetenv("VK_ICD_FILENAMES");
}

TEST(CApi, LongTextsOfErrorsAreCutAtACharacter) {
  relievo_registry* registry = nullptr;
  relievo_error error{};
  std::string name = "/";
  for (int i = 0; i < 3000; ++i) name += "é";
  const char* folder = name.c_str();
  EXPECT_EQ(relievo_registry_load(&folder, 1, &registry, &error), RELIEVO_ERROR_IO);
  const std::string file = error.file;
  EXPECT_EQ(file, name.substr(0, file.size() - 3) + "...");
  EXPECT_EQ((file.size() - 3) % 2, 1u);  // the slash, then whole characters
  EXPECT_GE(file.size(), sizeof(error.file) - 3);
}

}  // namespace
}  // namespace relievo
