#include "report/plot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>

extern char** environ;

namespace relievo::cli {

namespace {

/// Paul Tol's muted colours, distinct to colour-blind readers, and black; with as many marks as are prime to them, so
/// that many techniques differ in one or the other.
constexpr std::array<const char*, 10> colors = {"#332288", "#cc6677", "#117733", "#ddaa33", "#88ccee",
                                                "#882255", "#44aa99", "#999933", "#aa4499", "#000000"};
constexpr std::array<int, 7> marks = {7, 5, 9, 11, 13, 6, 4};  // gnuplot's point types: filled ones, then open ones

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
std::string run_gnuplot(const std::filesystem::path& script, const std::filesystem::path& svg,
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

/// The element alone, with identifiers that are unique in a page of several plots.
std::string inline_svg(std::string text, double angle) {
  std::size_t start = text.find("<svg"), end = text.rfind("</svg>");
  if (start == std::string::npos || end == std::string::npos) return {};
  text = text.substr(start, end + 6 - start);
  for (const char* name : {"gpDot", "gpPt", "gnuplot_plot_"})
    replace_all(text, name, fmt::format("a{}{}", angle, name));
  return text;
}

/// The points of one curve: fastest first, what is never wrong lifted to half a ray so that a logarithm exists.
std::string curve_data(const Sweep& sweep, const std::string& technique, std::string_view filter, double angle) {
  std::vector<const SweepPoint*> points;
  for (const SweepPoint& p : sweep.points) {
    if (p.technique == technique && p.filter == filter && p.angle == angle && p.ratio > 0) points.push_back(&p);
  }
  std::sort(points.begin(), points.end(), [](const SweepPoint* a, const SweepPoint* b) { return a->count < b->count; });
  std::string data;
  for (const SweepPoint* p : points)
    data += fmt::format("{:.6g} {:.6g}\n", p->ratio, std::max(p->wrong_percent, p->resolution / 2));
  return data;
}

std::vector<std::string> techniques_of(const Sweep& sweep) {
  std::vector<std::string> names;
  for (const SweepPoint& p : sweep.points) {
    if (std::find(names.begin(), names.end(), p.technique) == names.end()) names.push_back(p.technique);
  }
  return names;
}

}  // namespace

std::string plot_script(const Sweep& sweep, double angle) {
  std::string blocks, curves;
  std::size_t index = 0;
  for (const std::string& technique : techniques_of(sweep)) {
    for (const char* filter : {"hardware", "exact"}) {
      std::string data = curve_data(sweep, technique, filter, angle);
      if (data.empty()) continue;
      bool dashed = std::strcmp(filter, "exact") == 0;
      std::string block = fmt::format("$c{}{}", index, filter);
      blocks += fmt::format("{} << EOD\n{}EOD\n", block, data);
      curves += fmt::format(
          "{} {} with linespoints linecolor rgb '{}' linewidth 1.6 pointtype {} pointsize 0.6 {} title '{}'",
          curves.empty() ? "" : ",", block, colors[index % colors.size()], marks[index % marks.size()],
          dashed ? "dashtype '-'" : "dashtype solid", dashed ? "" : technique);
    }
    ++index;
  }
  if (curves.empty()) return {};
  return "set terminal svg noenhanced size 760,520 dynamic font 'sans-serif,13'\n"
         "set encoding utf8\nset logscale xy\nset grid linecolor rgb '#dddddd' linetype 1\nset border 3 linecolor rgb "
         "'#555555'\nset tics nomirror\n"
         "set xlabel 'time, as a ratio to relief 100 + 7'\nset ylabel 'wrong hits, %'\nset format '%g'\n"
         "set offsets graph 0.03, graph 0.03\nset xlabel offset 0,0.4\nset key outside below horizontal samplen 2 "
         "maxrows 4\n" +
         blocks + "plot" + curves + "\n";
}

Plot draw_plot(const Sweep& sweep, double angle) {
  Plot plot{angle, "", ""};
  std::string script = plot_script(sweep, angle);
  if (script.empty()) {
    plot.problem = "the backend has no timestamps";
    return plot;
  }
  TemporaryFolder folder;
  std::ofstream file(folder.path() / "plot.gp");
  file << script;
  file.close();
  if (folder.path().empty() || !file) {
    plot.problem = "the temporary folder cannot be written";
    return plot;
  }
  plot.problem = run_gnuplot(folder.path() / "plot.gp", folder.path() / "plot.svg", folder.path() / "log");
  if (!plot.problem.empty()) return plot;
  plot.svg = inline_svg(read_text(folder.path() / "plot.svg"), angle);
  if (plot.svg.empty()) plot.problem = "gnuplot wrote no SVG";
  return plot;
}

}  // namespace relievo::cli
