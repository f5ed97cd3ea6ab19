/// relievo permute: every permutation that a manifest asks for, into one archive.
#include <fmt/format.h>
#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include "common.hpp"
#include "depfile.hpp"
#include "describe/origins.hpp"
#include "permute_emit.hpp"
#include "permute_merge.hpp"
#include "permute_sources.hpp"
#include "permute_stamp.hpp"
#include "relievo/permute.hpp"

namespace relievo::cli {

namespace {

struct PermuteArguments {
  std::string manifest, output = ".", shard, cache, depfile, depfile_target, costs, sources, emit;
  std::size_t sample = 0;
  std::vector<std::string> explain, merge;
  std::uint64_t cache_megabytes = 2048;
  unsigned jobs = 0, shards = 0;
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

std::string read_all(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Costs are lines of "closure seconds"; what is no such line does not matter: they only balance.
ClosureCosts read_costs(const std::string& text) {
  ClosureCosts costs;
  std::istringstream file(text);
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
  std::string costs;  ///< the text of --costs
  Fingerprint fingerprint;
};

/// The text of --costs. Shards that see different costs are no parts of one whole, so a missing file is an error.
Result<std::string> load_costs(const std::string& path) {
  std::error_code ignored;
  const bool is_file = !std::filesystem::is_directory(path, ignored) && std::ifstream(path).good();
  if (path.empty() || is_file) return read_all(path);
  return fail(ErrorCode::io, "permute.costs",
              fmt::format("the costs '{}' cannot be read; the .costs file of an earlier run is expected", path), path);
}

Result<Project> load_project(const Context& context, const PermuteArguments& arguments) {
  const std::string text = read_all(arguments.manifest);
  Result<Manifest> manifest = load_manifest(arguments.manifest);
  if (!manifest) return tl::unexpected(manifest.error());
  std::vector<std::filesystem::path> folders = manifest->folders;
  folders.insert(folders.end(), context.folders.begin(), context.folders.end());
  Result<Registry> registry = load_registry(folders);
  if (!registry) return tl::unexpected(registry.error());
  Result<std::string> costs = load_costs(arguments.costs);
  if (!costs) return tl::unexpected(costs.error());
  Fingerprint hashes = fingerprint(text, *registry, arguments.shard, *costs);
  return Project{*std::move(manifest), *std::move(registry), *std::move(costs), std::move(hashes)};
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
  if (context.json) print_json(list);
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
    print_json(json);
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
    print_json(json);
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

std::string depfile_text(const Project& project, const std::string& target, const std::vector<std::string>& sources) {
  std::set<std::string> files = files_on_disk(project.registry, sources);
  files.insert(project.manifest.file);
  // Techniques may come or go.
  for (const std::filesystem::path& folder : project.manifest.folders) files.insert(folder.generic_string());
  return depfile_rule(target, files);
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
  const std::string base =
      fmt::format("{}/{}", arguments.output,
                  arguments.shard.empty() ? manifest.name : shard_base(manifest.name, shard.index, shard.count));
  return {base + ".rla", base + ".costs", base + ".stamp"};
}

Status write_depfile(const PermuteArguments& arguments, const Project& project, const Paths& paths,
                     const std::vector<std::string>& sources) {
  if (arguments.depfile.empty()) return {};
  const std::string& target = arguments.depfile_target.empty() ? paths.archive : arguments.depfile_target;
  return write_text(arguments.depfile, depfile_text(project, target, sources));
}

Status compile_plan(const Context& context, const PermuteArguments& arguments, const Project& project,
                    const PermutationPlan& plan, const Shard& shard, const Paths& paths) {
  Result<std::unique_ptr<Cache>> cache = open_cache_of(arguments);
  if (!cache) return tl::unexpected(cache.error());
  const ClosureCosts costs = read_costs(project.costs);
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
  for (FoldedError& folded : summary->errors)
    folded.error = name_file_on_disk(std::move(folded.error), project.registry);
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
  if (Status status = write_depfile(arguments, project, paths, summary->files); !status) return status;
  return write_stamp(paths.stamp, paths.archive, project.fingerprint, summary->files);
}

/// Also puts together what the parts cost and which files they read.
Status merge_parts(const Context& context, const PermuteArguments& arguments, const Project& project,
                   const PermutationPlan& plan, const Paths& paths) {
  if (Status status = merge_shards(plan, project.fingerprint, arguments.merge, paths.archive); !status) return status;
  ClosureCosts costs;
  std::set<std::string> files;
  for (const std::string& part : arguments.merge) {
    costs.merge(read_costs(read_all(std::filesystem::path(part).replace_extension(".costs"))));
    if (const std::optional<Stamp> stamp = read_stamp(stamp_path(part)))
      files.insert(stamp->files.begin(), stamp->files.end());
  }
  if (!costs.empty()) {
    if (Status status = write_text(paths.costs, write_costs(costs)); !status) return status;
  }
  const Result<Archive> archive = Archive::open(paths.archive);
  if (!archive) return tl::unexpected(archive.error());
  if (context.json) {
    print_json({{"archive", paths.archive}, {"permutations", archive->size()}});
  } else {
    fmt::print("{} permutations in {}\n", archive->size(), paths.archive);
  }
  return write_stamp(paths.stamp, paths.archive, project.fingerprint, {files.begin(), files.end()});
}

std::string absolute_path(const std::string& path) {
  std::string text = std::filesystem::absolute(path).lexically_normal().string();
  if (text.size() > 1 && text.ends_with('/')) text.pop_back();
  return text;
}

/// The options of this run as its tasks get them.
Result<ShardedRun> sharded_run(const Context& context, const PermuteArguments& arguments, const Project& project) {
  ShardedRun run;
  run.program = program_path();
  run.manifest = absolute_path(arguments.manifest);
  run.name = project.manifest.name;
  run.folder = absolute_path(arguments.output);
  run.shards = arguments.shards;
  run.threads = std::max(1u, arguments.jobs);
  run.inputs = {run.program, run.manifest};
  for (const std::filesystem::path& folder : project.manifest.folders) run.inputs.push_back(absolute_path(folder));
  for (const std::string& folder : context.folders) {
    run.options.insert(run.options.end(), {"-I", absolute_path(folder)});
    run.inputs.push_back(absolute_path(folder));
  }
  if (!arguments.costs.empty()) {  // a copy: all tasks must see the same
    const std::string copy = fmt::format("{}/{}.shard-costs", run.folder, run.name);
    if (Status status = write_text(copy, project.costs); !status) return tl::unexpected(status.error());
    run.shard_options.insert(run.shard_options.end(), {"--costs", copy});
    run.inputs.push_back(copy);
  }
  if (arguments.no_cache) run.shard_options.push_back("--no-cache");
  if (!arguments.cache.empty()) {
    const bool is_remote = arguments.cache.find("://") != std::string::npos;
    run.shard_options.insert(run.shard_options.end(),
                             {"--cache", is_remote ? arguments.cache : absolute_path(arguments.cache)});
  }
  if (arguments.cache_megabytes != PermuteArguments().cache_megabytes)
    run.shard_options.insert(run.shard_options.end(), {"--cache-size", std::to_string(arguments.cache_megabytes)});
  return run;
}

Status emit(const Context& context, const PermuteArguments& arguments, const Project& project) {
  const Result<ShardedRun> run = sharded_run(context, arguments, project);
  if (!run) return tl::unexpected(run.error());
  return arguments.emit == "ninja" ? emit_ninja(*run) : emit_slurm(*run);
}

Status run_permute(const Context& context, const PermuteArguments& arguments) {
  const Result<Shard> shard = parse_shard(arguments.shard);
  if (!shard) return tl::unexpected(shard.error());
  const Result<Project> project = load_project(context, arguments);
  if (!project) return tl::unexpected(project.error());
  const Paths paths = paths_of(arguments, project->manifest, *shard);
  const bool compiles = !arguments.list && !arguments.dry_run && arguments.explain.empty() && arguments.merge.empty() &&
                        arguments.sources.empty() && arguments.emit.empty();
  const std::optional<Stamp> stamp = compiles && !arguments.force ? read_stamp(paths.stamp) : std::nullopt;
  if (stamp && is_up_to_date(*stamp, paths.archive, project->fingerprint)) {
    if (context.json) {
      print_json({{"archive", paths.archive}, {"up_to_date", true}});
    } else {
      fmt::print("{} is up to date\n", paths.archive);
    }
    return write_depfile(arguments, *project, paths, stamp->files);
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
    if (context.json) {
      print_json({{"explanation", *text}});
    } else {
      fmt::print("{}\n", *text);
    }
    return {};
  }
  if (!arguments.sources.empty())
    return write_sources(project->registry, project->manifest, *plan, arguments.sources, arguments.sample);
  if (arguments.dry_run) {
    print_plan(context, *plan);
    return {};
  }
  if (Status status = make_folder(arguments.output); !status) return status;
  if (!arguments.emit.empty()) return emit(context, arguments, *project);
  if (!arguments.merge.empty()) return merge_parts(context, arguments, *project, *plan, paths);
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
  command->add_option("--emit", arguments->emit, "Write files that run the shards and merge them: ninja or slurm")
      ->check(CLI::IsMember({"ninja", "slurm"}));
  command->add_option("--shards", arguments->shards, "Of --emit; each has as many threads as -j says, or one")
      ->check(CLI::Range(1, 10000))
      ->default_val(4);
  command->add_option("--merge", arguments->merge, "Archives of all shards, to be one")->expected(1, -1);
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
  command->add_option("--MT", arguments->depfile_target, "What the depfile is of; default: the archive");
}

}  // namespace relievo::cli
