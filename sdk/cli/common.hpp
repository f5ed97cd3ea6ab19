/// What the subcommands share: options, settings, progress and how errors end the program.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "relievo/backend.hpp"
#include "relievo/measure.hpp"
#include "relievo/render.hpp"

namespace relievo::cli {

/// Options of every subcommand, and the exit code that main returns.
struct Context {
  std::vector<std::string> folders;  ///< --techniques
  bool json = false;
  int exit_code = 0;

  Result<Registry> registry() const;
  /// Prints the error (gcc style on stderr, or JSON on stdout with --json) and sets the exit code.
  void report(const Error& error);
};

/// Adds a subcommand with the options that all have; `run` returns a Status that becomes the exit code.
CLI::App* add_command(CLI::App& app, Context& context, const std::string& name, const std::string& title,
                      std::function<Status()> run);

/// Gives every subcommand that does not name techniques by `--techniques` this spelling of `--techniques-dir`.
/// Call it when all subcommands are there.
void add_techniques_option(CLI::App& app, Context& context);

/// --set k=v, … : values by "owner.parameter" and filters by technique.
struct Settings {
  std::map<std::string, double> values;
  std::map<std::string, HeightFilter> filters;
};

/// Parses `k=v` and `owner.k=v`; an unqualified key belongs to `only` (the command's single technique, or empty).
/// Errors: "cli.set" with the nearest known name.
Result<Settings> parse_settings(const Registry& registry, const std::vector<std::string>& given,
                                const std::string& only);

/// `key`, or "only.key" where it names no owner and there is but one that it can mean.
std::string qualified(const std::string& key, const std::string& only);

/// Every parameter of the registry by "owner.parameter".
using KnownParameters = std::map<std::string, const Parameter*>;
KnownParameters known_parameters(const Registry& registry);

/// The one that `text`, the option as it was given, asks for. Errors: "cli.set" with the nearest known name.
Result<const Parameter*> find_parameter(const KnownParameters& known, const std::string& key, const std::string& text);

/// Parameters by name, with their values as --set takes them.
using ValueTexts = std::map<std::string, std::string>;

ValueTexts to_texts(const Registry& registry, const std::map<std::string, double>& values);

/// What requests on the backend have that leave the axes open (values_on).
ValueTexts own_values(const Registry& registry, const BackendInfo& backend);

/// "ray.storage=image, …"
std::string to_text(const ValueTexts& values);

/// Opens a backend by its name, with programs kept in the user's cache.
Result<std::unique_ptr<Backend>> open(const std::string& name, bool validation);

/// "a,b,c" or repeated options → names; "all" → every technique, "always" → those that claim to find the first
/// hit always.
Result<std::vector<std::string>> technique_names(const Registry& registry, const std::vector<std::string>& given);

Result<HeightMap> load_height(const std::string& path, const std::string& address);

/// Gives the lid's height, in texture widths of `map`, to the stage `ray` and to every map that is baked for one: to
/// their parameters of the name `scale`, in their units and ranges, as far as `values` leaves them open.
void set_scale(const Registry& registry, double scale, const HeightMap& map, std::map<std::string, double>& values);

/// The scene's parts, loaded: mesh files go through Assimp.
struct LoadedScene {
  Scene scene;
  Mesh mesh;
  HeightMap height;
};
Result<LoadedScene> load_scene_parts(const std::filesystem::path& path);

/// By these, glslangValidator and glslc know what a file is.
constexpr std::string_view stage_suffix(ShaderStage stage) {
  constexpr std::string_view names[] = {"vert", "tesc", "tese", "geom", "frag", "comp"};
  return names[static_cast<std::size_t>(stage)];
}

/// Prints a document on stdout; what is no UTF-8 in it, such as a file's name, with � for the bytes that are not.
void print_json(const nlohmann::json& document);
/// The same on one line.
std::string json_text(const nlohmann::json& document);

/// Writes a file atomically, a pipe or device in place; "-" is stdout.
Status write_text(const std::string& path, const std::string& text);
Status make_folder(const std::filesystem::path& path);

/// Of an even number the mean of the two in the middle; −1 of nothing, which stands for "not timed".
double median(std::vector<double> values);

/// "12.345"; "<0.001" for what would be rounded to nothing, "0" for nothing itself, "–" of no rays (NaN).
std::string percent_text(double percent);
/// "1.20e-03", or "–" of no values (NaN).
std::string error_text(double error);

nlohmann::json to_json(const ErrorFigures& figures);

/// A progress bar on stderr when that is a terminal; nothing otherwise. Thread-safe.
class Progress {
 public:
  Progress(std::string label, std::size_t total);
  ~Progress();
  void advance(const std::string& what);

 private:
  std::string label_;
  std::size_t total_, done_ = 0;
  bool shown_;
  std::mutex mutex_;
};

// One a file.
void add_list(CLI::App& app, Context& context);
void add_describe(CLI::App& app, Context& context);
void add_compile(CLI::App& app, Context& context);
void add_permute(CLI::App& app, Context& context);
void add_archive(CLI::App& app, Context& context);
void add_cache(CLI::App& app, Context& context);
void add_bake(CLI::App& app, Context& context);
void add_certify(CLI::App& app, Context& context);
void add_trace(CLI::App& app, Context& context);
void add_render(CLI::App& app, Context& context);
void add_bench(CLI::App& app, Context& context);
void add_conform(CLI::App& app, Context& context);
void add_report(CLI::App& app, Context& context);

}  // namespace relievo::cli
