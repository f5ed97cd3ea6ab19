/// relievo cache: what lies in a folder of compiled programs, is it sound, and away with it.
#include "relievo/cache.hpp"

#include <fmt/format.h>

#include "common.hpp"

namespace relievo::cli {

namespace {

using Operation = Result<CacheContents> (*)(const std::filesystem::path&);

Result<std::filesystem::path> chosen_folder(const std::string& given) {
  if (given.starts_with("redis://")) {
    return fail(ErrorCode::usage, "cli.cache",
                fmt::format("--cache {}: expected a folder; a remote cache is looked after by its own server", given));
  }
  const std::filesystem::path folder = given.empty() ? default_cache_folder() : std::filesystem::path(given);
  if (!folder.empty()) return folder;
  return fail(ErrorCode::usage, "cli.cache", "no cache folder is known; expected --cache, or HOME to be set");
}

void print(const Context& context, std::string_view word, const std::string& folder, const CacheContents& contents) {
  if (context.json) {
    const nlohmann::json json = {
        {"folder", folder},          {"entries", contents.entries},       {"bytes", contents.bytes},
        {"broken", contents.broken}, {"unreadable", contents.unreadable}, {"unfinished", contents.unfinished}};
    print_json(json);
    return;
  }
  fmt::print("{}: {} entries{}, {:.1f} MB", folder, contents.entries, word, static_cast<double>(contents.bytes) * 1e-6);
  if (contents.broken > 0) fmt::print("; {} more were damaged and are removed", contents.broken);
  if (contents.unreadable > 0) fmt::print("; {} more cannot be read and are left", contents.unreadable);
  if (contents.unfinished > 0) fmt::print("; {} unfinished files{}", contents.unfinished, word);
  fmt::print("\n");
}

void add_operation(CLI::App& cache, Context& context, const std::string& name, const std::string& title,
                   Operation operation, std::string word) {
  auto given = std::make_shared<std::string>();
  CLI::App* sub = add_command(cache, context, name, title, [&context, given, operation, word]() -> Status {
    const Result<std::filesystem::path> folder = chosen_folder(*given);
    if (!folder) return tl::unexpected(folder.error());
    const Result<CacheContents> contents = operation(*folder);
    if (!contents) return tl::unexpected(contents.error());
    print(context, word, folder->string(), *contents);
    return {};
  });
  sub->add_option("--cache", *given, "Folder; by default $RELIEVO_CACHE_DIR, or relievo in the user's cache folder")
      ->type_name("DIR");
}

}  // namespace

void add_cache(CLI::App& app, Context& context) {
  CLI::App* cache = app.add_subcommand("cache", "Look after the cache of compiled programs");
  cache->require_subcommand(1);
  add_operation(*cache, context, "stats", "Count what lies in the cache", &inspect_cache, "");
  add_operation(*cache, context, "verify", "Read every entry, and remove those that are damaged", &verify_cache,
                " are sound");
  add_operation(*cache, context, "clear", "Remove every entry", &clear_cache, " are removed");
}

}  // namespace relievo::cli
