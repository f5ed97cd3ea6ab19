/// Hard cases: what breaks displacement techniques, as data (tests/hard_cases/README.md). A case names a generator of a
/// height map and a generator of rays; both are here, by name.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "relievo/height_map.hpp"
#include "relievo/oracle.hpp"

namespace relievo::cli {

/// A height map by generator. Heights t of the generator become low + (high − low)·t.
struct HardMap {
  std::string kind = "noise";
  int width = 32, height = 32;  ///< texels
  double low = 0, high = 1;
  double value = 0.5;    ///< constant
  int steps = 8;         ///< staircase
  int period = 8;        ///< ridge: texels
  bool along_v = false;  ///< ridge, wall: along v instead of u
  int terraces = 0;      ///< rounded to multiples of 1/terraces; 0 = not at all
  int seed = 1;          ///< noise, smooth

  bool operator==(const HardMap&) const = default;
};

/// Rays by generator.
struct HardRays {
  std::string kind = "random";
  std::array<double, 2> angle = {2, 85};  ///< degrees above the base plane: between these
  double scale = 0.1;                     ///< height of the lid in texture widths
  double offset = 1e6;                    ///< far: whole tiles added to u and taken from v
  int seed = 1;
};

struct HardCase {
  std::string name, rule;  ///< which rule of design.md §6 it stands for, or what else makes it hard
  HardMap map;
  std::vector<AddressMode> addresses = {AddressMode::repeat, AddressMode::mirror, AddressMode::clamp,
                                        AddressMode::clip};
  HardRays rays;
  int bits = 0;              ///< of every map that can be quantised; 0 = their defaults
  bool may_exhaust = false;  ///< so long that a technique may run out of steps, as long as it says so
  std::string file;
  int line = 0;
};

std::vector<std::string_view> hard_map_kinds();
std::vector<std::string_view> hard_ray_kinds();

/// The keys of HardMap beside kind, width, height, low and high that a kind reads.
std::vector<std::string_view> hard_map_keys(std::string_view kind);

HeightMap make_hard_map(const HardMap& map, AddressMode address);

/// `count` rays whose numbers survive the way to the shader: u and v as whole tiles plus a float, the others floats. So
/// the oracle traces the very ray that a technique gets.
std::vector<Ray> make_hard_rays(const HardRays& rays, const HeightMap& map, int count);

/// As the shader will see it (see make_hard_rays).
Ray as_shader_sees(Ray ray, AddressMode address);

/// Reads one file of cases. Errors carry file, line and column: "hard_cases.*", "describe.*" for what is no such TOML.
Result<std::vector<HardCase>> parse_hard_cases(std::string_view text, const std::string& file);

/// Every *.toml of a folder, or one file; by name. An error when two cases have one name, or there is none.
Result<std::vector<HardCase>> load_hard_cases(const std::filesystem::path& path);

/// Those of tests/hard_cases, which are part of the program.
Result<std::vector<HardCase>> own_hard_cases();

}  // namespace relievo::cli
