#include "permute_emit.hpp"

#include <fmt/format.h>
#include <filesystem>

#include "common.hpp"

namespace relievo::cli {

namespace {

/// As one word of a POSIX shell.
std::string quoted(const std::string& word) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:=,+@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string quoted(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += " " + quoted(word);
  return text;
}

/// With a `before` in front of every one of `special`.
std::string escaped(const std::string& text, std::string_view special, char before) {
  std::string result;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) result += before;
    result += c;
  }
  return result;
}

/// A path in a build statement of Ninja.
std::string ninja_path(const std::string& path) {
  return escaped(path, "$ :", '$');
}

/// The value of an #SBATCH option: sbatch takes the quotes off.
std::string sbatch_value(const std::string& text) {
  return "\"" + escaped(text, "\"\\", '\\') + "\"";
}

/// `relievo permute MANIFEST` and what every task has.
std::string command(const ShardedRun& run) {
  return fmt::format("{} permute {}{}", quoted(run.program), quoted(run.manifest), quoted(run.options));
}

std::string shard_archive(const ShardedRun& run, unsigned index) {
  return shard_base(run.name, index, run.shards) + ".rla";
}

/// Neither Ninja nor sbatch has a way to write a line's end.
Status check_paths(const ShardedRun& run) {
  std::vector<std::string> all = {run.program, run.manifest, run.folder};
  for (const auto& some : {run.options, run.shard_options, run.inputs}) all.insert(all.end(), some.begin(), some.end());
  for (const std::string& path : all) {
    if (path.find_first_of("\n\r") == std::string::npos) continue;
    return fail(ErrorCode::usage, "permute.emit",
                fmt::format("the path '{}' has a line's end in it; a path without one is expected", path));
  }
  return {};
}

/// How both jobs begin.
std::string sbatch_header(const ShardedRun& run, const std::string& job, const std::string& log) {
  return fmt::format(
      "#!/bin/bash\n# Written by relievo permute --emit slurm.\n"
      "#SBATCH --job-name={}\n#SBATCH --chdir={}\n#SBATCH --output={}\n#SBATCH --ntasks=1\n",
      job, sbatch_value(run.folder), log);
}

Status write_script(const std::string& path, const std::string& text) {
  if (Status status = write_text(path, text); !status) return status;
  using std::filesystem::perms;
  std::error_code ignored;  // `bash FILE` works without
  std::filesystem::permissions(path, perms::owner_exec | perms::group_exec, std::filesystem::perm_options::add,
                               ignored);
  return {};
}

}  // namespace

std::string shard_base(const std::string& name, unsigned index, unsigned count) {
  return fmt::format("{}.{}-of-{}", name, index + 1, count);
}

std::string program_path() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).string();
}

Status emit_ninja(const ShardedRun& run) {
  if (Status status = check_paths(run); !status) return status;
  std::string inputs;
  for (const std::string& input : run.inputs) inputs += " " + ninja_path(input);
  std::string text = fmt::format(
      "# Written by relievo permute --emit ninja.\n"
      "ninja_required_version = 1.5\n\n"
      "rule shard\n"
      "  command = {0}{1} -o . -j {2} --shard $shard --MF $out.d\n"
      "  depfile = $out.d\n"
      "  deps = gcc\n"
      "  restat = 1\n"
      "  description = shard $shard\n\n"
      "rule merge\n"
      "  command = {0} -o . --merge $in\n"
      "  restat = 1\n"
      "  description = merge $out\n\n",
      escaped(command(run), "$", '$'), escaped(quoted(run.shard_options), "$", '$'), run.threads);
  std::string parts;
  for (unsigned i = 0; i < run.shards; ++i) {
    text += fmt::format("build {}: shard |{}\n  shard = {}/{}\n", shard_archive(run, i), inputs, i + 1, run.shards);
    parts += " " + shard_archive(run, i);
  }
  text += fmt::format("build {0}.rla: merge{1} | {2}\ndefault {0}.rla\n", run.name, parts, ninja_path(run.program));
  return write_text(run.folder + "/build.ninja", text);
}

Status emit_slurm(const ShardedRun& run) {
  if (Status status = check_paths(run); !status) return status;
  if (Status status = make_folder(run.folder + "/logs"); !status) return status;
  const std::string shards = fmt::format(
      "{}#SBATCH --array=0-{}\n#SBATCH --cpus-per-task={}\n\n"
      "exec {}{} -o . -j \"${{SLURM_CPUS_PER_TASK:-{}}}\" --shard \"$((SLURM_ARRAY_TASK_ID + 1))/{}\"\n",
      sbatch_header(run, run.name, "logs/shard-%a.log"), run.shards - 1, run.threads, command(run),
      quoted(run.shard_options), run.threads, run.shards);
  std::string parts;
  for (unsigned i = 0; i < run.shards; ++i) parts += " " + shard_archive(run, i);
  const std::string merge = fmt::format("{}\nexec {} -o . --merge{}\n",
                                        sbatch_header(run, run.name + "-merge", "logs/merge.log"), command(run), parts);
  const std::string submit = fmt::format(
      "#!/bin/bash\n"
      "# Written by relievo permute --emit slurm. Submits the shards, and their merge for when all have succeeded;\n"
      "# arguments go to both, such as --partition=build. Prints the number of the merge's job.\n"
      "set -euo pipefail\n"
      "shards=$(sbatch --parsable \"$@\" {0})\n"
      "sbatch --parsable --kill-on-invalid-dep=yes --dependency=\"afterok:${{shards%%;*}}\" \"$@\" {1}\n",
      quoted(run.folder + "/shards.sbatch"), quoted(run.folder + "/merge.sbatch"));
  if (Status status = write_script(run.folder + "/shards.sbatch", shards); !status) return status;
  if (Status status = write_script(run.folder + "/merge.sbatch", merge); !status) return status;
  return write_script(run.folder + "/submit.sh", submit);
}

}  // namespace relievo::cli
