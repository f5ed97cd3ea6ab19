#include "permute_sources.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "common.hpp"

namespace relievo::cli {

namespace {

std::vector<const PlannedPermutation*> spread(const PermutationPlan& plan, std::size_t sample) {
  std::vector<const PlannedPermutation*> kept;
  for (const PlannedPermutation& planned : plan.permutations) {
    if (planned.is_kept()) kept.push_back(&planned);
  }
  if (sample == 0 || sample >= kept.size()) return kept;
  std::vector<const PlannedPermutation*> chosen;
  for (std::size_t i = 0; i < sample; ++i) chosen.push_back(kept[i * kept.size() / sample]);
  return chosen;
}

}  // namespace

Status write_sources(const Registry& registry, const Manifest& manifest, const PermutationPlan& plan,
                     const std::string& folder, std::size_t sample) {
  for (const PlannedPermutation* planned : spread(plan, sample)) {
    const Result<Permutation> permutation = to_permutation(registry, manifest, plan, *planned);
    if (!permutation) return tl::unexpected(permutation.error());
    const Result<ComposedProgram> program = compose(registry, *permutation);
    if (!program) return tl::unexpected(program.error());
    const std::string own = fmt::format("{}/{:016x}", folder, planned->key);
    if (Status status = make_folder(own); !status) return status;
    for (const ComposedShader& shader : program->shaders) {
      const std::string path = fmt::format("{}/{}.{}", own, to_string(shader.stage), stage_suffix(shader.stage));
      if (Status status = write_text(path, shader.text); !status) return status;
    }
  }
  return {};
}

}  // namespace relievo::cli
