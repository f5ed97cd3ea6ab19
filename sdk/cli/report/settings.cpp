/// Which settings a sweep tries, from the descriptors alone.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <set>

#include "report/sweep.hpp"

namespace relievo::cli {

namespace {

/// A default beyond this is no search but a bound on one.
constexpr double largest_search = 256;

/// `standard`: the count otherwise used, that of the descriptor or of `--set`.
std::set<int> counts_of(const Parameter& loop, double standard, const SweepPlan& plan) {
  std::set<int> counts;
  if (loop.value > largest_search) {
    counts.insert(plan.budgets.begin(), plan.budgets.end());
  } else {
    for (double factor : plan.factors) counts.insert(static_cast<int>(std::lround(factor * standard)));
  }
  std::set<int> allowed;
  for (int count : counts) {
    allowed.insert(static_cast<int>(std::clamp<double>(count, loop.minimum, loop.maximum)));
  }
  allowed.erase(static_cast<int>(standard));
  return allowed;
}

double standard_value(const EvaluationInput& input, const std::string& technique, const Parameter& loop) {
  auto given = input.values.find(technique + "." + loop.name);
  return given == input.values.end() ? loop.value : given->second;
}

}  // namespace

Result<std::vector<Setting>> make_settings(const EvaluationInput& input, const SweepPlan& plan) {
  std::vector<Setting> settings;
  for (const std::string& name : input.techniques) {
    Result<const TechniqueDescriptor*> technique = input.registry->technique(name);
    if (!technique) return tl::unexpected(technique.error());
    for (HeightFilter filter : {HeightFilter::hardware, HeightFilter::exact}) {
      settings.push_back({name, filter, "", 0});
      for (const Parameter& loop : (*technique)->parameters) {
        if (!loop.is_loop) continue;
        for (int count : counts_of(loop, standard_value(input, name, loop), plan))
          settings.push_back({name, filter, loop.name, count});
      }
    }
  }
  return settings;
}

std::string label(const Setting& setting) {
  if (setting.loop.empty()) return setting.technique;
  return fmt::format("{}, {} = {}", setting.technique, setting.loop, setting.count);
}

}  // namespace relievo::cli
