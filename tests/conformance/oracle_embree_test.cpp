/// The oracle against Embree, an independent ray tracer. Embree's grids split each quad into two triangles, so the map
/// is refined k times by bilinear interpolation: what remains is a quarter of the cell's twist over k² (design.md §5).
#include <embree3/rtcore.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "relievo/oracle.hpp"
#include "support/brute_force_hit.hpp"
#include "support/height_maps.hpp"

namespace relievo {
namespace {

constexpr int refinement = 8;
constexpr double scale = 0.1;  // height of the relief in widths of the map
constexpr double infinity = std::numeric_limits<double>::infinity();

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using Scene = std::unique_ptr<RTCSceneTy, ReleaseScene>;

/// A ray in texels and H, in Embree's own precision: the oracle gets exactly these numbers, so rounding the ray is no
/// part of the comparison.
struct FloatRay {
  float x, y, h, dx, dy, dh, t_max;
};

Ray in_texture_units(const FloatRay& r, const HeightMap& map) {
  return {(double{r.x} + 0.5) / map.width,
          (double{r.y} + 0.5) / map.height,
          r.h,
          double{r.dx} / map.width,
          double{r.dy} / map.height,
          r.dh,
          r.t_max};
}

/// Texel coordinates that the sheet covers: a clip map's domain, else half a map more on every side.
struct Extent {
  double x0, y0, x1, y1;
};

Extent covered(const HeightMap& map) {
  const double margin_x = map.address == AddressMode::clip ? 0 : std::ceil(map.width / 2.0);
  const double margin_y = map.address == AddressMode::clip ? 0 : std::ceil(map.height / 2.0);
  return {-0.5 - margin_x, -0.5 - margin_y, map.width - 0.5 + margin_x, map.height - 0.5 + margin_y};
}

/// The refined surface as an Embree grid in texel coordinates.
class Sheet {
 public:
  Sheet(const Device& device, const HeightMap& map) : scene_(rtcNewScene(device.get())) {
    const Extent e = covered(map);
    const auto columns = static_cast<unsigned>((e.x1 - e.x0) * refinement) + 1;
    const auto rows = static_cast<unsigned>((e.y1 - e.y0) * refinement) + 1;
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);  // no ray slips through between triangles
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_GRID);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               12, std::size_t{columns} * rows));
    constexpr double step = 1.0 / refinement;
    const test::BruteForce surface(map);
    for (unsigned j = 0; j < rows; ++j) {
      for (unsigned i = 0; i < columns; ++i) {
        const double x = e.x0 + i * step, y = e.y0 + j * step;
        *vertex++ = static_cast<float>(x);
        *vertex++ = static_cast<float>(y);
        *vertex++ = static_cast<float>(surface.surface(x, y));
      }
    }
    auto* grid = static_cast<RTCGrid*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), 1));
    *grid = {0, columns, static_cast<unsigned short>(columns), static_cast<unsigned short>(rows)};
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_.get());
  }

  /// t of the first hit; infinite when there is none.
  double trace(const FloatRay& r) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray.org_x = r.x, query.ray.org_y = r.y, query.ray.org_z = r.h;
    query.ray.dir_x = r.dx, query.ray.dir_y = r.dy, query.ray.dir_z = r.dh;
    query.ray.tfar = r.t_max;
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context, &query);
    return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? infinity : query.ray.tfar;
  }

 private:
  Scene scene_;
};

/// From a little above the lid over the map, as far as the sheet goes.
std::vector<FloatRay> rays_over(const HeightMap& map, double degrees, int count, std::uint64_t seed) {
  const Extent e = covered(map);
  const double drop = std::tan(degrees * std::numbers::pi / 180) / (scale * std::max(map.width, 8));  // of H per texel
  test::Random random(seed);
  std::vector<FloatRay> rays;
  for (int k = 0; k < count; ++k) {
    const double heading = random.uniform(0, 2 * std::numbers::pi);
    FloatRay r{};
    r.x = static_cast<float>(random.uniform(-0.5, map.width - 0.5));
    r.y = static_cast<float>(random.uniform(-0.5, map.height - 0.5));
    r.h = 1 + 0x1p-6f;
    r.dx = static_cast<float>(std::cos(heading));
    r.dy = static_cast<float>(std::sin(heading));
    r.dh = static_cast<float>(-drop);
    const double to_x = r.dx == 0 ? infinity : ((r.dx > 0 ? e.x1 : e.x0) - r.x) / r.dx;
    const double to_y = r.dy == 0 ? infinity : ((r.dy > 0 ? e.y1 : e.y0) - r.y) / r.dy;
    // On a clip map the oracle is to find the end by itself; elsewhere the ray ends safely on the sheet.
    r.t_max = map.address == AddressMode::clip ? 1e6f : static_cast<float>(0.999 * std::min(to_x, to_y));
    rays.push_back(r);
  }
  return rays;
}

struct Comparison {
  std::size_t rays = 0, hits = 0;
  std::size_t near_tangent = 0;  ///< apart by more than the bound, explained by a surface shifted by the bound
  std::size_t unexplained = 0;
  std::string first_unexplained;
};

/// Judges Embree's t against the oracle of a map, which should be the map that the sheet was made of.
class Judge {
 public:
  explicit Judge(const HeightMap& map) : map_(map), oracle_(map) {
    const Extent e = covered(map);
    for (double y = e.y0; y < e.y1; y += 0.5)
      for (double x = e.x0; x < e.x1; x += 0.5) greatest_twist_ = std::max(greatest_twist_, twist(x, y));
  }

  void compare(const Sheet& sheet, const std::vector<FloatRay>& rays, Comparison& comparison) const {
    std::vector<Ray> exact;
    for (const FloatRay& ray : rays) exact.push_back(in_texture_units(ray, map_));
    const std::vector<Hit> hits = oracle_.trace(exact);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double expected = time_of(hits[i]), found = sheet.trace(rays[i]);
      ++comparison.rays;
      comparison.hits += std::isfinite(expected);
      if (agrees(rays[i], exact[i], expected, found)) continue;
      if (is_near_tangent(rays[i], exact[i], found)) {
        ++comparison.near_tangent;
      } else if (++comparison.unexplained == 1) {
        comparison.first_unexplained = describe(rays[i], expected, found);
      }
    }
  }

 private:
  static double time_of(const Hit& hit) {
    return hit.status == HitStatus::hit || hit.status == HitStatus::inside ? hit.t : infinity;
  }
  double twist(double x, double y) const { return std::abs(static_cast<double>(surface_.twist(x, y))); }

  /// Embree works in float: its t comes from some eight operations on numbers as large as the coordinates and the way,
  /// each with a relative error of 2⁻²⁴. In texels:
  static double time_error(const FloatRay& r, double t) {
    return 8 * 0x1p-24 * (std::abs(r.x) + std::abs(r.y) + std::min(t, double{r.t_max}) + 1);
  }
  /// The same as a height, the surface rising by at most 1 a texel along either axis, and the vertices' own rounding.
  static double height_error(const FloatRay& r, double t) {
    return time_error(r, t) * (std::abs(r.dh) + std::abs(r.dx) + std::abs(r.dy)) + 0x1p-24;
  }
  static double left_by_refinement(double twist) { return twist / (4 * refinement * refinement); }

  /// Both miss, or Embree's hit lies on the oracle's surface, up to the bound of its own cell, and belongs to the same
  /// crossing.
  bool agrees(const FloatRay& r, const Ray& exact, double expected, double found) const {
    if (std::isinf(expected) || std::isinf(found)) return expected == found;
    const double x = r.x + found * r.dx, y = r.y + found * r.dy;
    const double bound = left_by_refinement(twist(x, y)) + height_error(r, found);
    const double deviation = std::abs(static_cast<double>(surface_.clearance(exact, found)));
    return deviation <= bound && std::abs(found - expected) <= 0.5;
  }

  /// A surface that is nowhere further than `bound` from the oracle's is met between where the ray meets the oracle's
  /// surface raised and lowered by it, and moving the ray is the same as moving the surface. So this accepts only rays
  /// that pass the surface, or penetrate it, by less than the bound.
  bool is_near_tangent(const FloatRay& r, const Ray& exact, double found) const {
    const double bound = left_by_refinement(greatest_twist_) + height_error(r, found);
    Ray lowered = exact, raised = exact;
    lowered.h -= bound, raised.h += bound;
    const double error = time_error(r, found);
    return time_of(oracle_.trace(lowered)) - error <= found && found <= time_of(oracle_.trace(raised)) + error;
  }

  std::string describe(const FloatRay& r, double expected, double found) const {
    char text[300];
    std::snprintf(text, sizeof text, "%s: ray %.9g %.9g %.9g + t (%.9g %.9g %.9g): t is %.9g, Embree's %.9g",
                  std::string(to_string(map_.address)).c_str(), r.x, r.y, r.h, r.dx, r.dy, r.dh, expected, found);
    return text;
  }

  HeightMap map_;
  Oracle oracle_;
  test::BruteForce surface_{map_};
  double greatest_twist_ = 0;
};

std::vector<test::NamedMap> compared_maps() {
  return {{"checker", test::checker_map(16, 16)},
          {"spike", test::spike_map(32, 32)},
          {"wall", test::wall_map(32, 32)},
          {"staircase", test::staircase_map(64, 16)},
          {"plateau", test::plateau_map(32, 32)},
          {"ridge across", test::ridge_map(32, 16, true)},
          {"smooth noise", test::smooth_noise_map(64, 64)},
          {"smooth noise 48x33", test::smooth_noise_map(48, 33)},
          {"white noise", test::white_noise_map(32, 32)},
          {"7x13", test::white_noise_map(7, 13)},
          {"9x1", test::white_noise_map(9, 1)}};
}

constexpr std::array angles = {60.0, 20.0, 6.0};

/// Traces rays at every angle over a sheet of `map`, judged by the oracle of `judged`.
Comparison compare(const Device& device, const HeightMap& map, const HeightMap& judged, int rays_per_angle) {
  const Sheet sheet(device, map);
  const Judge judge(judged);
  Comparison comparison;
  for (const double angle : angles)
    judge.compare(sheet, rays_over(map, angle, rays_per_angle, static_cast<std::uint64_t>(angle)), comparison);
  return comparison;
}

TEST(OracleAgainstEmbree, LeavesNoDifferenceUnexplained) {
  const Device device(rtcNewDevice(nullptr));
  ASSERT_TRUE(device);
  Comparison total;
  for (const AddressMode mode : test::all_address_modes) {
    for (const test::NamedMap& named : compared_maps()) {
      const HeightMap map = test::with_address(named.map, mode);
      const Comparison one = compare(device, map, map, 8000);
      EXPECT_EQ(one.unexplained, 0u) << named.name << ", " << one.first_unexplained;
      total.rays += one.rays, total.hits += one.hits, total.near_tangent += one.near_tangent;
    }
  }
  std::printf("%zu rays, %zu hits, %zu near-tangent\n", total.rays, total.hits, total.near_tangent);
  EXPECT_GE(total.rays, 1000000u);
  EXPECT_GE(total.hits, total.rays / 2);
  EXPECT_LE(total.near_tangent, total.rays / 100);
}

class OracleAgainstEmbreeFault : public testing::Test {
 protected:
  /// Share of rays on which the comparison catches that the oracle's map is not Embree's.
  static double caught(const HeightMap& map, const HeightMap& faulty) {
    const Device device(rtcNewDevice(nullptr));
    const Comparison comparison = compare(device, map, faulty, 2000);
    return static_cast<double>(comparison.unexplained) / static_cast<double>(comparison.rays);
  }
  const HeightMap map_ = test::smooth_noise_map(64, 64);
};

TEST_F(OracleAgainstEmbreeFault, AMapShiftedByATexelIsCaught) {
  EXPECT_GT(caught(map_, test::make_map(64, 64, [&](int i, int j) { return map_.at((i + 1) % 64, j); })), 0.5);
}

TEST_F(OracleAgainstEmbreeFault, SwappedAxesAreCaught) {
  EXPECT_GT(caught(map_, test::make_map(64, 64, [&](int i, int j) { return map_.at(j, i); })), 0.5);
}

TEST_F(OracleAgainstEmbreeFault, AHeightErrorOfTwoInTwoHundredFiftyFiveIsCaught) {
  EXPECT_GT(caught(map_, test::make_map(64, 64, [&](int i, int j) { return map_.at(i, j) + 2 / 255.0; })), 0.5);
}

TEST_F(OracleAgainstEmbreeFault, TheWrongAddressModeIsCaught) {
  EXPECT_GT(caught(map_, test::with_address(map_, AddressMode::mirror)), 0.02);
}

TEST_F(OracleAgainstEmbreeFault, ASingleWrongTexelIsCaught) {
  HeightMap faulty = map_;
  faulty.texels[64 * 20 + 30] += 0.05f;
  EXPECT_GT(caught(map_, faulty), 0.0);
}

}  // namespace
}  // namespace relievo
