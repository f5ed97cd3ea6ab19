/// Any module of a user, with any files beside it, composed into a stage: shaders, or an error with a place.
/// The input is the module, then files: each begins with a line "%% name".
#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>

#include "fuzz/check.hpp"
#include "relievo/compose.hpp"

namespace {

using namespace relievo;

constexpr std::string_view kFolder = "techniques/fuzzed/";

/// A technique whose module and files are still to come. With `short_files`, our own files around it are replaced by
/// short ones, and the stage `host` is there: most of the time went into texts that no input changes.
Registry registry_with_technique(bool short_files) {
  SourceTree sources = embedded_sources();
  if (short_files) {
    sources["shaders/maps/height/height.glsl"] = "#include \"shaders/lib/address.glsl\"\n";
    sources["shaders/stages/host/stage.toml"] = R"(schema = 1
name = "host"
title = "Calls the technique and no more"
source = "none"
summary = "none"
roles = ["view"]
mesh = "none"

[[shader]]
stage = "compute"
module = "host.glsl"
)";
    sources["shaders/stages/host/host.glsl"] = "Hit traced(Ray ray) { return relievo_view_trace(ray); }\n";
  }
  sources[std::string(kFolder) + "technique.toml"] = R"(schema = 1
name = "fuzzed"
title = "Whatever the fuzzer writes"
source = "none"
summary = "none"
class = "unsafe"
first_hit = "never"
module = "fuzzed.glsl"
maps = ["height"]

[loops.steps]
title = "Steps"
bounds = "steps"
min = 1
max = 64
default = 8
binding = "macro"
)";
  sources[std::string(kFolder) + "fuzzed.glsl"] = "";
  Result<Registry> registry = load_registry(std::move(sources));
  if (!registry) fuzz::expect_none(format(registry.error()));
  return std::move(*registry);
}

/// The part up to the next line that begins a file; `rest` keeps what follows.
std::string_view take_part(std::string_view& rest) {
  const std::size_t end = rest.find("\n%% ");
  const std::string_view part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 4);
  return part;
}

/// Puts the input's files into the tree while it lives.
class FuzzedFiles {
 public:
  FuzzedFiles(SourceTree& tree, std::string_view input) : tree_(tree) {
    add("fuzzed.glsl", take_part(input));
    while (!input.empty()) {
      const std::string_view part = take_part(input);
      const std::size_t line = part.find('\n');
      add(part.substr(0, line), line == std::string_view::npos ? std::string_view() : part.substr(line + 1));
    }
  }
  ~FuzzedFiles() {
    for (const std::string& path : added_) tree_.erase(path);
  }
  FuzzedFiles(const FuzzedFiles&) = delete;
  FuzzedFiles& operator=(const FuzzedFiles&) = delete;

 private:
  void add(std::string_view name, std::string_view text) {
    const std::string path = std::string(kFolder).append(name);
    tree_[path] = text;
    added_.insert(path);
  }

  SourceTree& tree_;
  std::set<std::string> added_;
};

std::string fault_of(const ComposedShader& shader, const SourceTree& tree) {
  if (!shader.text.starts_with("#version 450\n")) return "a shader does not begin with its version";
  std::set<std::string> files;
  for (const std::string& file : shader.files) {
    if (!tree.contains(file)) return "a shader names a file that is not there";
    if (!files.insert(file).second) return "a file is in a shader twice";
  }
  return {};
}

std::string fault_of(const Result<ComposedProgram>& program, const SourceTree& tree) {
  if (!program) {
    const Error& error = program.error();
    if (!error.id.starts_with("compose.") || error.message.empty()) return "the error says nothing";
    if (!tree.contains(error.file) || error.line < 1) return "the error has no place";
    return {};
  }
  if (program->shaders.empty()) return "there are no shaders";
  for (const ComposedShader& shader : program->shaders) {
    if (std::string fault = fault_of(shader, tree); !fault.empty()) return fault;
  }
  return {};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Registry whole = registry_with_technique(false), shortened = registry_with_technique(true);
  // Our own stages take ten times as long to compose and differ little: two inputs in 32.
  const bool is_whole = size % 16 == 0;
  Registry& registry = is_whole ? whole : shortened;
  const FuzzedFiles files(registry.sources, {reinterpret_cast<const char*>(data), size});
  Permutation permutation;
  permutation.stage = !is_whole ? "host" : size % 32 == 0 ? "surface" : "ray";
  permutation.roles["view"] = "fuzzed";
  fuzz::expect_none(fault_of(compose(registry, permutation), registry.sources));
  return 0;
}
