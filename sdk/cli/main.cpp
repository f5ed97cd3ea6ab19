#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <new>

#include <fmt/format.h>

#include "common.hpp"

namespace {

/// glslc's spellings that CLI11 does not take: one dash, several letters.
std::vector<std::string> long_options(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  for (std::string& argument : arguments) {
    if (argument == "-MD" || argument == "-MF" || argument == "-MT" || argument == "-O0") argument.insert(0, "-");
  }
  std::reverse(arguments.begin(), arguments.end());  // the order that CLI11's parse takes
  return arguments;
}

/// Ranges let NaN through, and some have no end.
void refuse_endless_numbers(CLI::App& app) {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0;
    if (!CLI::detail::lexical_cast(text, value) || std::isfinite(value)) return {};
    return fmt::format("{} is given; a finite number is expected", text);
  };
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    refuse_endless_numbers(*command);
    for (CLI::Option* option : command->get_options()) {
      if (option->get_type_name().starts_with("FLOAT")) option->check(CLI::Validator(check, "", "finite"));
    }
  }
}

/// Results that did not come out, on a full disk say, are no success.
int finish(int exit_code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  fmt::print(stderr, "error: what was printed cannot be written: {} [cli.write]\n", std::strerror(errno));
  return exit_code == 0 ? relievo::exit_code(relievo::ErrorCode::io) : exit_code;
}

/// A first word that is no command is answered with the nearest one.
relievo::Status check_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    known.push_back(command->get_name());
  if (std::find(known.begin(), known.end(), argv[1]) != known.end()) return {};
  std::string nearest = relievo::nearest_name(argv[1], known);
  return relievo::fail(relievo::ErrorCode::usage, "cli.unknown-command",
                       fmt::format("the command '{}' is not known; {}", argv[1],
                                   nearest.empty() ? fmt::format("known are {}", fmt::join(known, ", "))
                                                   : fmt::format("the nearest is '{}'", nearest)));
}

}  // namespace

int main(int argc, char** argv) {
  using namespace relievo::cli;
  CLI::App app{
      "Displacement-mapping techniques: compiled for every target, run on several APIs, measured against an exact "
      "oracle",
      "relievo"};
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("relievo ") + RELIEVO_VERSION);
  Context context;
  for (auto add : {add_list, add_describe, add_compile, add_permute, add_archive, add_cache, add_bake, add_certify,
                   add_trace, add_render, add_bench, add_conform, add_report}) {
    add(app, context);
  }
  add_techniques_option(app, context);
  refuse_endless_numbers(app);
  if (relievo::Status status = check_command(app, argc, argv); !status) {
    context.report(status.error());
    return finish(context.exit_code);
  }
  try {
    app.parse(long_options(argc, argv));
  } catch (const CLI::ParseError& error) {
    return finish(app.exit(error) == 0 ? 0 : 1);
  } catch (const std::bad_alloc&) {
    context.report({relievo::ErrorCode::io, "cli.memory", "there is not enough memory for this", "", 0, 0});
  } catch (const std::exception& error) {
    context.report({relievo::ErrorCode::io, "cli.failure", error.what(), "", 0, 0});
  }
  return finish(context.exit_code);
}
