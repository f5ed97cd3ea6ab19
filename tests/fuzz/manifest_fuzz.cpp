/// Any bytes as a manifest: refused with a place, or planned, or refused at planning.
#include <algorithm>

#include "fuzz/check.hpp"
#include "relievo/permute.hpp"

namespace {

/// Plans of millions of permutations say nothing new.
bool is_small(const relievo::Manifest& manifest) {
  double combinations = 1;
  for (const relievo::ManifestAxis& axis : manifest.axes) {
    const bool all = std::find(axis.values.begin(), axis.values.end(), "all") != axis.values.end();
    combinations *= all ? 32.0 : static_cast<double>(axis.values.size());
  }
  return combinations <= 2000;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const relievo::Registry registry = *relievo::load_registry();
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto manifest = relievo::parse_manifest(text, "relievo.toml");
  if (!manifest) {
    if (manifest.error().line <= 0 || manifest.error().file != "relievo.toml")
      relievo::fuzz::expect_none("an error has no place");
    return 0;
  }
  if (!is_small(*manifest)) return 0;
  const auto plan = relievo::plan_permutations(registry, *manifest);
  if (!plan) {
    if (plan.error().message.empty() || plan.error().file.empty()) relievo::fuzz::expect_none("an error has no place");
    return 0;
  }
  for (const relievo::PlannedPermutation& planned : plan->permutations) {
    if (planned.values.size() != plan->axes.size() || planned.pruned.size() != plan->targets.size())
      relievo::fuzz::expect_none("a permutation has another number of values or verdicts");
    if (!relievo::to_permutation(registry, *manifest, *plan, planned))
      relievo::fuzz::expect_none("a planned permutation is none");
  }
  return 0;
}
