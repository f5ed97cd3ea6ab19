/// An archive of 10 000 permutations: opening is to cost at most 1 ms, a look-up by key at most 100 ns.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <numeric>
#include <random>

#include "support/archives.hpp"

namespace relievo {
namespace {

constexpr std::size_t kShaderSize = 15000;  ///< bytes: about 240 MB in all

std::vector<ArchiveAxis> project_axes() {
  std::vector<ArchiveAxis> axes = {{"technique", {}, 0}, {"stage", {"surface", "prism", "ray"}, 0}};
  for (int i = 0; i < 20; ++i) axes[0].values.push_back("technique_" + std::to_string(i));
  for (const std::string name : {"address", "filter", "height_format", "depth_write", "normals", "shadow", "lod"})
    axes.push_back({name, {"first", "second", "third", "fourth"}, 0});
  return axes;
}

/// 10 000 of the combinations, evenly spread.
std::vector<std::vector<std::uint16_t>> project_values(std::span<const ArchiveAxis> axes) {
  std::vector<std::vector<std::uint16_t>> list;
  const std::size_t all =
      std::accumulate(axes.begin(), axes.end(), std::size_t{1},
                      [](std::size_t n, const ArchiveAxis& axis) { return n * axis.values.size(); });
  for (std::size_t i = 0; i < 10000; ++i) {
    std::size_t rest = i * (all / 10000);
    std::vector<std::uint16_t>& values = list.emplace_back();
    for (const ArchiveAxis& axis : axes) {
      values.push_back(static_cast<std::uint16_t>(rest % axis.values.size()));
      rest /= axis.values.size();
    }
  }
  return list;
}

ProgramImage project_program(std::size_t number) {
  ProgramImage program;
  for (const Target target : {Target{Language::spirv, 10}, Target{Language::glsl, 450}, Target{Language::essl, 300},
                              Target{Language::hlsl, 50}, Target{Language::msl, 22}}) {
    const std::string head = "// " + std::to_string(number) + to_string(target) + "\n";
    program.outputs.push_back({ShaderStage::fragment, target, head + std::string(kShaderSize, ' ')});
  }
  program.reflection = "{\"program\": " + std::to_string(number) + std::string(2000, ' ') + "}";
  program.cost = "{\"instructions\": " + std::to_string(number) + "}";
  return program;
}

/// 10 000 permutations of 3 000 programs, about 230 MB; `seconds` and `finish_seconds` say what writing took.
class ProjectArchive {
 public:
  ProjectArchive() {
    const auto start = std::chrono::steady_clock::now();
    const auto seconds_since = [](auto since) {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
    };
    ArchiveWriter writer = test::expect_value(ArchiveWriter::create(path(), project_axes()));
    const auto values = project_values(project_axes());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t number = i % 3000;
      if (i < 3000) programs_.push_back(test::expect_value(writer.add_program(project_program(number))));
      test::expect_value(writer.add_permutation(values[i], programs_[number]));
    }
    const auto finishing = std::chrono::steady_clock::now();
    test::expect_value(writer.finish());
    finish_seconds = seconds_since(finishing);
    seconds = seconds_since(start);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    peak_mb = static_cast<double>(usage.ru_maxrss) / 1024;
  }
  std::filesystem::path path() const { return folder_ / "project.rva"; }

  double seconds = 0, finish_seconds = 0, peak_mb = 0;

 private:
  test::TemporaryFolder folder_;
  std::vector<std::uint32_t> programs_;
};

const ProjectArchive& project() {
  static const ProjectArchive archive;
  return archive;
}

void ArchiveOpen(benchmark::State& state) {
  for (auto _ : state) {
    const auto archive = Archive::open(project().path());
    if (!archive) return state.SkipWithError(archive.error().message.c_str());
    benchmark::DoNotOptimize(archive->size());
  }
  state.counters["write_s"] = project().seconds;
  state.counters["finish_s"] = project().finish_seconds;
  state.counters["file_MB"] = static_cast<double>(std::filesystem::file_size(project().path())) / 1e6;
  state.counters["peak_MB"] = project().peak_mb;
}

/// Keys in random order, so that the table is not met in the order of the file.
void ArchiveFindKey(benchmark::State& state) {
  const Archive archive = test::expect_value(Archive::open(project().path()));
  std::vector<std::uint64_t> keys;
  for (Archive::Entry entry = 0; entry < archive.size(); ++entry) keys.push_back(archive.key(entry));
  std::shuffle(keys.begin(), keys.end(), std::mt19937(1));
  std::size_t next = 0;
  for (auto _ : state) {
    if (next == keys.size()) next = 0;
    const auto entry = archive.find(keys[next++]);
    if (!entry) return state.SkipWithError("a key is lost");
    benchmark::DoNotOptimize(*entry);
  }
}

void ArchiveFindMissingKey(benchmark::State& state) {
  const Archive archive = test::expect_value(Archive::open(project().path()));
  std::mt19937_64 random(1);
  for (auto _ : state) {
    if (archive.find(random())) return state.SkipWithError("a key is found that is not there");
  }
}

void ArchiveFindNames(benchmark::State& state) {
  const Archive archive = test::expect_value(Archive::open(project().path()));
  const std::pair<std::string_view, std::string_view> assignment[] = {{"technique", "technique_0"},
                                                                      {"stage", "surface"}};
  for (auto _ : state) {
    const auto entry = archive.find(assignment);
    if (!entry) return state.SkipWithError(entry.error().message.c_str());
    benchmark::DoNotOptimize(*entry);
  }
}

/// From key to checked bytes of 15 kB.
void ArchiveOutput(benchmark::State& state) {
  const Archive archive = test::expect_value(Archive::open(project().path()));
  const std::uint64_t key = archive.key(4321);
  for (auto _ : state) {
    const auto bytes = archive.output(*archive.find(key), ShaderStage::fragment, test::kGlsl);
    if (!bytes) return state.SkipWithError(bytes.error().message.c_str());
    benchmark::DoNotOptimize(bytes->data());
  }
}

void ArchiveVerify(benchmark::State& state) {
  const Archive archive = test::expect_value(Archive::open(project().path()));
  for (auto _ : state) {
    if (!archive.verify()) return state.SkipWithError("it is damaged");
  }
}

BENCHMARK(ArchiveOpen)->Unit(benchmark::kMicrosecond);
BENCHMARK(ArchiveFindKey);
BENCHMARK(ArchiveFindMissingKey);
BENCHMARK(ArchiveFindNames);
BENCHMARK(ArchiveOutput);
BENCHMARK(ArchiveVerify)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relievo
