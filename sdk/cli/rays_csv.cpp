#include "rays_csv.hpp"

#include <fmt/format.h>
#include <fstream>
#include <iostream>

namespace relievo::cli {

namespace {

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t start = 0;;) {
    std::size_t comma = line.find(',', start);
    std::string_view cell = line.substr(start, comma - start);
    while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t' || cell.back() == '\r')) cell.remove_suffix(1);
    cells.push_back(cell);
    if (comma == std::string_view::npos) return cells;
    start = comma + 1;
  }
}

/// `row` is the whole line that the cells lie in.
Result<Ray> parse_ray(std::string_view row, const std::vector<std::string_view>& cells, const std::string& path,
                      int line) {
  Ray ray;
  double* fields[] = {&ray.u, &ray.v, &ray.h, &ray.du, &ray.dv, &ray.dh, &ray.t_max};
  if (cells.size() != 6 && cells.size() != 7) {
    return fail(ErrorCode::io, "rays.columns",
                fmt::format("row has {} values; expected 6 or 7: u,v,h,du,dv,dh[,t_max]", cells.size()), path, line, 1);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::string cell(cells[i]);
    if (i == 6 && cell.empty()) break;
    char* end = nullptr;
    *fields[i] = std::strtod(cell.c_str(), &end);
    const int column = static_cast<int>(cells[i].data() - row.data()) + 1;
    if (cell.empty() || *end != '\0')
      return fail(ErrorCode::io, "rays.number", fmt::format("'{}' is not a number", cell), path, line, column);
  }
  return ray;
}

Result<std::vector<Ray>> parse_rays(std::istream& stream, const std::string& path) {
  std::vector<Ray> rays;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::vector<std::string_view> cells = split(line);
    bool blank = cells.size() == 1 && cells[0].empty();
    if (number == 1) {
      constexpr std::string_view names[] = {"u", "v", "h", "du", "dv", "dh", "t_max"};
      bool good = cells.size() == 6 || cells.size() == 7;
      for (std::size_t i = 0; good && i < cells.size(); ++i) good = cells[i] == names[i];
      if (!good)
        return fail(ErrorCode::io, "rays.header",
                    fmt::format("header is '{}'; expected u,v,h,du,dv,dh[,t_max]", line.substr(0, 80)), path, 1, 1);
      continue;
    }
    if (blank) continue;
    Result<Ray> ray = parse_ray(line, cells, path, number);
    if (!ray) return tl::unexpected(ray.error());
    rays.push_back(*ray);
  }
  if (rays.empty())
    return fail(ErrorCode::io, "rays.empty", "there are no rays; expected a header and at least one row", path);
  return rays;
}

}  // namespace

Result<std::vector<Ray>> read_rays(const std::string& path) {
  if (path == "-") return parse_rays(std::cin, "<stdin>");
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path))
    return fail(ErrorCode::io, "rays.open", fmt::format("'{}' cannot be opened", path), path);
  return parse_rays(file, path);
}

std::string format_hits(const std::vector<Hit>& hits, HitDigits digits) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "status,t,u,v,h,steps,fetches\n");
  for (const Hit& hit : hits) {
    fmt::format_to(std::back_inserter(text), "{},{:.{}g},{:.{}g},{:.{}g},{:.{}g},{},{}\n", to_string(hit.status), hit.t,
                   digits.distance, hit.u, digits.place, hit.v, digits.place, hit.h, digits.distance, hit.steps,
                   hit.fetches);
  }
  return fmt::to_string(text);
}

}  // namespace relievo::cli
