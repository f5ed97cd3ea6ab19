/// relievo archive list | find | verify | merge: what lies in an archive of permutations.
#include "relievo/archive.hpp"

#include <fmt/format.h>

#include "common.hpp"

namespace relievo::cli {

namespace {

struct ListCommand {
  std::string file;
  bool permutations = false;
};

struct FindCommand {
  std::string file, target, stage, output;
  std::vector<std::string> values;
};

struct MergeCommand {
  std::vector<std::string> parts;
  std::string output;
};

struct TargetFigures {
  std::uint64_t shaders = 0, bytes = 0;  ///< of different programs
  std::uint64_t absent = 0;              ///< permutations
};

std::map<std::string, TargetFigures> figures_of(const Archive& archive) {
  std::map<std::string, TargetFigures> figures;
  std::vector<bool> seen(archive.program_count());
  for (Archive::Entry entry = 0; entry < archive.size(); ++entry) {
    for (const auto& [target, reason] : archive.absent(entry)) ++figures[to_string(target)].absent;
    if (seen[archive.program(entry)]) continue;
    seen[archive.program(entry)] = true;
    for (const ArchiveOutput& output : archive.outputs(entry)) {
      TargetFigures& of_target = figures[to_string(output.target)];
      ++of_target.shaders;
      of_target.bytes += output.size;
    }
  }
  return figures;
}

std::string key_text(const Archive& archive, Archive::Entry entry) {
  return fmt::format("{:016x}", archive.key(entry));
}

/// By axis; those that the permutation does not have are left out.
nlohmann::json values_json(const Archive& archive, Archive::Entry entry) {
  nlohmann::json values = nlohmann::json::object();
  for (std::size_t i = 0; i < archive.axes().size(); ++i) {
    const std::uint16_t value = archive.values(entry)[i];
    if (value != kNoValue) values[archive.axes()[i].name] = archive.axes()[i].values[value];
  }
  return values;
}

nlohmann::json list_json(const Archive& archive, const ListCommand& command, std::uintmax_t bytes) {
  nlohmann::json json = {{"permutations", archive.size()},
                         {"programs", archive.program_count()},
                         {"bytes", bytes},
                         {"axes", nlohmann::json::array()},
                         {"targets", nlohmann::json::object()}};
  for (const ArchiveAxis& axis : archive.axes())
    json["axes"].push_back(
        {{"name", axis.name}, {"values", axis.values}, {"default", axis.values[axis.default_value]}});
  for (const auto& [target, figures] : figures_of(archive))
    json["targets"][target] = {{"shaders", figures.shaders}, {"bytes", figures.bytes}, {"absent", figures.absent}};
  if (!command.permutations) return json;
  for (Archive::Entry entry = 0; entry < archive.size(); ++entry)
    json["keys"].push_back({{"key", key_text(archive, entry)},
                            {"values", values_json(archive, entry)},
                            {"program", archive.program(entry)}});
  return json;
}

void print_list(const Archive& archive, const ListCommand& command, std::uintmax_t bytes) {
  fmt::print("{} permutations, {} programs, {} bytes\n", archive.size(), archive.program_count(), bytes);
  for (const ArchiveAxis& axis : archive.axes())
    fmt::print("axis {}: {} (default {})\n", axis.name, fmt::join(axis.values, ", "), axis.values[axis.default_value]);
  for (const auto& [target, figures] : figures_of(archive)) {
    fmt::print("target {}: {} shaders, {} bytes before equal ones are shared", target, figures.shaders, figures.bytes);
    fmt::print("{}\n", figures.absent > 0 ? fmt::format(", absent from {} permutations", figures.absent) : "");
  }
  if (!command.permutations) return;
  for (Archive::Entry entry = 0; entry < archive.size(); ++entry)
    fmt::print("{} {} program {}\n", key_text(archive, entry), archive.name(entry), archive.program(entry));
}

Status run_list(const Context& context, const ListCommand& command) {
  const Result<Archive> archive = Archive::open(command.file);
  if (!archive) return tl::unexpected(archive.error());
  std::error_code ignored;
  const std::uintmax_t bytes = std::filesystem::file_size(command.file, ignored);
  if (context.json) {
    fmt::print("{}\n",
               list_json(*archive, command, bytes).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    print_list(*archive, command, bytes);
  }
  return {};
}

Result<Archive::Entry> find_entry(const Archive& archive, const std::vector<std::string>& values) {
  std::vector<std::pair<std::string_view, std::string_view>> assignment;
  for (const std::string& value : values) {
    const std::size_t equals = value.find('=');
    if (equals == std::string::npos)
      return fail(ErrorCode::usage, "cli.axis", fmt::format("'{}' is no value of an axis; expected axis=value", value));
    assignment.emplace_back(std::string_view(value).substr(0, equals), std::string_view(value).substr(equals + 1));
  }
  return archive.find(assignment);
}

/// Text that is JSON as such, for what is put into a larger one.
nlohmann::json embedded_json(std::string_view text) {
  nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  return json.is_discarded() ? nlohmann::json(text) : json;
}

Status print_entry(const Context& context, const Archive& archive, Archive::Entry entry) {
  const Result<ProgramImage> program = archive.load(entry);
  if (!program) return tl::unexpected(program.error());
  if (!context.json) {
    fmt::print("{} {} program {}\n", key_text(archive, entry), archive.name(entry), archive.program(entry));
    for (const ArchiveOutput& output : archive.outputs(entry))
      fmt::print("{} {}: {} bytes\n", to_string(output.stage), to_string(output.target), output.size);
    for (const auto& [target, reason] : archive.absent(entry)) fmt::print("no {}: {}\n", to_string(target), reason);
    fmt::print("cost: {}\n", program->cost);
    return {};
  }
  nlohmann::json json = {{"key", key_text(archive, entry)},     {"values", values_json(archive, entry)},
                         {"program", archive.program(entry)},   {"outputs", nlohmann::json::array()},
                         {"absent", nlohmann::json::object()},  {"reflection", embedded_json(program->reflection)},
                         {"cost", embedded_json(program->cost)}};
  for (const ArchiveOutput& output : archive.outputs(entry))
    json["outputs"].push_back(
        {{"stage", to_string(output.stage)}, {"target", to_string(output.target)}, {"bytes", output.size}});
  for (const auto& [target, reason] : archive.absent(entry)) json["absent"][to_string(target)] = reason;
  print_json(json);
  return {};
}

/// The named stage, or the only one that the program has.
Result<ShaderStage> chosen_stage(const Archive& archive, Archive::Entry entry, const std::string& name) {
  const std::vector<ShaderStage> stages = archive.stages(entry);
  if (name.empty() && stages.size() == 1) return stages.front();
  std::vector<std::string> names;
  for (int i = 0; i <= static_cast<int>(ShaderStage::compute); ++i) {
    const auto stage = static_cast<ShaderStage>(i);
    if (to_string(stage) == name) return stage;
    if (!name.empty() || std::find(stages.begin(), stages.end(), stage) != stages.end())
      names.emplace_back(to_string(stage));
  }
  return fail(ErrorCode::usage, "cli.stage",
              name.empty() ? fmt::format("--stage is missing; the program has {}", fmt::join(names, ", "))
                           : fmt::format("--stage {} is none; expected one of {}", name, fmt::join(names, ", ")));
}

Status extract(const Archive& archive, Archive::Entry entry, const FindCommand& command) {
  const Result<Target> target = parse_target(command.target);
  if (!target) return tl::unexpected(target.error());
  const Result<ShaderStage> stage = chosen_stage(archive, entry, command.stage);
  if (!stage) return tl::unexpected(stage.error());
  const Result<std::string_view> bytes = archive.output(entry, *stage, *target);
  if (!bytes) return tl::unexpected(bytes.error());
  return write_text(command.output, std::string(*bytes));
}

Status run_find(const Context& context, const FindCommand& command) {
  const Result<Archive> archive = Archive::open(command.file);
  if (!archive) return tl::unexpected(archive.error());
  const Result<Archive::Entry> entry = find_entry(*archive, command.values);
  if (!entry) return tl::unexpected(entry.error());
  return command.target.empty() ? print_entry(context, *archive, *entry) : extract(*archive, *entry, command);
}

Status run_verify(const Context& context, const std::string& file) {
  const Result<Archive> archive = Archive::open(file);
  if (!archive) return tl::unexpected(archive.error());
  if (Status status = archive->verify(); !status) return status;
  if (context.json) {
    print_json({{"permutations", archive->size()}, {"programs", archive->program_count()}});
  } else {
    fmt::print("{} permutations, {} programs: intact\n", archive->size(), archive->program_count());
  }
  return {};
}

Status run_merge(const MergeCommand& command) {
  const std::vector<std::filesystem::path> parts(command.parts.begin(), command.parts.end());
  return merge_archives(parts, command.output);
}

}  // namespace

void add_archive(CLI::App& app, Context& context) {
  CLI::App* archive = app.add_subcommand("archive", "Look into archives of permutations, check and merge them");
  archive->require_subcommand(1);

  auto list = std::make_shared<ListCommand>();
  CLI::App* sub = add_command(*archive, context, "list", "Axes, targets, counts and sizes",
                              [&context, list] { return run_list(context, *list); });
  sub->add_option("file", list->file, "Archive")->required();
  sub->add_flag("--permutations", list->permutations, "Every key as well");

  auto find = std::make_shared<FindCommand>();
  sub = add_command(*archive, context, "find", "One permutation, or the nearest that there are",
                    [&context, find] { return run_find(context, *find); });
  sub->add_option("file", find->file, "Archive")->required();
  sub->add_option("values", find->values, "axis=value; axes that are left out are at their default");
  CLI::Option* target = sub->add_option("--target", find->target, "Writes the shader for this target");
  sub->add_option("--stage", find->stage, "Which shader, where the program has several")->needs(target);
  sub->add_option("-o,--output", find->output, "Where to; - is stdout")->needs(target)->default_str("-");
  find->output = "-";

  auto file = std::make_shared<std::string>();
  sub = add_command(*archive, context, "verify", "Read and check every byte",
                    [&context, file] { return run_verify(context, *file); });
  sub->add_option("file", *file, "Archive")->required();

  auto merge = std::make_shared<MergeCommand>();
  sub = add_command(*archive, context, "merge", "One archive of several, with the bytes of a single run",
                    [merge] { return run_merge(*merge); });
  sub->add_option("parts", merge->parts, "Archives with the same axes")->required();
  sub->add_option("-o,--output", merge->output, "Archive to write")->required();
}

}  // namespace relievo::cli
