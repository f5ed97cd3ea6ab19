/// relievo trace: rays in, hits out.
#include <fmt/format.h>

#include "common.hpp"
#include "rays_csv.hpp"
#include "relievo/trace.hpp"

namespace relievo::cli {

namespace {

struct TraceOptions {
  std::string technique, height, address = "repeat", filter = "exact", rays, backend = "vulkan", output = "-";
  std::vector<std::string> set;
  bool validation = false;
};

std::string summary(const std::vector<Hit>& hits) {
  std::map<std::string, std::size_t> counts;
  for (const Hit& hit : hits) ++counts[std::string(to_string(hit.status))];
  std::string text;
  for (const auto& [status, count] : counts) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, status);
  return text;
}

Result<std::vector<Hit>> trace_on(const Context& context, const TraceOptions& options, const HeightMap& height,
                                  const std::vector<Ray>& rays) {
  if (options.backend == "oracle") return Oracle(height).trace(rays);
  Result<Registry> registry = context.registry();
  if (!registry) return tl::unexpected(registry.error());
  if (options.technique.empty())
    return fail(ErrorCode::usage, "trace.no-technique", "no technique is named; expected --technique NAME");
  if (options.technique == "oracle") {
    return fail(ErrorCode::usage, "trace.oracle",
                "technique 'oracle' replays hits that it is given; for exact hits --backend oracle is expected");
  }
  Result<Settings> settings = parse_settings(*registry, options.set, options.technique);
  if (!settings) return tl::unexpected(settings.error());
  Result<HeightFilter> filter = parse_height_filter(options.filter);
  if (!filter) return tl::unexpected(filter.error());
  TraceRequest request{options.technique, *filter, true, settings->values};
  if (auto own = settings->filters.find(options.technique); own != settings->filters.end())
    request.filter = own->second;
  Result<std::unique_ptr<Backend>> backend = open(options.backend, options.validation);
  if (!backend) return tl::unexpected(backend.error());
  MapSet maps = map_set(height);
  std::vector<std::string> messages;
  Result<std::vector<TraceResult>> traced =
      trace(**backend, *registry, maps, rays, std::span(&request, 1), {}, &messages);
  for (const std::string& message : messages) fmt::print(stderr, "{}\n", message);
  if (!traced) return tl::unexpected(traced.error());
  return std::move(traced->front().hits);
}

Status run_trace(const Context& context, const TraceOptions& options) {
  Result<HeightMap> height = load_height(options.height, options.address);
  if (!height) return tl::unexpected(height.error());
  Result<std::vector<Ray>> rays = read_rays(options.rays);
  if (!rays) return tl::unexpected(rays.error());
  Result<std::vector<Hit>> hits = trace_on(context, options, *height, *rays);
  if (!hits) return tl::unexpected(hits.error());
  const HitDigits digits = options.backend == "oracle" ? oracle_digits : backend_digits;
  if (Status status = write_text(options.output, format_hits(*hits, digits)); !status) return status;
  if (options.output == "-") return {};
  if (context.json) {
    print_json({{"rays", hits->size()}, {"summary", summary(*hits)}, {"output", options.output}});
  } else {
    fmt::print("{} rays: {} -> {}\n", hits->size(), summary(*hits), options.output);
  }
  return {};
}

}  // namespace

void add_trace(CLI::App& app, Context& context) {
  auto options = std::make_shared<TraceOptions>();
  CLI::App* command = add_command(app, context, "trace", "Trace rays against a height map",
                                  [&context, options] { return run_trace(context, *options); });
  command->add_option("--technique", options->technique, "Technique; not needed with --backend oracle");
  command->add_option("--height", options->height, "Height file")->required();
  command->add_option("--rays", options->rays, "rays.csv: u,v,h,du,dv,dh[,t_max]; - for stdin")->required();
  command->add_option("-o,--output", options->output, "hits.csv; - for stdout")->capture_default_str();
  command->add_option("--address", options->address, "repeat, mirror, clamp or clip")->capture_default_str();
  command->add_option("--filter", options->filter, "exact or hardware")->capture_default_str();
  command->add_option("--backend", options->backend, "vulkan, opengl, oracle, …")->capture_default_str();
  command->add_option("--set", options->set, "parameter=value");
  command->add_flag("--validation", options->validation, "Validation layer or debug output on stderr");
}

}  // namespace relievo::cli
