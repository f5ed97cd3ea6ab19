/// relievo report: everything measured, on one page.
#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>

#include "evaluation/evaluation.hpp"
#include "report/heat.hpp"
#include "report/page.hpp"
#include "report/picture_table.hpp"
#include "report/synthetic.hpp"

namespace relievo::cli {

namespace {

struct ReportOptions {
  std::vector<std::string> techniques = {"all"}, scenes, heights, backends = {"vulkan", "opengl"}, set;
  std::string address = "repeat", output;
  int ray_image = 256, sweep_image = 128, repeats = 3;
  bool quick = false;
};

constexpr int synthetic_size = 256;  // texels a side of the height maps made by rule
constexpr int quick_image = 64;      // rays a side
constexpr std::size_t quick_maps = 2;

/// A few counts at the two angles where techniques part: a look rather than a measurement.
SweepPlan plan_of(const ReportOptions& options) {
  SweepPlan plan;
  plan.image = plan.timed_image = options.sweep_image;
  plan.repeats = options.repeats;
  if (!options.quick) return plan;
  plan.angles = {20, 8};
  plan.factors = {0.25, 1, 4};
  plan.budgets = {64};
  plan.image = std::min(plan.image, quick_image);
  plan.times_all = false;
  return plan;
}

/// Takes out height files that are not there, and says so: a report on the others is worth having.
void leave_out_missing(std::vector<std::string>& heights, std::vector<NotRun>& not_run) {
  std::erase_if(heights, [&](const std::string& item) {
    double scale = 0;
    const Result<std::string> path = split_scale(item, scale);
    std::error_code ignored;
    if (!path || std::filesystem::exists(*path, ignored)) return false;  // what is no scale is said later
    not_run.push_back({"height map " + *path, "the file is not there"});
    return true;
  });
}

/// Which plots a map gets: those made by rule tell techniques apart in one.
std::vector<Plot> draw_plots(const Sweep& sweep, std::size_t files) {
  std::vector<Plot> plots;
  if (sweep.rows.empty()) return plots;
  for (std::size_t i = 0; i < sweep.maps.size(); ++i) {
    for (const PlotKind& kind : plot_kinds()) {
      plots.push_back(draw_plot(sweep, sweep.maps[i], kind, sweep.plan.angles));
      if (i >= files) break;
    }
  }
  return plots;
}

/// Found out before the measurements, not after.
Status prepare_folder(const std::filesystem::path& folder) {
  if (Status status = make_folder(folder / "pictures"); !status) return status;
  if (access(folder.c_str(), W_OK | X_OK) == 0 && access((folder / "pictures").c_str(), W_OK | X_OK) == 0) return {};
  return fail(ErrorCode::io, "cli.folder", fmt::format("folder '{}' is not writable", folder.string()),
              folder.string());
}

/// A quick report sweeps the first few height maps.
void leave_out_maps(const ReportOptions& options, std::vector<RayCase>& maps, std::vector<NotRun>& not_run) {
  if (!options.quick || maps.size() <= quick_maps) return;
  for (std::size_t i = quick_maps; i < maps.size(); ++i)
    not_run.push_back({"sweep of height map " + maps[i].name, fmt::format("--quick sweeps the first {}", quick_maps)});
  maps.resize(quick_maps);
}

/// What a quick report leaves out of what it measures at all.
void say_what_is_left_out(const EvaluationInput& input, std::vector<NotRun>& not_run) {
  if (!input.ray_cases.empty()) {
    const char* const less = "--quick compiles and times less";
    if (input.backends.size() > 1)
      not_run.push_back({"sweep on all backends but the first", "--quick sweeps on one: errors hardly differ"});
    if (input.ray_cases.size() > 1) not_run.push_back({"times of maps but the first", less});
    not_run.push_back({"times of loops at other counts than their own", less});
    not_run.push_back({"rays with the hardware filter, but in the sweep, without validation", less});
    not_run.push_back({"times of rays, but in the sweep", less});
  }
  if (input.scenes.empty()) return;
  not_run.push_back({"prisms of techniques that claim no first hits, with their agreement between backends",
                     "--quick draws those whose silhouettes and cracks are judged"});
  not_run.push_back({"pixel offsets of techniques that may miss first hits", "--quick measures those that are judged"});
  not_run.push_back({"prisms under more than one random vertex order", "--quick draws one"});
  for (std::size_t i = 1; i < input.scenes.size(); ++i)
    not_run.push_back({"pictures of scene " + input.scenes[i].first, "--quick draws the first scene only"});
}

/// Compiling is most of what small pictures and few rays take: a quick report compiles less.
EvaluationInput input_to_judge(EvaluationInput input, const ReportOptions& options, std::vector<NotRun>& not_run) {
  if (options.quick) say_what_is_left_out(input, not_run);
  if (input.ray_cases.size() > 1) input.ray_cases.resize(1);
  if (!options.quick) return input;
  for (RayCase& ray_case : input.ray_cases) ray_case.angles = plan_of(options).angles;
  if (input.scenes.size() > 1) input.scenes.resize(1);
  input.ray_image = std::min(input.ray_image, quick_image);
  input.filters = {HeightFilter::exact};
  input.all_pictures = false;
  input.time = false;
  input.repeats = 1;
  input.crack_seeds = 1;
  return input;
}

/// The first height map is judged ray by ray together with the scenes; the sweep covers all of them. The maps that
/// the sweep's first backend bakes, timed, serve all that follows.
Result<Report> measure(EvaluationInput input, const ReportOptions& options, std::vector<NotRun> not_run) {
  Report report;
  report.techniques = input.techniques;
  report.pictures = input.pictures;
  report.values = to_texts(*input.registry, input.values);
  leave_out_maps(options, input.ray_cases, not_run);
  EvaluationInput judged = input_to_judge(input, options, not_run);
  report.ray_image = judged.ray_image;
  report.repeats = judged.time ? judged.repeats : 0;
  std::size_t files = input.ray_cases.size();
  if (!options.quick && files > 0) {
    const auto is_taken = [&](const std::string& name) { return is_name_of(input.ray_cases, name); };
    if (input.backends.size() > 1)
      not_run.push_back({"sweep of the height maps made by rule on all backends but the first",
                         "they are more than half of the time, and errors hardly differ"});
    for (NamedMap& map : make_synthetic_maps(synthetic_size))
      input.ray_cases.push_back({unlike_others(map.name, is_taken), std::move(map.height)});
  }
  SweepPlan plan = plan_of(options);
  if (!options.quick) plan.maps_elsewhere = files;
  Result<Sweep> sweep = run_sweep(input, plan);
  if (!sweep) return tl::unexpected(sweep.error());
  report.sweep = std::move(*sweep);
  Result<Evaluation> evaluation = evaluate(judged);
  if (!evaluation) return tl::unexpected(evaluation.error());
  evaluation->not_run.insert(evaluation->not_run.end(), not_run.begin(), not_run.end());
  report.evaluation = std::move(*evaluation);
  check_finite(report.sweep, report.evaluation.checks);
  report.plots = draw_plots(report.sweep, files);
  input.clock->end("plots");
  report.phases = input.clock->phases();
  return report;
}

nlohmann::json json_of(const Report& report) {
  nlohmann::json json = to_json(report.evaluation);
  json["pictures_folder"] = "pictures";
  json["values"] = report.values;
  json["sweep"] = to_json(report.sweep);
  json["phases"] = nlohmann::json::array();
  for (const Phase& p : report.phases)
    json["phases"].push_back({{"name", p.name}, {"seconds", p.seconds}, {"processor_seconds", p.processor_seconds}});
  return json;
}

Status write_files(const Report& report, const nlohmann::json& json, const std::filesystem::path& folder) {
  if (Status status = write_heat(report.sweep, report.pictures); !status) return status;
  Result<std::string> page = make_page(report);
  if (!page) return tl::unexpected(page.error());
  if (Status status = write_text(folder / "report.json", json_text(json) + "\n"); !status) return status;
  if (Status status = write_text(folder / "report.csv", sweep_csv(report.sweep)); !status) return status;
  if (Status status = write_text(folder / "pictures.csv", pictures_csv(report.evaluation)); !status) return status;
  return write_text(folder / "index.html", *page);
}

/// A line a technique, on the first height map and backend with the exact filter at 20°: errors of the rays that are
/// judged, times of the sweep.
void print_techniques(const Report& report) {
  constexpr double shown_angle = 20;
  const std::vector<RayRow>& rows = report.evaluation.rays;
  if (rows.empty()) return;
  const std::string& map = rows.front().case_name;
  const std::string& backend = report.evaluation.backends.front().info.name;
  auto find = [&](const std::string& technique, double angle) {
    return std::find_if(rows.begin(), rows.end(), [&](const RayRow& r) {
      return r.case_name == map && r.backend == backend && r.filter == "exact" && r.technique == technique &&
             r.angle == angle;
    });
  };
  auto find_timed = [&](const std::string& technique) {
    return std::find_if(report.sweep.rows.begin(), report.sweep.rows.end(), [&](const SweepRow& r) {
      return r.map == map && r.backend == report.sweep.backends.front() && r.setting.filter == HeightFilter::exact &&
             r.setting.technique == technique && r.setting.loop.empty() && r.angle == shown_angle && r.seconds > 0;
    });
  };
  fmt::print("\n{} on {}, filter exact, at {}°; times relative to relief with the hardware filter\n", map, backend,
             shown_angle);
  fmt::print("{:<22} {:>9} {:>9} {:>11} {:>10} {:>8} {:>8} {:>9} {:>8}\n", "technique", "wrong %", "missed %",
             "exhausted %", "p99 texel", "steps", "fetches", "Mrays/s", "x relief");
  for (const std::string& technique : report.techniques) {
    auto row = find(technique, shown_angle);
    if (row == rows.end()) continue;
    const ErrorFigures& e = row->error;
    const auto timed = find_timed(technique);
    const bool has_time = timed != report.sweep.rows.end();
    const double timed_rays = report.sweep.plan.timed_image * report.sweep.plan.timed_image;
    fmt::print("{:<22} {:>9} {:>9} {:>11} {:>10} {:>8.1f} {:>8.1f} {:>9} {:>8}\n", technique,
               percent_text(e.wrong_percent()), percent_text(e.percent(e.missed)), percent_text(e.percent(e.exhausted)),
               error_text(e.uv_texels.p99), e.mean_steps, e.mean_fetches,
               has_time ? fmt::format("{:.2f}", timed_rays / timed->seconds / 1e6) : "–",
               has_time && timed->ratio > 0 ? fmt::format("{:.2f}", timed->ratio) : "–");
  }
}

void print(const Report& report, const std::filesystem::path& folder) {
  for (const NotRun& n : report.evaluation.not_run) fmt::print("not run: {}, because {}\n", n.what, n.reason);
  for (const Check& c : report.evaluation.checks)
    fmt::print("{} {}: {}; expected {}\n", c.passed ? "pass" : "FAIL", c.name, c.found, c.expected);
  print_techniques(report);
  const Rerun& rerun = report.sweep.rerun;
  if (rerun.rows > 0)
    fmt::print(
        "\nsweep: {} rows in {:.0f} s; rerun of {} of them changes the time ratio by {:.1f} % (median), {:.1f} % "
        "(nine of ten stay below), {:.0f} % (worst)\n",
        report.sweep.rows.size(), report.sweep.seconds, rerun.rows, rerun.median * 100, rerun.p90 * 100,
        rerun.worst * 100);
  fmt::print("\n{}\n", (folder / "index.html").string());
}

Status run_report(const Context& context, const ReportOptions& options) {
  Result<Registry> registry = context.registry();
  if (!registry) return tl::unexpected(registry.error());
  if (options.scenes.empty() && options.heights.empty()) {
    return fail(ErrorCode::usage, "report.nothing", "nothing to report on; expected --scene FILE or --height FILE");
  }
  std::vector<NotRun> not_run;
  std::vector<std::string> heights = options.heights;
  leave_out_missing(heights, not_run);
  if (options.scenes.empty() && heights.empty())
    return fail(ErrorCode::io, "report.nothing", fmt::format("{}: {}", not_run.front().what, not_run.front().reason));
  Result<EvaluationInput> input =
      make_input(*registry, options.techniques, options.scenes, heights, options.address, options.set);
  if (!input) return tl::unexpected(input.error());
  std::filesystem::path folder = options.output;
  if (Status status = prepare_folder(folder); !status) return status;
  input->backends = options.backends;
  input->ray_image = options.ray_image;
  input->repeats = options.repeats;
  input->pictures = folder / "pictures";
  input->baked = std::make_shared<BakedMaps>(true);
  Result<Report> report = measure(std::move(*input), options, not_run);
  if (!report) return tl::unexpected(report.error());
  nlohmann::json json = json_of(*report);
  if (Status status = write_files(*report, json, folder); !status) return status;
  if (context.json) {
    print_json(json);
  } else {
    print(*report, folder);
  }
  const std::vector<Check>& checks = report->evaluation.checks;
  auto failed = std::count_if(checks.begin(), checks.end(), [](const Check& c) { return !c.passed; });
  if (failed > 0)
    return fail(ErrorCode::mismatch, "report.failed", fmt::format("{} of {} checks fail", failed, checks.size()));
  return {};
}

}  // namespace

void add_report(CLI::App& app, Context& context) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = add_command(app, context, "report", "Measure everything and show it on one page",
                                  [&context, options] { return run_report(context, *options); });
  // The demo passes what it is given after what it has itself: the last one wins.
  command->add_option("--techniques", options->techniques, "a,b,… or all")->capture_default_str();
  command->add_option("--scene", options->scenes, "Scene files: pictures of every drawing stage");
  command->add_option(
      "--height", options->heights,
      "Height files, each with an optional :scale; the first is judged ray by ray, all are swept. A file that is not "
      "there is left out");
  command->add_option("--address", options->address, "Of the height files")->take_last()->capture_default_str();
  command->add_option("--backends", options->backends, "vulkan, opengl, vulkan_loose: see list backends")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--ray-image", options->ray_image, "Rays a side of the ray image")
      ->check(CLI::Range(1, 8192))
      ->take_last()
      ->capture_default_str();
  command
      ->add_option("--sweep-image", options->sweep_image,
                   "The same in the sweep over techniques, counts, maps, angles, filters and backends")
      ->check(CLI::Range(1, 2048))
      ->take_last()
      ->capture_default_str();
  command
      ->add_option(
          "--repeats", options->repeats,
          "Timed runs of rays; if more than 1, pictures are drawn again so often, and timed each time but the first")
      ->check(CLI::Range(1, 100))
      ->take_last()
      ->capture_default_str();
  command->add_option("--set", options->set, "technique.parameter=value");
  command
      ->add_option("-o,--output", options->output,
                   "Folder for index.html, report.json, report.csv, pictures.csv and pictures/")
      ->required()
      ->take_last();
  command
      ->add_flag("--quick,!--full", options->quick,
                 "Fewer counts, angles, rays and height maps, one backend swept, times of the first map only, one "
                 "scene, drawn once")
      ->take_last();
}

}  // namespace relievo::cli
