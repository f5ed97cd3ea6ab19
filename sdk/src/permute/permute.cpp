#include "relievo/permute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <mutex>
#include <numeric>
#include <set>
#include <thread>

#include "compile/parallel.hpp"
#include "permute/builder.hpp"
#include "permute/compile_closures.hpp"
#include "permute/fold_errors.hpp"
#include "permute/shards.hpp"

namespace relievo {

namespace {

/// Closures that are compiled together: enough to keep threads busy, few enough to keep memory small.
constexpr std::size_t batch_size = 256;

/// Permutations with the same closure.
struct Group {
  CacheKey key;
  CacheKey source;        // of its last shader: closures that share it are compiled together
  std::size_t first = 0;  // a planned permutation to compose it from
  std::vector<std::size_t> permutations;
  std::vector<Target> targets;
  double seconds = 0;                    // measured before, or estimated from the length of the text
  std::optional<std::uint32_t> program;  // its number in the archive
};

/// What one permutation is before it is grouped.
struct Keyed {
  CacheKey key, source;
  std::size_t length = 0;
  std::optional<Error> error;
};

/// The program's key, kept under a closure's key.
std::string to_payload(const CacheKey& key) {
  std::string bytes(16, '\0');
  std::memcpy(bytes.data(), &key.high, 8);
  std::memcpy(bytes.data() + 8, &key.low, 8);
  return bytes;
}

std::optional<CacheKey> from_payload(const std::optional<std::string>& bytes) {
  if (!bytes || bytes->size() != 16) return std::nullopt;
  CacheKey key;
  std::memcpy(&key.high, bytes->data(), 8);
  std::memcpy(&key.low, bytes->data() + 8, 8);
  return key;
}

class Run {
 public:
  Run(const Registry& registry, const PermutationPlan& plan, std::vector<ResolvedAxis> axes, bool optimize,
      const PermuteOptions& options)
      : registry_(registry), plan_(plan), axes_(std::move(axes)), optimize_(optimize), options_(options) {
    threads_ = options.threads == 0 ? std::max(1u, std::thread::hardware_concurrency()) : options.threads;
  }

  Result<PermuteSummary> execute(const std::filesystem::path& path) {
    if (Status status = group(); !status) return tl::unexpected(status.error());
    Result<ArchiveWriter> writer = ArchiveWriter::create(path, plan_.axes);
    if (!writer) return tl::unexpected(writer.error());
    writer_ = &*writer;
    if (Status status = load_all(); !status) return tl::unexpected(status.error());
    if (Status status = compile_all(); !status) return tl::unexpected(status.error());
    summary_.errors = folder_.take();
    if (!summary_.errors.empty() && !options_.keep_going) return std::move(summary_);
    if (Status status = add_permutations(); !status) return tl::unexpected(status.error());
    if (Status status = writer_->finish(); !status) return tl::unexpected(status.error());
    return std::move(summary_);
  }

 private:
  std::vector<Target> kept_targets(const PlannedPermutation& planned) const {
    std::vector<Target> targets;
    for (std::size_t i = 0; i < plan_.targets.size(); ++i) {
      if (planned.pruned[i] == 0) targets.push_back(plan_.targets[i]);
    }
    return targets;
  }

  /// Calls work(builder, i) for every i, with one builder a thread.
  template <class Work>
  void with_builders(std::size_t count, const Work& work) {
    constexpr std::size_t chunk = 64;
    std::atomic<std::size_t> next = 0;
    run_parallel(threads_, threads_, [&](std::size_t thread) {
      PermutationBuilder builder(registry_, axes_);
      for (std::size_t start = next.fetch_add(chunk); start < count; start = next.fetch_add(chunk)) {
        for (std::size_t i = start; i < std::min(count, start + chunk); ++i) work(builder, i, thread);
      }
    });
  }

  Result<Closure> compose(PermutationBuilder& builder, std::size_t planned) const {
    std::vector<std::uint16_t> values = plan_.permutations[planned].values;
    const Result<Permutation> permutation = builder.build(values);
    if (!permutation) return tl::unexpected(permutation.error());
    return compose_closure(registry_, *permutation);
  }

  /// Sorts the kept permutations into closures, and keeps those of this shard.
  Status group() {
    const std::size_t count = plan_.permutations.size();
    std::vector<Keyed> keyed(count);
    std::vector<std::set<std::string>> files(threads_);
    with_builders(count, [&](PermutationBuilder& builder, std::size_t i, std::size_t thread) {
      const PlannedPermutation& planned = plan_.permutations[i];
      if (!planned.is_kept()) return;
      const Result<Closure> closure = compose(builder, i);
      if (!closure) {
        keyed[i].error = closure.error();
        return;
      }
      keyed[i].key = closure_key(*closure, kept_targets(planned), optimize_);
      const ComposedShader& last = closure->program.shaders.back();
      keyed[i].source = cache_key({last.text});
      for (const ComposedShader& shader : closure->program.shaders) {
        keyed[i].length += shader.text.size();
        files[thread].insert(shader.files.begin(), shader.files.end());
      }
    });
    collect_files(files);
    make_groups(keyed);
    keep_shard();
    return {};
  }

  void collect_files(std::vector<std::set<std::string>>& files) {
    std::set<std::string> all;
    for (std::set<std::string>& some : files) all.merge(some);
    summary_.files.assign(all.begin(), all.end());
  }

  void make_groups(const std::vector<Keyed>& keyed) {
    std::map<CacheKey, std::size_t> known;
    for (std::size_t i = 0; i < keyed.size(); ++i) {
      if (!plan_.permutations[i].is_kept()) {
        pruned_.push_back(i);
        continue;
      }
      if (keyed[i].error) {
        add_error(*keyed[i].error, "", i, 1);
        continue;
      }
      const auto [entry, is_new] = known.try_emplace(keyed[i].key, groups_.size());
      if (is_new) {
        Group group{keyed[i].key, keyed[i].source, i, {}, kept_targets(plan_.permutations[i]), 0, {}};
        group.seconds = measured_or_estimated(keyed[i]);
        groups_.push_back(std::move(group));
      }
      groups_[entry->second].permutations.push_back(i);
    }
    std::sort(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) { return a.key < b.key; });
  }

  double measured_or_estimated(const Keyed& keyed) const {
    constexpr double seconds_per_character = 5e-7;
    if (options_.costs) {
      const auto measured = options_.costs->find(to_string(keyed.key));
      if (measured != options_.costs->end()) return measured->second;
    }
    return seconds_per_character * static_cast<double>(keyed.length);
  }

  void keep_shard() {
    const Shard shard = options_.shard;
    if (shard.count > 1) {
      std::vector<double> seconds;
      for (const Group& group : groups_) seconds.push_back(group.seconds);
      const std::vector<unsigned> assigned = assign_shards(seconds, shard.count);
      std::size_t i = 0;
      std::erase_if(groups_, [&](const Group&) { return assigned[i++] != shard.index; });
      i = 0;
      std::erase_if(pruned_, [&](std::size_t) { return i++ % shard.count != shard.index; });
    }
    summary_.closures = groups_.size();
    summary_.pruned = pruned_.size();
    summary_.asked += pruned_.size();
    for (const Group& group : groups_) summary_.asked += group.permutations.size();
    std::sort(groups_.begin(), groups_.end(),
              [](const Group& a, const Group& b) { return std::tie(a.source, a.key) < std::tie(b.source, b.key); });
  }

  /// What the cache gave for a group: its program, and that program's image where nobody had asked for it before.
  struct Loaded {
    std::optional<CacheKey> program;
    std::optional<ProgramImage> image;
  };

  Loaded load(const Group& group) const {
    Loaded loaded;
    const std::optional<CacheKey> program = from_payload(options_.cache->load(group.key));
    if (!program || numbers_.contains(*program)) return {program, {}};
    const std::optional<std::string> bytes = options_.cache->load(*program);
    if (!bytes) return {};
    Result<ProgramImage> image = read_program(*bytes);
    if (!image) return {};
    return {program, *std::move(image)};
  }

  /// What the cache has goes into the archive at once, in the order of the permutations: when it has everything, the
  /// archive need not be put in order in the end.
  Status load_all() {
    if (!options_.cache) return {};
    std::vector<Group*> order;
    for (Group& group : groups_) order.push_back(&group);
    std::sort(order.begin(), order.end(), [](const Group* a, const Group* b) { return a->first < b->first; });
    constexpr std::size_t chunk = 64;
    for (std::size_t start = 0; start < order.size(); start += chunk) {
      const std::size_t count = std::min(chunk, order.size() - start);
      std::vector<Loaded> loaded(count);
      run_parallel(count, threads_, [&](std::size_t i) { loaded[i] = load(*order[start + i]); });
      for (std::size_t i = 0; i < count; ++i) {
        if (Status status = take(loaded[i], *order[start + i]); !status) return status;
      }
    }
    advance(summary_.from_cache);
    return {};
  }

  Status take(const Loaded& loaded, Group& group) {
    if (!loaded.program) return {};
    auto known = numbers_.find(*loaded.program);
    if (known == numbers_.end()) {
      if (!loaded.image) return {};
      const Result<std::uint32_t> number = writer_->add_program(*loaded.image);
      if (!number) return tl::unexpected(number.error());
      known = numbers_.emplace(*loaded.program, *number).first;
    }
    group.program = known->second;
    ++summary_.from_cache;
    return {};
  }

  Status compile_all() {
    std::vector<Group*> missing;
    for (Group& group : groups_) {
      if (!group.program) missing.push_back(&group);
    }
    ClosureCompiler compiler(threads_, optimize_);
    bool check_only = false;
    for (std::size_t start = 0; start < missing.size(); start += batch_size) {
      const std::span<Group*> batch(missing.data() + start, std::min(batch_size, missing.size() - start));
      Result<std::vector<ClosureTask>> tasks = compose_batch(batch);
      if (!tasks) return tl::unexpected(tasks.error());
      std::vector<ClosureOutcome> outcomes = compiler.compile(*tasks, check_only);
      if (Status status = keep(batch, *tasks, outcomes, check_only); !status) return status;
      // After an error the rest is only looked through, so that the error's count is right.
      check_only = check_only || (failed_ && !options_.keep_going);
    }
    summary_.programs = numbers_.size();
    return {};
  }

  Result<std::vector<ClosureTask>> compose_batch(std::span<Group*> batch) {
    std::vector<ClosureTask> tasks(batch.size());
    std::mutex mutex;
    std::optional<Error> error;
    with_builders(batch.size(), [&](PermutationBuilder& builder, std::size_t i, std::size_t) {
      Result<Closure> closure = compose(builder, batch[i]->first);
      if (closure) {
        tasks[i] = {*std::move(closure), batch[i]->targets};
        return;
      }
      std::scoped_lock lock(mutex);
      error = closure.error();
    });
    if (error) return tl::unexpected(*error);
    return tasks;
  }

  /// Stores and archives what was compiled.
  Status keep(std::span<Group*> batch, const std::vector<ClosureTask>& tasks, std::vector<ClosureOutcome>& outcomes,
              bool check_only) {
    std::vector<std::optional<Result<std::uint32_t>>> numbers(batch.size());
    run_parallel(batch.size(), threads_, [&](std::size_t i) {
      const ClosureOutcome& outcome = outcomes[i];
      if (outcome.image) {
        numbers[i] = writer_->add_program(*outcome.image);
        if (options_.cache) options_.cache->store(outcome.program, write_program(*outcome.image));
      }
      if (options_.cache && !outcome.error && !check_only)
        options_.cache->store(batch[i]->key, to_payload(outcome.program));
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (!numbers[i]) continue;
      if (!*numbers[i]) return tl::unexpected(numbers[i]->error());
      numbers_[outcomes[i].program] = **numbers[i];
    }
    for (std::size_t i = 0; i < batch.size(); ++i) {
      Group& group = *batch[i];
      if (outcomes[i].error) {
        add_error(*outcomes[i].error, tasks[i].closure.program.key, group.first, group.permutations.size());
        continue;
      }
      if (check_only) continue;
      group.program = numbers_.at(outcomes[i].program);
      summary_.costs[to_string(group.key)] = outcomes[i].seconds;
      ++summary_.compiled;
    }
    advance(batch.size());
    return {};
  }

  void add_error(const Error& error, const std::string& key, std::size_t planned, std::size_t count) {
    failed_ = true;
    summary_.failed += count;
    folder_.add(error, key, plan_.name(plan_.permutations[planned]), count);
  }

  void advance(std::size_t count) {
    done_ += count;
    if (options_.progress) options_.progress({done_, groups_.size()});
  }

  Status add_permutations() {
    for (const Group& group : groups_) {
      if (!group.program) continue;
      for (const std::size_t i : group.permutations) {
        const PlannedPermutation& planned = plan_.permutations[i];
        std::vector<std::pair<Target, std::string>> absent;
        for (std::size_t t = 0; t < plan_.targets.size(); ++t) {
          if (planned.pruned[t] != 0) absent.emplace_back(plan_.targets[t], plan_.reasons[planned.pruned[t] - 1]);
        }
        if (Status status = writer_->add_permutation(planned.values, *group.program, absent); !status) return status;
      }
    }
    return {};
  }

  const Registry& registry_;
  const PermutationPlan& plan_;
  std::vector<ResolvedAxis> axes_;
  bool optimize_;
  const PermuteOptions& options_;
  unsigned threads_ = 1;
  std::vector<Group> groups_;
  std::vector<std::size_t> pruned_;
  std::map<CacheKey, std::uint32_t> numbers_;  // by program
  ArchiveWriter* writer_ = nullptr;
  ErrorFolder folder_;
  PermuteSummary summary_;
  std::size_t done_ = 0;
  bool failed_ = false;
};

}  // namespace

Result<PermuteSummary> permute(const Registry& registry, const Manifest& manifest, const PermutationPlan& plan,
                               const std::filesystem::path& archive, const PermuteOptions& options) {
  if (options.shard.count == 0 || options.shard.index >= options.shard.count) {
    return fail(ErrorCode::usage, "permute.shard",
                fmt::format("shard {} of {} is none; an index from 0 to below the count is expected",
                            options.shard.index, options.shard.count));
  }
  Result<std::vector<ResolvedAxis>> axes = resolve_axes(registry, manifest);
  if (!axes) return tl::unexpected(axes.error());
  try {
    return Run(registry, plan, *std::move(axes), manifest.optimize, options).execute(archive);
  } catch (const std::exception& error) {  // nothing throws across the API, out of memory included
    return fail(ErrorCode::compile, "permute.internal",
                fmt::format("While permuting {}: {}", manifest.name, error.what()));
  }
}

}  // namespace relievo
