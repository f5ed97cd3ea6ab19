/// Many permutations at once: axes, pruning, compiling each different program once, archives (docs/permutations.md).
/// Every function and const member function here is thread-safe; runs of `permute` may share a cache, and write one
/// archive: it is whole at any time, and in the end the last one's.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "relievo/archive.hpp"
#include "relievo/cache.hpp"
#include "relievo/compile.hpp"

namespace relievo {

/// An axis that a manifest varies: technique, a role's technique ("technique.shadow"), stage, address, filter, aov,
/// count, a parameter or axis of a descriptor ("relief.linear_steps"), or such a name without its owner
/// ("depth_write"), which stands for that of every owner in a permutation.
struct ManifestAxis {
  std::string name;
  std::vector<std::string> values;
  std::string default_value;           ///< empty: the descriptor's, where it is listed, else the first
  std::optional<BindingTime> binding;  ///< in place of the descriptor's
  int line = 0;
};

/// What the scenes that will be drawn have, and what they ask for. Permutations that cannot serve them are pruned.
struct SceneNeeds {
  std::optional<std::vector<std::string>> maps;  ///< the maps that exist; absent: whatever is needed gets baked
  FirstHit first_hit = FirstHit::never;          ///< the weakest guarantee that will do
  std::vector<std::string> without_features;     ///< shader-model features that the users' devices lack
};

/// `relievo.toml` of a user's project; docs/permutations.md has the schema.
struct Manifest {
  std::string name;                            ///< of the archive: [a-z][a-z0-9_]*
  std::vector<std::filesystem::path> folders;  ///< of technique, map and stage folders, besides our own
  std::vector<Target> targets;
  std::vector<ManifestAxis> axes;
  std::vector<Rule> rules;
  SceneNeeds scene;
  bool optimize = true;
  std::string file;
};

/// Errors: "permute.manifest", "permute.folder", "describe.syntax", "describe.unknown-key", …, with file, line and
/// column; paths are relative to the file. `parse_manifest` does not look whether folders exist.
Result<Manifest> load_manifest(const std::filesystem::path& path);
Result<Manifest> parse_manifest(std::string_view text, const std::string& file);

/// One combination of the axes' values.
struct PlannedPermutation {
  std::vector<std::uint16_t> values;  ///< an index an axis of the plan, or kNoValue
  std::uint64_t key = 0;
  std::vector<std::uint32_t> pruned;  ///< one a target of the manifest: 0 = kept, else 1 + the index of the reason
  bool is_kept() const;
};

/// Every permutation that a manifest asks for, in the order of its axes, and why some are left out.
struct PermutationPlan {
  std::vector<ArchiveAxis> axes;
  std::vector<Target> targets;
  std::vector<PlannedPermutation> permutations;
  std::vector<std::string>
      reasons;  ///< "target essl-300 has no geometry shaders …", "surface.… requires … (file:line)"

  std::string name(const PlannedPermutation& permutation) const;  ///< "technique=relief address=clamp"
};

/// Expands and prunes; compiles nothing. Errors: "permute.unknown-axis", "permute.unknown-subject", "permute.value", …
/// at the manifest's line; "permute.too-many" beyond 10 million; "permute.key-collision".
Result<PermutationPlan> plan_permutations(const Registry& registry, const Manifest& manifest);

/// The planned permutation as the composer takes it.
Result<Permutation> to_permutation(const Registry& registry, const Manifest& manifest, const PermutationPlan& plan,
                                   const PlannedPermutation& planned);

/// Changes with every part of the SDK that compiled programs depend on, and with the versions of the libraries in it.
std::string_view compiler_version();

/// The i-th of n parts of a plan, i from 0.
struct Shard {
  unsigned index = 0, count = 1;
};

/// Seconds that closures took to compile, by closure; what shards are balanced by.
using ClosureCosts = std::map<std::string, double, std::less<>>;

struct PermuteProgress {
  std::size_t done = 0, total = 0;  ///< closures: different sources with different frozen constants
};

struct PermuteOptions {
  unsigned threads = 0;  ///< 0 = all; the archive does not depend on it
  Shard shard;
  bool keep_going = false;  ///< compile what can be compiled after an error
  Cache* cache = nullptr;   ///< may be null
  const ClosureCosts* costs = nullptr;
  std::function<void(const PermuteProgress&)> progress;  ///< called from any thread, one at a time
};

/// One error, and how many permutations have it.
struct FoldedError {
  Error error;
  std::size_t count = 0;
  std::vector<std::string> permutations;  ///< the first three
};

struct PermuteSummary {
  std::size_t asked = 0;     ///< permutations in this shard, each × targets
  std::size_t pruned = 0;    ///< for every target
  std::size_t closures = 0;  ///< different composed sources and frozen constants
  std::size_t programs = 0;  ///< different programs among them: identical SPIR-V is compiled once
  std::size_t from_cache = 0, compiled = 0, failed = 0;  ///< closures; failed: permutations
  std::vector<FoldedError> errors;
  std::vector<std::string> files;  ///< every source that was read, sorted: for depfiles
  ClosureCosts costs;              ///< of what was compiled now
};

/// Compiles what the plan keeps and writes the archive. With errors no archive is written, except with `keep_going`,
/// which leaves out the permutations that failed. Errors: those of writing; a shader's are in the summary.
Result<PermuteSummary> permute(const Registry& registry, const Manifest& manifest, const PermutationPlan& plan,
                               const std::filesystem::path& archive, const PermuteOptions& options = {});

/// Why the permutation with these values is kept, pruned (for which targets, by which rule), or the same program as
/// another. Values that are left out are at their default. Errors: "permute.unknown-axis", "permute.value".
Result<std::string> explain(const Registry& registry, const Manifest& manifest, const PermutationPlan& plan,
                            std::span<const std::pair<std::string, std::string>> assignment);

}  // namespace relievo
