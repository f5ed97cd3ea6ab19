/// relievo compile: one technique in one stage, to every target asked for.
#include <fmt/format.h>
#include <algorithm>
#include <cstring>
#include <utility>

#include "common.hpp"
#include "depfile.hpp"
#include "describe/origins.hpp"
#include "job/program.hpp"
#include "relievo/compile.hpp"

namespace relievo::cli {

namespace {

struct CompileOptions {
  std::vector<std::string> techniques, targets, set, defines, bindings;
  std::string stage = "surface", address = "repeat", filter = "exact", aov = "color", output = "-", depfile;
  bool count = false, depend = false, keep_unoptimized = false;
  unsigned jobs = 0;
};

Result<std::map<std::string, BindingTime>> parse_bindings(const Registry& registry, const CompileOptions& options,
                                                          const std::string& only) {
  std::map<std::string, BindingTime> times;
  for (const std::string& item : options.bindings) {
    std::size_t equals = item.find('=');
    std::string name = qualified(item.substr(0, equals), only),
                time = equals == std::string::npos ? "" : item.substr(equals + 1);
    bool found = false;
    for (BindingTime known : {BindingTime::macro, BindingTime::specialization, BindingTime::uniform}) {
      if (time != to_string(known)) continue;
      times[name] = known;
      found = true;
    }
    if (!found)
      return fail(ErrorCode::usage, "compile.bind",
                  fmt::format("--bind {}: expected owner.parameter=macro, =specialization or =uniform", item));
  }
  for (const std::string& item : options.defines) {
    const std::string name = qualified(item.substr(0, item.find('=')), only);
    if (!name.ends_with(".filter")) times[name] = BindingTime::macro;  // a filter is a macro anyway
  }
  const KnownParameters known = known_parameters(registry);
  for (const auto& [name, time] : times) {
    const Result<const Parameter*> parameter =
        find_parameter(known, name, fmt::format("--bind {}={}", name, to_string(time)));
    if (!parameter) return tl::unexpected(parameter.error());
  }
  return times;
}

/// `all` means every target that can do it; what is left out is said.
std::vector<Target> allowed_targets(const ComposedProgram& program, std::string_view fallback) {
  std::vector<Target> allowed;
  for (const Target& target : all_targets()) {
    Status status = check_capabilities(target, program, fallback);
    if (status) {
      allowed.push_back(target);
    } else {
      fmt::print(stderr, "note: {} left out: {} [{}]\n", to_string(target), status.error().message, status.error().id);
    }
  }
  return allowed;
}

Result<std::vector<Target>> parse_targets(const std::vector<std::string>& names) {
  std::vector<Target> targets;
  for (const std::string& name : names) {
    if (name == "all") continue;
    Result<Target> target = parse_target(name);
    if (!target) return tl::unexpected(target.error());
    targets.push_back(*target);
  }
  return targets;
}

/// `only`: the technique, if there is but one.
Result<Permutation> permutation_of(const Registry& registry, const CompileOptions& options,
                                   const std::string& technique, const std::string& only) {
  Result<AddressMode> address = parse_address_mode(options.address);
  if (!address) return tl::unexpected(address.error());
  Result<HeightFilter> filter = parse_height_filter(options.filter);
  if (!filter) return tl::unexpected(filter.error());
  Result<Aov> aov = parse_aov(options.aov);
  if (!aov) return tl::unexpected(aov.error());
  std::vector<std::string> given = options.set;
  given.insert(given.end(), options.defines.begin(), options.defines.end());
  Result<Settings> settings = parse_settings(registry, given, only);
  if (!settings) return tl::unexpected(settings.error());
  Result<std::map<std::string, BindingTime>> times = parse_bindings(registry, options, only);
  if (!times) return tl::unexpected(times.error());
  if (const auto own = settings->filters.find(technique); own != settings->filters.end()) *filter = own->second;
  Permutation permutation{options.stage, {}, *filter, *address, options.count, *aov, settings->values, *times};
  Result<const StageDescriptor*> stage = registry.stage(options.stage);
  if (!stage) return tl::unexpected(stage.error());
  for (const std::string& role : (*stage)->roles) permutation.roles[role] = technique;
  return permutation;
}

/// Of several techniques each takes what it has of the settings; a single one must have them all.
Result<ComposedProgram> compose_with(const Registry& registry, Permutation permutation, bool is_single) {
  if (is_single) return compose(registry, permutation);
  std::map<std::string, BindingTime> times = std::exchange(permutation.binding_times, {});
  const Result<ComposedProgram> composed = compose_known(registry, permutation);
  if (!composed) return composed;
  for (const ParameterSlot& slot : composed->parameters) {
    if (const auto time = times.find(slot.name); time != times.end()) permutation.binding_times.insert(*time);
  }
  return compose_known(registry, std::move(permutation));
}

std::string spirv_bytes(const std::vector<std::uint32_t>& words) {
  std::string bytes(words.size() * 4, '\0');
  std::memcpy(bytes.data(), words.data(), bytes.size());
  return bytes;
}

Status write_outputs(const CompiledProgram& program, const std::vector<Target>& targets, const std::string& base,
                     const std::string& folder) {
  for (const CompiledShader& shader : program.shaders) {
    for (const Target& target : targets) {
      std::string content =
          target.language == Language::spirv ? spirv_bytes(shader.spirv) : shader.text.at(to_string(target));
      std::string path = folder == "-" ? "-"
                                       : fmt::format("{}/{}.{}.{}{}", folder, base, stage_suffix(shader.stage),
                                                     to_string(target), file_extension(target));
      if (Status status = write_text(path, content); !status) return status;
    }
  }
  return folder == "-" ? Status() : write_text(fmt::format("{}/{}.json", folder, base), program.reflection);
}

/// Where depfiles lie, and what they speak of.
std::string depfile_folder(const CompileOptions& options) {
  return options.output == "-" ? "." : options.output;
}

/// The rules of a run go to one depfile where it is named, else each technique has its own.
Status write_depfiles(const CompileOptions& options, const std::map<std::string, std::string>& rules) {
  std::string all;
  for (const auto& [base, rule] : rules) {
    all += rule;
    if (!options.depfile.empty()) continue;
    if (Status status = write_text(fmt::format("{}/{}.d", depfile_folder(options), base), rule); !status) return status;
  }
  return options.depfile.empty() ? Status() : write_text(options.depfile, all);
}

std::string depfile_rule_of(const Registry& registry, const ComposedProgram& program, const std::string& base,
                            const CompileOptions& options) {
  std::vector<std::string> sources;
  for (const ComposedShader& shader : program.shaders)
    sources.insert(sources.end(), shader.files.begin(), shader.files.end());
  return depfile_rule(fmt::format("{}/{}.json", depfile_folder(options), base), files_on_disk(registry, sources));
}

/// Adds the technique's rule to `rules`.
Status compile_one(const Registry& registry, const CompileOptions& options, std::vector<Target> targets,
                   const std::string& technique, bool is_single, std::map<std::string, std::string>& rules) {
  Result<Permutation> permutation = permutation_of(registry, options, technique, is_single ? technique : "");
  if (!permutation) return tl::unexpected(permutation.error());
  Result<ComposedProgram> composed = compose_with(registry, *permutation, is_single);
  if (!composed) return tl::unexpected(composed.error());
  Result<const StageDescriptor*> stage = registry.stage(options.stage);
  if (std::find(options.targets.begin(), options.targets.end(), "all") != options.targets.end())
    targets = allowed_targets(*composed, (*stage)->fallback);
  relievo::CompileOptions compile_options;
  compile_options.optimize = !options.keep_unoptimized;
  compile_options.threads = options.jobs;
  Result<CompiledProgram> compiled = compile(*composed, targets, compile_options, (*stage)->fallback);
  if (!compiled) return tl::unexpected(compiled.error());
  if (options.output != "-") {
    if (Status status = make_folder(options.output); !status) return status;
  }
  std::string base = technique.empty() ? options.stage : technique + "." + options.stage;
  rules[base] = depfile_rule_of(registry, *composed, base, options);
  return write_outputs(*compiled, targets, base, options.output);
}

Status run_compile(const Context& context, const CompileOptions& options) {
  Result<Registry> registry = context.registry();
  if (!registry) return tl::unexpected(registry.error());
  Result<std::vector<Target>> targets = parse_targets(options.targets);
  if (!targets) return tl::unexpected(targets.error());
  Result<const StageDescriptor*> stage = registry->stage(options.stage);
  if (!stage) return tl::unexpected(stage.error());
  std::vector<std::string> techniques;
  if ((*stage)->roles.empty()) {
    techniques = {""};
  } else {
    Result<std::vector<std::string>> names = technique_names(*registry, options.techniques);
    if (!names) return tl::unexpected(names.error());
    techniques = *names;
  }
  std::map<std::string, std::string> rules;
  for (const std::string& technique : techniques) {
    Status status = compile_one(*registry, options, *targets, technique, techniques.size() == 1, rules);
    if (!status) return tl::unexpected(name_file_on_disk(status.error(), *registry));
  }
  return options.depend || !options.depfile.empty() ? write_depfiles(options, rules) : Status();
}

}  // namespace

void add_compile(CLI::App& app, Context& context) {
  auto options = std::make_shared<CompileOptions>();
  CLI::App* command = add_command(app, context, "compile", "Compile a technique in a stage for every target",
                                  [&context, options] { return run_compile(context, *options); });
  command->add_option("techniques", options->techniques, "Techniques, or 'all'; none for a stage that traces nothing");
  command->add_option("--stage", options->stage)->capture_default_str();
  command->add_option("--target", options->targets, "spirv-1.0, glsl-330, …, or all")->required();
  command->add_option("-o,--output", options->output, "Folder for the outputs and the reflection; - for stdout")
      ->capture_default_str();
  command->add_option("--address", options->address)->capture_default_str();
  command->add_option("--filter", options->filter)->capture_default_str();
  command->add_option("--aov", options->aov)->capture_default_str();
  command->add_option("--set", options->set, "parameter=value");
  command->add_option("-D", options->defines, "parameter=value, as a macro");
  command->add_option("--bind", options->bindings, "owner.parameter=macro|specialization|uniform");
  command->add_option("-j", options->jobs, "Threads; 0 = all. The outputs do not depend on it")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_flag("--count", options->count, "Count steps and fetches");
  command->add_flag("--O0", options->keep_unoptimized, "Do not optimise");
  command->add_flag("--MD", options->depend, "Write a depfile");
  command->add_option("--MF", options->depfile, "Name of the depfile");
}

}  // namespace relievo::cli
