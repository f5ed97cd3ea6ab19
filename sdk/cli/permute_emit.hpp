/// A sharded run, written down for something that runs it on many cores or machines (docs/clusters.md).
#pragma once

#include <string>
#include <vector>

#include "relievo/result.hpp"

namespace relievo::cli {

/// One task a shard, and one that merges. Paths are absolute.
struct ShardedRun {
  std::string program;                     ///< this one
  std::string manifest, name;              ///< `name`: of the archive
  std::string folder;                      ///< where the archive will lie, and where what is emitted goes
  std::vector<std::string> options;        ///< of every task: `-I DIR`, …
  std::vector<std::string> shard_options;  ///< of the shards: `--cache DIR`, …
  std::vector<std::string> inputs;         ///< what else decides the archive, besides the depfiles' files
  unsigned shards = 1;
  unsigned threads = 1;  ///< of each shard
};

/// Writes `folder`/build.ninja. Errors: "permute.emit" for a path that the format cannot have, "cli.write".
Status emit_ninja(const ShardedRun& run);

/// Writes `folder`/shards.sbatch (a job array), `folder`/merge.sbatch, and `folder`/submit.sh, which submits both.
/// Errors: as above.
Status emit_slurm(const ShardedRun& run);

/// The file of a shard, i from 0: "cliffs.1-of-4", without its folder and ending.
std::string shard_base(const std::string& name, unsigned index, unsigned count);

/// The path of the running program, absolute.
std::string program_path();

}  // namespace relievo::cli
