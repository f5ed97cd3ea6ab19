/// relievo conform: do the backends agree with each other and with what is claimed?
#include <fmt/format.h>
#include <algorithm>

#include "evaluation/fuzz.hpp"
#include "evaluation/hard_run.hpp"

namespace relievo::cli {

namespace {

struct ConformOptions {
  std::vector<std::string> techniques = {"all"}, scenes, heights, backends = {"vulkan", "opengl"}, set;
  std::string address = "repeat", output;
  int ray_image = 1000, repeats = 3;
  CLI::Option* hard_cases = nullptr;
  std::string hard_case_folder;
  int rays = 1000;
  CLI::Option* fuzz = nullptr;
  FuzzInput fuzz_input;
};

/// Backends may filter differently in hardware: that is told, and no claim.
void print_hardware_agreement(const Evaluation& evaluation) {
  const RayAgreement* least = nullptr;
  for (const RayAgreement& r : evaluation.ray_agreements) {
    if (r.filter == "hardware" && (!least || r.equal_percent < least->equal_percent)) least = &r;
  }
  if (!least) return;
  fmt::print("filter hardware: {:.5g} % of the rays are equal between backends at worst ({} on {} at {}°)\n",
             least->equal_percent, least->technique, least->case_name, least->angle);
}

void print(const Evaluation& evaluation) {
  for (const NotRun& n : evaluation.not_run) fmt::print("not run: {}, because {}\n", n.what, n.reason);
  if (!evaluation.rays.empty()) {
    fmt::print("{:<22} {:>5} {:<20} {:<9} {:<8} {:>9} {:>9} {:>11} {:>10} {:>10}\n", "map", "angle", "technique",
               "filter", "backend", "wrong %", "missed %", "exhausted %", "p99 texel", "p99 |dH|");
  }
  for (const RayRow& r : evaluation.rays) {
    const ErrorFigures& e = r.error;
    fmt::print("{:<22} {:>5} {:<20} {:<9} {:<8} {:>9} {:>9} {:>11} {:>10} {:>10}\n", r.case_name, r.angle, r.technique,
               r.filter, r.backend, percent_text(e.wrong_percent()), percent_text(e.percent(e.missed)),
               percent_text(e.percent(e.exhausted)), error_text(e.uv_texels.p99), error_text(e.height.p99));
  }
  print_hardware_agreement(evaluation);
  for (const Check& c : evaluation.checks) {
    fmt::print("{} {}: {}; expected {}\n", c.passed ? "pass" : "FAIL", c.name, c.found, c.expected);
  }
}

Result<HardInput> hard_input(const Registry& registry, const ConformOptions& options) {
  HardInput input;
  Result<EvaluationInput> shared =
      make_input(registry, options.techniques, {}, options.heights, options.address, options.set);
  if (!shared) return tl::unexpected(shared.error());
  Result<std::vector<HardCase>> cases =
      options.hard_case_folder.empty() ? own_hard_cases() : load_hard_cases(options.hard_case_folder);
  if (!cases) return tl::unexpected(cases.error());
  input.registry = &registry;
  input.techniques = std::move(shared->techniques);
  input.backends = options.backends;
  input.cases = std::move(*cases);
  for (RayCase& ray_case : shared->ray_cases)
    input.heights.push_back({ray_case.name, std::move(ray_case.height), ray_case.scale});
  input.rays = options.rays;
  input.values = std::move(shared->values);
  return input;
}

Status conform_to_hard_cases(const Context& context, const Registry& registry, const ConformOptions& options) {
  Result<HardInput> input = hard_input(registry, options);
  if (!input) return tl::unexpected(input.error());
  Result<HardResult> result = run_hard_cases(*input);
  if (!result) return tl::unexpected(result.error());
  if (context.json) {
    print_json(to_json(*result));
  } else {
    print(*result);
  }
  if (result->faults() == 0 && result->messages.empty()) return {};
  return fail(ErrorCode::mismatch, "conform.hard-cases",
              fmt::format("{} of {} rows break what their technique claims, and there are {} validation messages; "
                          "expected none",
                          result->faults(), result->rows.size(), result->messages.size()));
}

Status fuzz(const Context& context, const Registry& registry, const ConformOptions& options) {
  FuzzInput input = options.fuzz_input;
  input.registry = &registry;
  input.backends = options.backends;
  Result<std::vector<std::string>> names = technique_names(registry, options.techniques);
  if (!names) return tl::unexpected(names.error());
  input.techniques = std::move(*names);
  Result<FuzzResult> result = run_fuzz(input);
  if (!result) return tl::unexpected(result.error());
  if (context.json) {
    print_json(to_json(*result));
  } else {
    print(*result);
  }
  if (result->faults == 0 && result->messages.empty()) return {};
  return fail(
      ErrorCode::mismatch, "conform.fuzz",
      fmt::format("{} faults and {} validation messages; expected none", result->faults, result->messages.size()));
}

Status run_conform(const Context& context, const ConformOptions& options) {
  Result<Registry> registry = context.registry();
  if (!registry) return tl::unexpected(registry.error());
  if (options.hard_cases->count() > 0) return conform_to_hard_cases(context, *registry, options);
  if (options.fuzz->count() > 0) return fuzz(context, *registry, options);
  if (options.scenes.empty() && options.heights.empty()) {
    return fail(ErrorCode::usage, "conform.nothing",
                "nothing to conform on; expected --scene FILE, --height FILE, --hard-cases or --fuzz N");
  }
  Result<EvaluationInput> input =
      make_input(*registry, options.techniques, options.scenes, options.heights, options.address, options.set);
  if (!input) return tl::unexpected(input.error());
  input->backends = options.backends;
  input->ray_image = options.ray_image;
  input->repeats = options.repeats;
  input->time = false;
  input->pictures = options.output;
  if (!options.output.empty()) {
    if (Status status = make_folder(options.output); !status) return status;
  }
  Result<Evaluation> evaluation = evaluate(*input);
  if (!evaluation) return tl::unexpected(evaluation.error());
  if (context.json) {
    print_json(to_json(*evaluation));
  } else {
    print(*evaluation);
  }
  std::size_t failed = static_cast<std::size_t>(
      std::count_if(evaluation->checks.begin(), evaluation->checks.end(), [](const Check& c) { return !c.passed; }));
  if (failed > 0)
    return fail(ErrorCode::mismatch, "conform.failed",
                fmt::format("{} of {} checks fail", failed, evaluation->checks.size()));
  return {};
}

}  // namespace

void add_conform(CLI::App& app, Context& context) {
  auto options = std::make_shared<ConformOptions>();
  CLI::App* command =
      add_command(app, context, "conform", "Compare backends with each other, the oracle and the claims",
                  [&context, options] { return run_conform(context, *options); });
  command
      ->add_option("--techniques", options->techniques,
                   "a,b,…, all, or always: those that claim to find the first hit always")
      ->capture_default_str();
  command->add_option("--scene", options->scenes, "Scene files: pictures of every drawing stage");
  command->add_option("--height", options->heights,
                      "Height files, each with an optional :scale: rays at 60°, 20° and 8°");
  options->hard_cases =
      command
          ->add_option("--hard-cases", options->hard_case_folder,
                       "Only the hard cases: those of a folder or file, by default the program's own; each --height "
                       "gets every kind of ray as well")
          ->expected(0, 1)
          ->type_name("[DIR]");
  command->add_option("--rays", options->rays, "Rays a hard case and address mode")
      ->check(CLI::Range(1, 10000000))
      ->needs(options->hard_cases)
      ->capture_default_str();
  options->fuzz = command
                      ->add_option("--fuzz", options->fuzz_input.calls,
                                   "Only fuzzing: N rays in all, over random maps, rays and parameters")
                      ->type_name("N")
                      ->check(CLI::PositiveNumber)
                      ->excludes(options->hard_cases);
  command->add_option("--seed", options->fuzz_input.seed, "Of the fuzzing")
      ->needs(options->fuzz)
      ->capture_default_str();
  command->add_option("--round", options->fuzz_input.round, "Only this round of the fuzzing, to see a finding again")
      ->needs(options->fuzz);
  command->add_option("--patience", options->fuzz_input.patience, "Seconds that one job of the fuzzing may take")
      ->needs(options->fuzz)
      ->check(CLI::Range(1e-3, 1e6))
      ->capture_default_str();
  command->add_option("--address", options->address, "Of the height files")->capture_default_str();
  command->add_option("--backends", options->backends, "vulkan, opengl, vulkan_loose: see list backends")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--ray-image", options->ray_image, "Rays a side of the ray image")
      ->check(CLI::Range(1, 8192))
      ->capture_default_str();
  command
      ->add_option("--repeats", options->repeats,
                   "If more than 1, pictures are drawn again so often, and must be byte-identical")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--set", options->set, "technique.parameter=value");
  command->add_option("-o,--output", options->output, "Folder for the pictures");
}

}  // namespace relievo::cli
