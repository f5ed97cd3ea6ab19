/// Hard cases: the data is complete, bad files are named by line, rays survive the way to the shader, and the judgement
/// catches every kind of fault.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "evaluation/hard_run.hpp"
#include "support/files.hpp"

namespace relievo::cli {
namespace {

const std::vector<HardCase>& own() {
  static const Result<std::vector<HardCase>> cases = own_hard_cases();
  EXPECT_TRUE(cases) << format(cases.error());
  return *cases;
}

TEST(HardCases, EveryNameThatIsAskedForIsThere) {
  std::set<std::string> names;
  for (const HardCase& item : own()) names.insert(item.name);
  for (const char* name : {"spike",
                           "wall_along",
                           "checkerboard",
                           "staircase",
                           "ridge_along",
                           "ridge_across",
                           "plateau",
                           "constant_zero",
                           "constant_one",
                           "size_1x1",
                           "size_1x9",
                           "size_9x1",
                           "size_7x13",
                           "grid_line_noise",
                           "corner_noise",
                           "vertical_noise",
                           "horizontal_noise",
                           "grazing_a_tenth",
                           "scale_1e6_downwards",
                           "scale_1e3",
                           "uv_far_noise",
                           "terraces",
                           "denormal_heights",
                           "inside_noise",
                           "surface_start_noise",
                           "limit",
                           "lid_touching",
                           "tangent_smooth",
                           "quantised_8",
                           "sheared_frame",
                           "noise_white",
                           "axis_parallel_noise"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(HardCases, EveryKindOfMapRayAndAddressModeIsUsed) {
  std::set<std::string_view> maps, rays;
  std::set<AddressMode> addresses;
  for (const HardCase& item : own()) {
    maps.insert(item.map.kind);
    rays.insert(item.rays.kind);
    addresses.insert(item.addresses.begin(), item.addresses.end());
  }
  for (std::string_view kind : hard_map_kinds()) EXPECT_TRUE(maps.contains(kind)) << kind;
  for (std::string_view kind : hard_ray_kinds()) EXPECT_TRUE(rays.contains(kind)) << kind;
  EXPECT_EQ(addresses.size(), 4U);
}

TEST(HardCases, TheProgramHasTheFilesOfTheFolder) {
  const Result<std::vector<HardCase>> loaded = load_hard_cases(RELIEVO_SOURCE_DIR "/tests/hard_cases");
  ASSERT_TRUE(loaded) << format(loaded.error());
  ASSERT_EQ(loaded->size(), own().size());
  for (std::size_t i = 0; i < own().size(); ++i) EXPECT_EQ((*loaded)[i].name, own()[i].name);
}

TEST(HardCases, MapsAreOfTheirSizeAndWithinTheSlab) {
  for (const HardCase& item : own()) {
    const HeightMap map = make_hard_map(item.map, AddressMode::clamp);
    ASSERT_EQ(map.texels.size(), static_cast<std::size_t>(item.map.width) * static_cast<std::size_t>(item.map.height));
    for (const float t : map.texels) ASSERT_TRUE(t >= 0 && t <= 1) << item.name;
  }
  HardMap denormal;
  denormal.high = 1e-39;
  const HeightMap map = make_hard_map(denormal, AddressMode::repeat);
  EXPECT_EQ(std::fpclassify(map.texels[5]), FP_SUBNORMAL);
  HardMap terraces;
  terraces.kind = "smooth";
  terraces.terraces = 255;
  for (const float t : make_hard_map(terraces, AddressMode::repeat).texels)
    EXPECT_EQ(t, static_cast<float>(std::round(t * 255.0) / 255));
}

TEST(HardCases, EveryRaySurvivesTheWayToTheShader) {
  std::size_t rays = 0;
  for (const HardCase& item : own()) {
    for (const AddressMode address : item.addresses) {
      for (const Ray& ray : make_hard_rays(item.rays, make_hard_map(item.map, address), 50)) {
        ++rays;
        const Ray again = as_shader_sees(ray, address);
        for (const double Ray::*field : {&Ray::u, &Ray::v, &Ray::h, &Ray::du, &Ray::dv, &Ray::dh, &Ray::t_max})
          ASSERT_EQ(ray.*field, again.*field) << item.name;
        ASSERT_TRUE(std::isfinite(ray.u) && std::isfinite(ray.v) && std::isfinite(ray.h)) << item.name;
        ASSERT_TRUE(ray.du != 0 || ray.dv != 0 || ray.dh != 0) << item.name;
        ASSERT_GE(ray.t_max, 0) << item.name;
      }
    }
  }
  EXPECT_GT(rays, 10000U);
  const Ray rounded = as_shader_sees({0.1, 1e6 + 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}, AddressMode::repeat);
  EXPECT_EQ(rounded.u, static_cast<double>(0.1f));
  EXPECT_NEAR(rounded.v, 1e6 + 0.1, 1e-8) << "the tile is split off before it is rounded";
  EXPECT_EQ(as_shader_sees({1e6 + 0.1}, AddressMode::clamp).u, static_cast<double>(static_cast<float>(1e6 + 0.1)));
}

TEST(HardCases, MostRaysAreJudged) {
  std::size_t judged = 0, all = 0;
  for (const HardCase& item : own()) {
    const HeightMap map = make_hard_map(item.map, item.addresses.front());
    const std::vector<Ray> rays = make_hard_rays(item.rays, map, 100);
    std::size_t here = 0;
    for (const Hit& hit : Oracle(map).trace(rays)) here += !hit.ambiguous && hit.status != HitStatus::exhausted;
    EXPECT_GE(here, 25U) << item.name << " judges next to nothing";
    judged += here;
    all += rays.size();
  }
  EXPECT_GT(judged, all * 9 / 10);
}

std::string error_of(const std::string& text) {
  const auto cases = parse_hard_cases(text, "cases/bad.toml");
  return cases ? "" : format(cases.error());
}

TEST(HardCases, BadFilesAreNamedByLine) {
  const std::string head = "schema = 1\n\n[[case]]\nname = \"one\"\nrule = \"a rule\"\n";
  const std::string map = "map = {kind = \"noise\"}\n", rays = "rays = {kind = \"random\"}\n";
  EXPECT_EQ(error_of(head + map + rays), "");
  const auto expect_error = [&](const std::string& text, const std::vector<std::string>& parts) {
    const std::string error = error_of(text);
    for (const std::string& part : parts) EXPECT_NE(error.find(part), std::string::npos) << part << "\n" << error;
  };
  expect_error("", {"bad.toml:1", "schema"});
  expect_error("schema = 2\n", {"bad.toml:1", "2"});
  expect_error("schema = 1\n", {"bad.toml:1", "case"});
  expect_error("schema = 1\n[case]\n", {"bad.toml:2", "case"});
  expect_error("schema = 1\n[[case]\n", {"bad.toml:2", "describe.syntax"});
  expect_error(head + map, {"bad.toml:3", "\"rays\""});
  expect_error(head + rays, {"bad.toml:3", "\"map\""});
  expect_error(head + "map = {kind = \"nois\"}\n" + rays, {"bad.toml:6", "nois", "the nearest is \"noise\""});
  expect_error(head + "map = {kind = \"noise\", wdth = 3}\n" + rays, {"bad.toml:6", "wdth", "\"width\""});
  expect_error(head + "map = {kind = \"noise\", width = 0}\n" + rays, {"bad.toml:6", "width", "0"});
  expect_error(head + "map = {kind = \"noise\", steps = 3}\n" + rays,
               {"bad.toml:6", "noise", "steps", "hard_cases.key"});
  expect_error(head + "map = {kind = \"noise\", high = 1.5}\n" + rays, {"bad.toml:6", "1.5", "0 to 1"});
  expect_error(head + "map = \"noise\"\n" + rays, {"bad.toml:6", "a table"});
  expect_error(head + map + "rays = {kind = \"randm\"}\n", {"bad.toml:7", "randm", "random"});
  expect_error(head + map + "rays = {kind = \"random\", angle = 91}\n", {"bad.toml:7", "91"});
  expect_error(head + map + "rays = {kind = \"random\", angle = 9, angle_to = 3}\n", {"bad.toml:7", "3", "9 to 90"});
  expect_error(head + map + "rays = {kind = \"far\", offset = 0.5}\n", {"bad.toml:7", "0.5", "whole"});
  expect_error(head + map + rays + "address = [\"wrap\"]\n", {"bad.toml:8", "wrap", "repeat"});
  expect_error(head + map + rays + "bits = 9\n", {"bad.toml:8", "9", "8, 16 or 32"});
  expect_error(head + map + rays + "exhausted = \"maybe\"\n", {"bad.toml:8", "maybe"});
  expect_error(head + map + rays + "exhaust = 1\n", {"bad.toml:8", "exhaust", "\"exhausted\""});
  const std::string again = "[[case]]\nname = \"one\"\nrule = \"again\"\n";
  expect_error(head + map + rays + again + map + rays, {"bad.toml:8", "one", "bad.toml:3", "hard_cases.duplicate"});
}

TEST(HardCases, FoldersWithoutCasesAreRefused) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(load_hard_cases(folder.path()));
  EXPECT_FALSE(load_hard_cases(folder / "missing.toml"));
  folder.write("bad.toml", "schema = 1\n[[case]]\n");
  const auto bad = load_hard_cases(folder.path());
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().file, (folder / "bad.toml").string());
  EXPECT_EQ(bad.error().line, 2);
}

/// Rays on a plane at H = 1/2, and the oracle's hits.
struct Plane {
  Plane() {
    map = make_hard_map(HardMap{.kind = "constant", .width = 4, .height = 4}, AddressMode::repeat);
    for (int i = 0; i < 8; ++i) rays.push_back({0.125 * i, 0.25, 1, 0.25, 0.125, -0.5});
    rays.push_back({0.5, 0.5, 0.75, 1, 0, 1});     // 8: rises away
    rays.push_back({0.5, 0.5, 0.25, 1, 0, -0.5});  // 9: inside
    truth = Oracle(map).trace(rays);
    hits = truth;
  }
  HardRow judge(FirstHit claim = FirstHit::always, bool may_exhaust = false) const {
    return judge_hard_rays(map, rays, truth, hits, claim, may_exhaust);
  }
  HeightMap map;
  std::vector<Ray> rays;
  std::vector<Hit> truth, hits;
};

TEST(HardCases, RightHitsHaveNoFault) {
  const HardRow row = Plane().judge();
  EXPECT_EQ(row.fault, "");
  EXPECT_FALSE(row.example);
  EXPECT_EQ(row.error.judged, 10U);
}

TEST(HardCases, EveryKindOfFaultIsCaughtWithItsRay) {
  const auto fault = [](std::size_t k, auto change, FirstHit claim = FirstHit::always, bool may_exhaust = false) {
    Plane plane;
    change(plane.hits[k]);
    const HardRow row = plane.judge(claim, may_exhaust);
    EXPECT_EQ(row.fault.empty(), !row.example);
    if (row.example) {
      EXPECT_EQ(row.example->ray.u, plane.rays[k].u);
    }
    return row.fault;
  };
  const auto miss = [](Hit& hit) { hit.status = HitStatus::miss; };
  const auto exhausted = [](Hit& hit) { hit.status = HitStatus::exhausted; };
  const auto not_a_number = [](Hit& hit) { hit.v = std::nan(""); };
  EXPECT_EQ(fault(3, [](Hit& hit) { hit.u += 0.3; }), "1 wrong") << "more than a texel away";
  EXPECT_EQ(fault(3, [](Hit& hit) { hit.h -= 0.03; }), "1 wrong");
  EXPECT_EQ(fault(3, miss), "1 missed");
  EXPECT_EQ(fault(8, [](Hit& hit) { hit.status = HitStatus::hit; }), "1 false");
  EXPECT_EQ(fault(9, [](Hit& hit) { hit.status = HitStatus::hit; }), "1 wrong") << "inside is to be said";
  EXPECT_EQ(fault(9, miss), "1 missed") << "counted once";
  EXPECT_EQ(fault(9, [](Hit& hit) { hit.t = 1; }), "1 wrong") << "inside is at t = 0";
  EXPECT_EQ(fault(8, [](Hit& hit) { hit.sanitized = true; }), "1 NaN or Inf");
  EXPECT_EQ(fault(3, exhausted), "1 exhausted");
  EXPECT_EQ(fault(3, exhausted, FirstHit::always, true), "");
  EXPECT_EQ(fault(8, not_a_number), "1 NaN or Inf");
  EXPECT_EQ(fault(8, not_a_number, FirstHit::never), "1 NaN or Inf") << "whatever it claims";
  EXPECT_EQ(fault(3, miss, FirstHit::never), "");
  EXPECT_EQ(fault(3, miss, FirstHit::if_steps_under_texel), "");
}

TEST(HardCases, WhatOnlyTouchesAClipMapsDomainIsAmbiguous) {
  const HeightMap map = make_hard_map(HardMap{.kind = "constant", .width = 4, .height = 4}, AddressMode::clip);
  const std::vector<Ray> rays = {{0.5, 1.5, 1, 1, -1, -0.5},     // through the corner (1, 1)
                                 {0.5, 1.4999, 1, 1, -1, -0.5},  // a little inside
                                 {0.5, 1.6, 1, 1, -1, -0.5},     // past it
                                 {0.5, 0.5, 1, 0, 0, -1}};       // vertical
  std::vector<Hit> truth(rays.size());
  mark_domain_grazes(map, rays, truth);
  EXPECT_TRUE(truth[0].ambiguous);
  EXPECT_FALSE(truth[1].ambiguous || truth[2].ambiguous || truth[3].ambiguous);
}

}  // namespace
}  // namespace relievo::cli
