/// The values of our descriptors' axes, drawn and traced on both backends.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "support/height_maps.hpp"
#include "support/linear_claims.hpp"
#include "support/pipeline.hpp"
#include "support/scenes.hpp"

namespace relievo::test {
namespace {

/// Heights that 16 bits hold exactly.
HeightMap hills_of_16_bits() {
  HeightMap map = smooth_noise_map(48, 32);
  for (float& height : map.texels) height = static_cast<float>(std::lround(height * 65535.0f)) / 65535.0f;
  return map;
}

RenderRequest request_with(const std::string& stage, const std::map<std::string, double>& values) {
  RenderRequest request;
  request.stage = stage;
  request.technique = stage == "vertex" ? "" : "relief";
  request.filter = HeightFilter::exact;
  request.values = values;
  return request;
}

std::vector<std::uint8_t> draw(const std::string& backend, const std::string& stage,
                               const std::map<std::string, double>& values) {
  const Scene scene = make_scene(MeshKind::plane);
  return render_on(backend, scene, mesh_of(scene), hills_of_16_bits(), request_with(stage, values)).color;
}

TEST(Axes, EveryHeightFormatGivesTheSamePicture) {
  for (const std::string& backend : both_backends) {
    const auto red = draw(backend, "surface", {});
    EXPECT_EQ(draw(backend, "surface", {{"height.format", 1}}), red) << "alpha on " << backend;
    EXPECT_GE(compare_images(draw(backend, "surface", {{"height.format", 2}}), red).within_percent, 99.9)
        << "red_green on " << backend;
  }
}

TEST(Axes, EveryHeightFormatGivesTheSameHits) {
  const HeightMap map = hills_of_16_bits();
  const std::vector<Ray> rays = bounded_rays(map, 2000, 7);
  for (const std::string& backend : both_backends) {
    const std::vector<Hit> red = trace_on(backend, map, rays, request_of("exact"));
    for (const double format : {1.0, 2.0}) {
      const std::vector<Hit> hits = trace_on(backend, map, rays, request_of("exact", {{"height.format", format}}));
      std::size_t apart = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        // Two bytes are put together with one rounding: enough to tip rays that graze.
        if (hits[i].status != red[i].status || std::abs(hits[i].h - red[i].h) > 1e-5) ++apart;
      }
      EXPECT_LE(apart, format == 1.0 ? 0u : 2u) << backend << ", format " << format;
    }
  }
}

std::size_t count_different(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  EXPECT_EQ(a.size(), b.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    different +=
        std::tie(a[i].status, a[i].t, a[i].u, a[i].v, a[i].h) != std::tie(b[i].status, b[i].t, b[i].u, b[i].v, b[i].h);
  }
  return different;
}

/// Heights are the same however they come, so hits are the same in every bit; past every kind of border.
TEST(Axes, GatheredHeightsGiveTheSameHits) {
  for (const AddressMode mode : all_address_modes) {
    for (const HeightMap& map :
         {with_address(white_noise_map(7, 13), mode), with_address(white_noise_map(1, 9), mode)}) {
      const std::vector<Ray> rays = bounded_rays(map, 2000, 11);
      for (const std::string& backend : both_backends) {
        for (const std::string technique : {"relief", "exact"}) {
          for (const double format : {0.0, 1.0, 2.0}) {
            const auto hits = [&](double fetch) {
              return trace_on(backend, map, rays,
                              request_of(technique, {{"height.format", format}, {"height.fetch", fetch}}));
            };
            EXPECT_EQ(count_different(hits(0), hits(1)), 0u) << technique << " with " << to_string(mode) << ", "
                                                             << map.width << " wide, on " << backend << ", " << format;
          }
        }
      }
    }
  }
}

/// The same texels, so the same hits in every bit.
TEST(Axes, AMapReadAsAnImageGivesTheSameHits) {
  for (const AddressMode mode : all_address_modes) {
    const HeightMap map = with_address(white_noise_map(7, 13), mode);
    const std::vector<Ray> rays = bounded_rays(map, 2000, 13);
    for (const std::string& backend : both_backends) {
      const auto hits = [&](double fetch) {
        return trace_on(backend, map, rays, request_of("quadrant_maxima", {{"quadrant_maxima.fetch", fetch}}));
      };
      EXPECT_EQ(count_different(hits(0), hits(1)), 0u) << to_string(mode) << " on " << backend;
    }
  }
}

/// Rays and hits are the same words in images; numbers of rays that fill no row, one row, and more; counted and not.
TEST(Axes, RaysInImagesGiveTheSameHits) {
  const HeightMap map = white_noise_map(7, 13);
  for (const std::string& backend : both_backends) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{64}, std::size_t{4097}}) {
      const std::vector<Ray> rays = bounded_rays(map, static_cast<int>(count), 17);
      for (const bool count_cost : {false, true}) {
        const auto hits = [&](double storage) {
          TraceRequest request = request_of("exact", {{"ray.storage", storage}});
          request.count_cost = count_cost;
          return trace_on(backend, map, rays, request);
        };
        const std::vector<Hit> buffers = hits(0), images = hits(1);
        EXPECT_EQ(count_different(buffers, images), 0u) << count << " rays on " << backend;
        EXPECT_EQ(buffers.back().steps > 0, count_cost) << count << " rays on " << backend;
        EXPECT_EQ(buffers.back().steps, images.back().steps);
        EXPECT_EQ(buffers.back().fetches, images.back().fetches);
      }
    }
  }
}

TEST(Axes, NormalsFromHeightsAreThoseOfTheMap) {
  for (const std::string stage : {"surface", "prism", "vertex"}) {
    for (const std::string& backend : both_backends) {
      const auto by_map = draw(backend, stage, {});
      const auto by_height = draw(backend, stage, {{stage + ".normal_source", 1}});
      ASSERT_EQ(by_map.size(), by_height.size());
      std::size_t far = 0, drawn = 0;
      for (std::size_t i = 0; i < by_map.size(); i += 4) {
        if (by_map[i + 3] == 0) continue;
        ++drawn;
        far += std::abs(by_map[i] - by_height[i]) > 8;
      }
      EXPECT_GT(drawn, 3000u);
      // Baked normals are interpolated after they are made unit vectors, differences before: close, and not the same.
      EXPECT_LT(static_cast<double>(far), 0.02 * static_cast<double>(drawn)) << stage << " on " << backend;
      EXPECT_NE(by_map, by_height) << stage << " on " << backend << ": the axis does nothing";
    }
  }
}

TEST(Axes, APictureWithoutDepthWritesIsTheSameOnALonePlane) {
  for (const std::string& backend : both_backends) {
    EXPECT_EQ(draw(backend, "surface", {{"surface.depth_write", 1}}), draw(backend, "surface", {})) << backend;
  }
}

}  // namespace
}  // namespace relievo::test
