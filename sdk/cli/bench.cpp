/// relievo bench: techniques interleaved in one run, time beside cost and error.
#include <fmt/format.h>
#include <algorithm>
#include <numeric>
#include <optional>

#include "common.hpp"
#include "evaluation/embree_rival.hpp"
#include "rays_csv.hpp"
#include "relievo/trace.hpp"

namespace relievo::cli {

namespace {

struct BenchOptions {
  std::vector<std::string> techniques, set;
  std::string height, address = "repeat", rays, backend = "vulkan", filter = "exact";
  double scale = 0.1, angle = 20;
  int ray_image = 1024, repeat = 5;
  bool embree = false;
  unsigned embree_threads = 2;
};

Result<std::vector<TraceRequest>> requests_of(const Registry& registry, const HeightMap& height,
                                              const BenchOptions& options) {
  Result<std::vector<std::string>> names = technique_names(registry, options.techniques);
  if (!names) return tl::unexpected(names.error());
  Result<Settings> settings = parse_settings(registry, options.set, names->size() == 1 ? names->front() : "");
  if (!settings) return tl::unexpected(settings.error());
  Result<HeightFilter> filter = parse_height_filter(options.filter);
  if (!filter) return tl::unexpected(filter.error());
  set_scale(registry, options.scale, height, settings->values);
  std::vector<TraceRequest> requests;
  for (const std::string& name : *names) {
    auto own = settings->filters.find(name);
    requests.push_back({name, own == settings->filters.end() ? *filter : own->second, false, settings->values});
  }
  return requests;
}

/// What a backend without clocks does not tell is null.
void add_times(nlohmann::json& row, double seconds, std::size_t rays, double reference) {
  row["median_s"] = seconds > 0 ? nlohmann::json(seconds) : nlohmann::json();
  row["rays_per_s"] = seconds > 0 ? nlohmann::json(static_cast<double>(rays) / seconds) : nlohmann::json();
  row["ratio"] = seconds > 0 && reference > 0 ? nlohmann::json(seconds / reference) : nlohmann::json();
}

nlohmann::json row_of(const TraceRequest& request, const TraceResult& timed, const ErrorFigures& figures,
                      double reference) {
  nlohmann::json row = to_json(figures);
  double seconds = median(timed.seconds);
  row["technique"] = request.technique;
  row["filter"] = to_string(request.filter);
  add_times(row, seconds, timed.hits.size(), reference);
  row["steps"] = figures.mean_steps;
  row["fetches"] = figures.mean_fetches;
  return row;
}

/// What the backend runs a request with, of the parameters that it reads and that are not as they are described.
ValueTexts values_of(const Registry& registry, const BackendInfo& backend, const TraceRequest& request) {
  const std::vector<std::string>& maps = registry.techniques.at(request.technique).maps;
  ValueTexts texts = to_texts(registry, values_on(registry, backend, request.values));
  std::erase_if(texts, [&](const auto& entry) {
    const std::string owner = entry.first.substr(0, entry.first.find('.'));
    return owner != "ray" && owner != request.technique && std::find(maps.begin(), maps.end(), owner) == maps.end();
  });
  return texts;
}

/// Bytes of all maps that a technique reads, the height map included, as textures.
std::size_t map_bytes(const Registry& registry, const std::string& technique, const MapSet& maps) {
  std::size_t bytes = 0;
  for (const std::string& map : registry.techniques.at(technique).maps) bytes += texture_bytes(maps.find(map)->second);
  return bytes;
}

/// The row of Embree's fastest method, with the times of the others.
nlohmann::json row_of(const RivalResult& rival, const BenchOptions& options, const ErrorFigures& figures,
                      double reference) {
  const RivalRun& best = rival.runs[rival.fastest];
  nlohmann::json row = to_json(figures);
  row.update({{"technique", "embree"},
              {"filter", "triangles"},
              {"steps", 0.0},
              {"fetches", 0.0},
              {"map_bytes", rival.bytes},
              {"triangle_bytes", rival.triangle_bytes},
              {"peak_bytes", rival.peak_bytes},
              {"build_s", rival.build_seconds},
              {"threads", options.embree_threads},
              {"method", best.method},
              {"values", nlohmann::json::object()}});
  add_times(row, median(best.seconds), best.hits.size(), reference);
  for (const RivalRun& run : rival.runs) row["methods"][run.method] = median(run.seconds);
  return row;
}

/// Techniques on a backend, timed round after round.
class Timing {
 public:
  Timing(Backend& backend, const Registry& registry, MapSet& maps, std::span<const Ray> rays,
         std::span<const TraceRequest> requests)
      : backend_(backend),
        registry_(registry),
        maps_(maps),
        rays_(rays),
        requests_(requests),
        results_(requests.size()) {}

  Status run(int rounds) {
    Result<std::vector<TraceResult>> traced = trace(backend_, registry_, maps_, rays_, requests_, {rounds, true});
    if (!traced) return tl::unexpected(traced.error());
    for (std::size_t k = 0; k < results_.size(); ++k) {
      const std::vector<double>& seconds = (*traced)[k].seconds;
      results_[k].hits = std::move((*traced)[k].hits);
      results_[k].seconds.insert(results_[k].seconds.end(), seconds.begin(), seconds.end());
    }
    return {};
  }

  const std::vector<TraceResult>& results() const { return results_; }

 private:
  Backend& backend_;
  const Registry& registry_;
  MapSet& maps_;
  std::span<const Ray> rays_;
  std::span<const TraceRequest> requests_;
  std::vector<TraceResult> results_;
};

std::string time_text(const nlohmann::json& value, double unit) {
  return value.is_null() ? "–" : fmt::format("{:.2f}", value.get<double>() * unit);
}

void print_table(const nlohmann::json& rows) {
  fmt::print("{:<20} {:<9} {:>9} {:>9} {:>6} {:>8} {:>8} {:>8} {:>11} {:>10} {:>10} {:>8}\n", "technique", "filter",
             "ms", "Mrays/s", "ratio", "steps", "fetches", "wrong %", "exhausted %", "p99 texel", "p99 |dH|", "MB");
  for (const auto& r : rows) {
    fmt::print("{:<20} {:<9} {:>9} {:>9} {:>6} {:>8.1f} {:>8.1f} {:>8} {:>11} {:>10} {:>10} {:>8.1f}\n",
               r["technique"].get<std::string>(), r["filter"].get<std::string>(), time_text(r["median_s"], 1e3),
               time_text(r["rays_per_s"], 1e-6), time_text(r["ratio"], 1), r["steps"].get<double>(),
               r["fetches"].get<double>(), percent_text(r["wrong_percent"].get<double>()),
               percent_text(r["exhausted_percent"].get<double>()), error_text(r["uv_texels"]["p99"].get<double>()),
               error_text(r["height"]["p99"].get<double>()), r["map_bytes"].get<double>() / 1e6);
    if (!r.contains("method")) continue;
    fmt::print("embree: {} on {} threads, built in {:.2f} s, at most {:.1f} MB; every way, in Mrays/s:",
               r["method"].get<std::string>(), r["threads"].get<unsigned>(), r["build_s"].get<double>(),
               r["peak_bytes"].get<double>() / 1e6);
    for (const auto& [method, seconds] : r["methods"].items())
      fmt::print(" {} {:.1f}", method, r["rays"].get<double>() / seconds.get<double>() / 1e6);
    fmt::print("\n");
  }
}

Status run_bench(const Context& context, const BenchOptions& options) {
  Result<Registry> registry = context.registry();
  if (!registry) return tl::unexpected(registry.error());
  Result<HeightMap> height = load_height(options.height, options.address);
  if (!height) return tl::unexpected(height.error());
  Result<std::vector<TraceRequest>> timing = requests_of(*registry, *height, options);
  if (!timing) return tl::unexpected(timing.error());
  std::vector<Ray> rays = make_view_rays(options.angle, options.scale, options.ray_image, options.ray_image);
  if (!options.rays.empty()) {
    Result<std::vector<Ray>> given = read_rays(options.rays);
    if (!given) return tl::unexpected(given.error());
    rays = std::move(*given);
  }
  Result<std::unique_ptr<Backend>> backend = open(options.backend, false);
  if (!backend) return tl::unexpected(backend.error());
  MapSet maps = map_set(*height);
  std::vector<TraceRequest> counting = *timing;
  for (TraceRequest& request : counting) request.count_cost = true;
  Result<std::vector<TraceResult>> counted = trace(**backend, *registry, maps, rays, counting);
  if (!counted) return tl::unexpected(counted.error());
  Timing timed(**backend, *registry, maps, rays, *timing);
  std::optional<RivalResult> rival;
  if (options.embree) {
    Result<RivalResult> raced =
        race_embree(*height, options.scale, rays, options.embree_threads, options.repeat, [&] { return timed.run(1); });
    if (!raced) return tl::unexpected(raced.error());
    rival = std::move(*raced);
  } else if (Status status = timed.run(options.repeat); !status) {
    return status;
  }
  std::vector<Hit> truth = Oracle(*height).trace(rays);
  nlohmann::json rows = nlohmann::json::array();
  double reference = median(timed.results().front().seconds);
  for (std::size_t k = 0; k < timing->size(); ++k) {
    ErrorFigures figures = compare_hits(truth, (*counted)[k].hits, height->width, height->height);
    rows.push_back(row_of((*timing)[k], timed.results()[k], figures, reference));
    rows.back()["values"] = values_of(*registry, (*backend)->info(), (*timing)[k]);
    rows.back()["map_bytes"] = map_bytes(*registry, (*timing)[k].technique, maps);
  }
  if (rival) {
    const ErrorFigures figures = compare_hits(truth, rival->runs[rival->fastest].hits, height->width, height->height);
    rows.push_back(row_of(*rival, options, figures, reference));
  }
  if (context.json) {
    print_json(rows);
  } else {
    print_table(rows);
    const ValueTexts own = own_values(*registry, (*backend)->info());
    if (!own.empty()) fmt::print("{}: {}, unless --set says otherwise\n", (*backend)->info().device, to_text(own));
  }
  return {};
}

}  // namespace

void add_bench(CLI::App& app, Context& context) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = add_command(app, context, "bench", "Time techniques against each other, with their errors",
                                  [&context, options] { return run_bench(context, *options); });
  command->add_option("--techniques", options->techniques, "a,b,… or all; the first is the reference")->required();
  command->add_option("--height", options->height, "Height file")->required();
  command->add_option("--address", options->address)->capture_default_str();
  command->add_option("--scale", options->scale, "Height of the lid in texture widths")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  CLI::Option* rays = command->add_option("--rays", options->rays, "rays.csv");
  command->add_option("--angle", options->angle, "Degrees above the base plane")
      ->check(CLI::Range(0.01, 90.0))
      ->excludes(rays)
      ->capture_default_str();
  command->add_option("--ray-image", options->ray_image, "Rays a side of the ray image")
      ->check(CLI::Range(1, 8192))
      ->excludes(rays)
      ->capture_default_str();
  command->add_option("--backend", options->backend, "vulkan, opengl, vulkan_loose, …")->capture_default_str();
  command->add_option("--filter", options->filter, "exact or hardware; --set technique.filter=… for one")
      ->capture_default_str();
  command->add_option("--repeat", options->repeat, "Timed rounds")->check(CLI::Range(1, 1000))->capture_default_str();
  command->add_option("--set", options->set, "technique.parameter=value");
  CLI::Option* embree =
      command->add_flag("--embree", options->embree, "A row for Embree 3 on the same rays: two triangles a cell");
  command->add_option("--embree-threads", options->embree_threads, "Threads for Embree")
      ->needs(embree)
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
}

}  // namespace relievo::cli
