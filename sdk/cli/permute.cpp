/// relievo permute: every permutation that a manifest asks for, into one archive.
#include <fmt/format.h>
#include <algorithm>
#include <fstream>
#include <thread>

#include "common.hpp"
#include "permute_sources.hpp"
#include "permute_stamp.hpp"
#include "relievo/permute.hpp"

namespace relievo::cli {

namespace {

struct PermuteArguments {
  std::string manifest, output = ".", shard, cache, depfile, costs, sources;
  std::size_t sample = 0;
  std::vector<std::string> explain, merge;
  std::uint64_t cache_megabytes = 2048;
  unsigned jobs = 0;
  bool list = false, dry_run = false, keep_going = false, no_cache = false, force = false;
};

Result<Shard> parse_shard(const std::string& text) {
  if (text.empty()) return Shard{};
  unsigned index = 0, count = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%u/%u%c", &index, &count, &rest) == 2 && index >= 1 && index <= count)
    return Shard{index - 1, count};
  return fail(ErrorCode::usage, "permute.shard", fmt::format("--shard {}: expected i/n with i from 1 to n", text));
}

Result<std::vector<std::pair<std::string, std::string>>> parse_assignment(const std::vector<std::string>& given) {
  std::vector<std::pair<std::string, std::string>> assignment;
  for (const std::string& item : given) {
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos || equals == 0)
      return fail(ErrorCode::usage, "permute.explain", fmt::format("--explain {}: expected axis=value", item));
    assignment.emplace_back(item.substr(0, equals), item.substr(equals + 1));
  }
  return assignment;
}

/// Costs are lines of "closure seconds"; what is no such line does not matter: they only balance.
ClosureCosts read_costs(const std::filesystem::path& path) {
  ClosureCosts costs;
  std::ifstream file(path);
  std::string closure;
  for (double seconds = 0; file >> closure >> seconds;) {
    if (seconds >= 0) costs[closure] = seconds;
  }
  return costs;
}

std::string write_costs(const ClosureCosts& costs) {
  std::string text;
  for (const auto& [closure, seconds] : costs) text += fmt::format("{} {:.6f}\n", closure, seconds);
  return text;
}

/// What a command works on.
struct Project {
  Manifest manifest;
  Registry registry;
};

Result<Project> load_project(const Context& context, const std::string& path) {
  Result<Manifest> manifest = load_manifest(path);
  if (!manifest) return tl::unexpected(manifest.error());
  std::vector<std::filesystem::path> folders = manifest->folders;
  folders.insert(folders.end(), context.folders.begin(), context.folders.end());
  Result<Registry> registry = load_registry(folders);
  if (!registry) return tl::unexpected(registry.error());
  return Project{*std::move(manifest), *std::move(registry)};
}

void list_plan(const Context& context, const PermutationPlan& plan) {
  nlohmann::json list = nlohmann::json::array();
  for (const PlannedPermutation& planned : plan.permutations) {
    nlohmann::json pruned = nlohmann::json::object();
    for (std::size_t i = 0; i < plan.targets.size(); ++i) {
      if (planned.pruned[i] != 0) pruned[to_string(plan.targets[i])] = plan.reasons[planned.pruned[i] - 1];
    }
    if (!context.json) {
      fmt::print("{:016x} {} {}\n", planned.key,
                 !planned.is_kept() ? "pruned"
                 : pruned.empty()   ? "kept  "
                                    : "partly",
                 plan.name(planned));
      continue;
    }
    list.push_back({{"key", fmt::format("{:016x}", planned.key)}, {"name", plan.name(planned)}, {"pruned", pruned}});
  }
  if (context.json) fmt::print("{}\n", list.dump(2));
}

void print_plan(const Context& context, const PermutationPlan& plan) {
  std::size_t kept = 0, outputs = 0;
  std::map<std::string, std::size_t> reasons;
  for (const PlannedPermutation& planned : plan.permutations) {
    kept += planned.is_kept() ? 1 : 0;
    for (const std::uint32_t reason : planned.pruned) {
      if (reason == 0) ++outputs;
      if (reason != 0) ++reasons[plan.reasons[reason - 1]];
    }
  }
  if (context.json) {
    const nlohmann::json json = {
        {"asked", plan.permutations.size()}, {"kept", kept}, {"outputs", outputs}, {"pruned_by", reasons}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{} permutations asked for {} targets, {} kept for at least one; {} outputs\n", plan.permutations.size(),
             plan.targets.size(), kept, outputs);
  for (const auto& [reason, count] : reasons) fmt::print("pruned {} times: {}\n", count, reason);
}

void print_errors(const PermuteSummary& summary, std::size_t kept) {
  for (const FoldedError& folded : summary.errors) {
    fmt::print(stderr, "{}\n", format(folded.error));
    fmt::print(stderr, "note: the same error in {} of {} permutations, such as {}\n", folded.count, kept,
               folded.permutations.front());
  }
}

nlohmann::json to_json(const PermuteSummary& summary) {
  nlohmann::json errors = nlohmann::json::array();
  for (const FoldedError& folded : summary.errors) {
    errors.push_back({{"id", folded.error.id},
                      {"message", folded.error.message},
                      {"file", folded.error.file},
                      {"line", folded.error.line},
                      {"column", folded.error.column},
                      {"count", folded.count},
                      {"permutations", folded.permutations}});
  }
  return {{"asked", summary.asked},           {"pruned", summary.pruned},
          {"closures", summary.closures},     {"programs", summary.programs},
          {"from_cache", summary.from_cache}, {"compiled", summary.compiled},
          {"failed", summary.failed},         {"errors", errors}};
}

void print_summary(const Context& context, const PermuteSummary& summary, const std::string& path) {
  if (context.json) {
    nlohmann::json json = to_json(summary);
    json["archive"] = path;
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{} asked, {} pruned, {} different sources, {} programs, {} from cache, {} compiled, {} failed\n",
             summary.asked, summary.pruned, summary.closures, summary.programs, summary.from_cache, summary.compiled,
             summary.failed);
}

Result<std::unique_ptr<Cache>> open_cache_of(const PermuteArguments& arguments) {
  if (arguments.no_cache) return nullptr;
  CacheOptions options;
  options.max_bytes = arguments.cache_megabytes << 20;
  options.log = [](std::string_view text) { fmt::print(stderr, "note: {}\n", text); };
  if (arguments.cache.find("://") == std::string::npos) {
    options.folder = arguments.cache;
  } else {
    options.remote = arguments.cache;
  }
  return open_cache(options);
}

std::string depfile_text(const Project& project, const std::string& archive, const PermuteSummary& summary) {
  std::vector<std::string> files = {project.manifest.file};
  for (const std::string& source : summary.files) {
    const auto origin = project.registry.origins.find(source);
    if (origin != project.registry.origins.end()) files.push_back(origin->second);
  }
  // Descriptors decide as well.
  for (const auto& [source, origin] : project.registry.origins) {
    if (source.ends_with(".toml")) files.push_back(origin);
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  std::string text = archive + ":";
  for (std::string& file : files) {
    for (std::size_t at = 0; (at = file.find_first_of(" #$", at)) != std::string::npos; at += 2)
      file.insert(at, file[at] == '$' ? "$" : "\\");
    text += " \\\n  " + file;
  }
  return text + "\n";
}

std::size_t kept_count(const PermutationPlan& plan) {
  return static_cast<std::size_t>(std::count_if(plan.permutations.begin(), plan.permutations.end(),
                                                [](const PlannedPermutation& planned) { return planned.is_kept(); }));
}

/// What lies in the output folder for one shard, or for all.
struct Paths {
  std::string archive, costs, stamp;
};

Paths paths_of(const PermuteArguments& arguments, const Manifest& manifest, const Shard& shard) {
  std::string base = fmt::format("{}/{}", arguments.output, manifest.name);
  if (shard.count > 1) base += fmt::format(".{}-of-{}", shard.index + 1, shard.count);
  return {base + ".rla", base + ".costs", base + ".stamp"};
}

Status compile_plan(const Context& context, const PermuteArguments& arguments, const Project& project,
                    const PermutationPlan& plan, const Shard& shard, const Paths& paths) {
  Result<std::unique_ptr<Cache>> cache = open_cache_of(arguments);
  if (!cache) return tl::unexpected(cache.error());
  const ClosureCosts costs = read_costs(arguments.costs);
  PermuteOptions options;
  options.threads = arguments.jobs;
  options.shard = shard;
  options.keep_going = arguments.keep_going;
  options.cache = cache->get();
  options.costs = &costs;
  std::unique_ptr<Progress> progress;
  std::size_t shown = 0;
  options.progress = [&](const PermuteProgress& now) {
    if (!progress) progress = std::make_unique<Progress>("permute", now.total);
    for (; shown < now.done; ++shown) progress->advance("");
  };
  Result<PermuteSummary> summary = permute(project.registry, project.manifest, plan, paths.archive, options);
  progress.reset();
  if (!summary) return tl::unexpected(summary.error());
  print_errors(*summary, kept_count(plan));
  print_summary(context, *summary, paths.archive);
  if (!summary->costs.empty()) {
    if (Status status = write_text(paths.costs, write_costs(summary->costs)); !status) return status;
  }
  if (!summary->errors.empty()) {
    return fail(ErrorCode::compile, "permute.failed",
                fmt::format("{} of {} permutations did not compile; {}", summary->failed, kept_count(plan),
                            arguments.keep_going ? "the archive lacks them" : "no archive is written"));
  }
  if (!arguments.depfile.empty()) {
    if (Status status = write_text(arguments.depfile, depfile_text(project, paths.archive, *summary)); !status)
      return status;
  }
  return write_stamp(paths.stamp, paths.archive, project.manifest, project.registry, arguments.shard);
}

Status merge_parts(const PermuteArguments& arguments, const Manifest& manifest, const PermutationPlan& plan) {
  const std::string path = paths_of(arguments, manifest, {}).archive;
  const std::vector<std::filesystem::path> parts(arguments.merge.begin(), arguments.merge.end());
  if (Status status = merge_archives(parts, path); !status) return status;
  const Result<Archive> archive = Archive::open(path);
  if (!archive) return tl::unexpected(archive.error());
  for (const PlannedPermutation& planned : plan.permutations) {
    if (!planned.is_kept() || archive->find(planned.key)) continue;
    std::filesystem::remove(path);
    return fail(
        ErrorCode::usage, "permute.incomplete",
        fmt::format("the parts lack the permutation {}; every shard of one plan is expected", plan.name(planned)));
  }
  fmt::print("{} permutations in {}\n", archive->size(), path);
  return {};
}

Status run_permute(const Context& context, const PermuteArguments& arguments) {
  const Result<Shard> shard = parse_shard(arguments.shard);
  if (!shard) return tl::unexpected(shard.error());
  const Result<Project> project = load_project(context, arguments.manifest);
  if (!project) return tl::unexpected(project.error());
  const Paths paths = paths_of(arguments, project->manifest, *shard);
  const bool compiles = !arguments.list && !arguments.dry_run && arguments.explain.empty() && arguments.merge.empty() &&
                        arguments.sources.empty();
  if (compiles && !arguments.force &&
      is_up_to_date(paths.stamp, paths.archive, project->manifest, project->registry, arguments.shard)) {
    fmt::print("{} is up to date\n", paths.archive);
    return {};
  }
  const Result<PermutationPlan> plan = plan_permutations(project->registry, project->manifest);
  if (!plan) return tl::unexpected(plan.error());
  if (arguments.list) {
    list_plan(context, *plan);
    return {};
  }
  if (!arguments.explain.empty()) {
    const auto assignment = parse_assignment(arguments.explain);
    if (!assignment) return tl::unexpected(assignment.error());
    const Result<std::string> text = explain(project->registry, project->manifest, *plan, *assignment);
    if (!text) return tl::unexpected(text.error());
    fmt::print("{}\n", *text);
    return {};
  }
  if (!arguments.sources.empty())
    return write_sources(project->registry, project->manifest, *plan, arguments.sources, arguments.sample);
  if (arguments.dry_run) {
    print_plan(context, *plan);
    return {};
  }
  if (Status status = make_folder(arguments.output); !status) return status;
  if (!arguments.merge.empty()) return merge_parts(arguments, project->manifest, *plan);
  return compile_plan(context, arguments, *project, *plan, *shard, paths);
}

}  // namespace

void add_permute(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<PermuteArguments>();
  CLI::App* command = add_command(app, context, "permute", "Compile every permutation that a manifest asks for",
                                  [&context, arguments] { return run_permute(context, *arguments); });
  command->add_option("manifest", arguments->manifest, "relievo.toml of a project")->required();
  command->add_option("-o,--output", arguments->output, "Folder for the archive")->capture_default_str();
  command->add_option("-j", arguments->jobs, "Threads; 0 = all. The archive does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("--shard", arguments->shard, "i/n: the i-th of n parts");
  command->add_option("--merge", arguments->merge, "Archives of all shards, to be one");
  command->add_option("--costs", arguments->costs, "A .costs file of an earlier run, to balance shards by");
  command->add_option("--cache", arguments->cache, "Folder, or redis://host[:port][/database]; default: the user's");
  command->add_option("--cache-size", arguments->cache_megabytes, "MiB")->check(CLI::Range(1, 1 << 24));
  command->add_flag("--no-cache", arguments->no_cache, "Neither read nor write a cache");
  command->add_flag("--force", arguments->force, "Run even when nothing has changed");
  command->add_flag("--keep-going", arguments->keep_going, "Compile what compiles after an error");
  command->add_flag("--list", arguments->list, "List the permutations, and which are pruned");
  command->add_flag("--dry-run", arguments->dry_run, "Count the permutations, and what pruned how many");
  command->add_option("--explain", arguments->explain, "axis=value …: why that permutation is kept, pruned or shared");
  command->add_option("--sources", arguments->sources,
                      "Write the composed GLSL below this folder, and compile nothing");
  command->add_option("--sample", arguments->sample, "Of so many permutations, evenly spread; 0 = all");
  command->add_option("--MF", arguments->depfile, "Write a depfile of this name");
}

}  // namespace relievo::cli
