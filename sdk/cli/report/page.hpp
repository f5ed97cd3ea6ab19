/// The page of `relievo report`: one HTML file that needs nothing beside itself.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/plot.hpp"
#include "report/sweep.hpp"

namespace relievo::cli {

struct Report {
  Evaluation evaluation;
  Sweep sweep;
  std::vector<Plot> plots;  ///< map by map
  std::vector<Phase> phases;
  std::vector<std::string> techniques;
  std::filesystem::path pictures;  ///< folder of Evaluation::pictures
  ValueTexts values;               ///< of --set
  int ray_image = 0, repeats = 0;  ///< of rays and pictures; 0 repeats: not timed
};

/// The whole page. Errors: "report.picture" for a picture that cannot be read back.
Result<std::string> make_page(const Report& report);

/// Its parts, in order. Each is a <section>, or empty when there is nothing to show.
std::string checks_section(const Report& report);
std::string machines_section(const Report& report);
Result<std::string> gallery_section(const Report& report);
std::string rays_section(const Report& report);
std::string speed_section(const Report& report);
std::string costs_section(const Report& report);
Result<std::string> heat_section(const Report& report);

}  // namespace relievo::cli
