#include "report/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

extern char** environ;

namespace relievo::cli {

namespace {

/// A folder of ours under the system's temporary one, gone with its contents at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code error;
    std::string name = (std::filesystem::temp_directory_path(error) / "relievo-plot-XXXXXX").string();
    if (!error && mkdtemp(name.data())) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Runs `gnuplot script`, silent, output to `svg`; the problem in a sentence, or empty.
std::string run_file(const std::filesystem::path& script, const std::filesystem::path& svg,
                     const std::filesystem::path& log) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, svg.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  std::string program = "gnuplot", no_settings = "--default-settings", file = script.string();
  char* arguments[] = {program.data(), no_settings.data(), file.data(), nullptr};
  pid_t child = 0;
  int error = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT) return "gnuplot is not installed";
  if (error != 0) return fmt::format("gnuplot cannot be started: {}", std::strerror(error));
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return fmt::format("gnuplot is lost: {}", std::strerror(errno));
  }
  if (status == 0) return {};
  return fmt::format("gnuplot fails: {}", read_text(log).substr(0, 300));
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

void erase_between(std::string& text, const std::string& start, const std::string& end) {
  for (std::size_t at = text.find(start); at != std::string::npos; at = text.find(start, at)) {
    std::size_t last = text.find(end, at);
    if (last == std::string::npos) return;
    text.erase(at, last + end.size() - at);
  }
}

/// The element alone, with identifiers that are unique in a page of several plots.
std::string inline_svg(std::string text, const std::string& prefix) {
  std::size_t start = text.find("<svg"), end = text.rfind("</svg>");
  if (start == std::string::npos || end == std::string::npos) return {};
  text = text.substr(start, end + 6 - start);
  erase_between(text, "<title>", "</title>");  // of every curve, its number
  replace_all(text, "\t", "");
  for (const char* name : {"gpDot", "gpPt", "gnuplot_plot_", "gnuplot_canvas"}) replace_all(text, name, prefix + name);
  return text;
}

}  // namespace

Drawing run_gnuplot(const std::string& script, const std::string& prefix) {
  TemporaryFolder folder;
  std::ofstream file(folder.path() / "plot.gp");
  file << script;
  file.close();
  if (folder.path().empty() || !file) return {"", "the temporary folder cannot be written"};
  std::string problem = run_file(folder.path() / "plot.gp", folder.path() / "plot.svg", folder.path() / "log");
  if (!problem.empty()) return {"", problem};
  std::string svg = inline_svg(read_text(folder.path() / "plot.svg"), prefix);
  return svg.empty() ? Drawing{"", "gnuplot wrote no SVG"} : Drawing{svg, ""};
}

}  // namespace relievo::cli
