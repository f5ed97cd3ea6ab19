/// What pictures hold that are no colours: normals, and the steps and fetches of each pixel's ray.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/height_maps.hpp"
#include "support/pipeline.hpp"
#include "support/scenes.hpp"

namespace relievo::test {
namespace {

constexpr int extent = 32;  // texels a side

/// Rises by 1 / (extent - 1) a texel along u, or along v.
HeightMap ramp(bool along_v) {
  HeightMap map = ramp_map(extent, extent);
  for (int j = 0; along_v && j < extent; ++j) {
    for (int i = 0; i < extent; ++i)
      map.texels[static_cast<std::size_t>(j * extent + i)] = static_cast<float>(j) / (extent - 1);
  }
  return with_address(map, AddressMode::clamp);
}

TEST(AovNormal, OfARampIsThatOfItsPlane) {
  const Scene scene = make_scene(MeshKind::plane, 64);
  const Mesh mesh = mesh_of(scene);
  const double world_rise = static_cast<double>(scene.displacement.scale) * extent / (extent - 1) / scene.mesh.size;
  for (const bool along_v : {false, true}) {
    // The plane's u runs along x, its v along y.
    const double length = std::hypot(world_rise, 1.0);
    const std::array<double, 3> expected = {along_v ? 0 : -world_rise / length, along_v ? -world_rise / length : 0,
                                            1 / length};
    for (const auto& [stage, technique] :
         {std::pair("surface", "exact"), std::pair("prism", "exact"), std::pair("vertex", "")}) {
      for (const double source : {0.0, 1.0}) {  // the baked normals, and differences of heights
        for (const std::string& name : both_backends) {
          RenderRequest normals = request_of(stage, technique, Aov::normal);
          normals.values[std::string(stage) + ".normal_source"] = source;
          const Image image = render_on(name, scene, mesh, ramp(along_v), normals).image;
          const Image uv = render_on(name, scene, mesh, ramp(along_v), request_of(stage, technique, Aov::uv)).image;
          int judged = 0;
          double worst = 0;
          for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
            const double u = uv.pixels[i], v = uv.pixels[i + 1], margin = 2.0 / extent;  // where no border is read
            if (image.pixels[i + 3] == 0 || std::min(u, v) < margin || std::max(u, v) > 1 - margin) continue;
            ++judged;
            for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(image.pixels[i + c] - expected[c]));
          }
          EXPECT_GT(judged, 300);
          EXPECT_LT(worst, 1e-5) << fmt::format("{} on {}, source {}, along {}", stage, name, source, "uv"[along_v]);
        }
      }
    }
  }
}

/// The rays of a picture's pixels, as its fragments made them.
std::vector<Ray> rays_of(const Image& origins, const Image& directions) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < origins.pixels.size(); i += 4) {
    const float *o = &origins.pixels[i], *d = &directions.pixels[i];
    rays.push_back({o[0], o[1], o[2], d[0], d[1], d[2], d[3]});
  }
  return rays;
}

TEST(AovSteps, AreThoseOfATracedRay) {
  const Scene scene = make_scene(MeshKind::torus, 64);
  const Mesh mesh = mesh_of(scene);
  const HeightMap map = smooth_noise_map(48, 32);
  for (const std::string& name : both_backends) {
    for (const char* technique : {"relief", "exact"}) {
      const auto image_of = [&](Aov aov) {
        return render_on(name, scene, mesh, map, request_of("surface", technique, aov)).image;
      };
      const Image steps = image_of(Aov::steps);
      const std::vector<Ray> rays = rays_of(image_of(Aov::ray_origin), image_of(Aov::ray_direction));
      const std::vector<Hit> hits = trace_on(name, map, rays, request_of(technique));
      int judged = 0, same = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const float* pixel = &steps.pixels[4 * i];
        if (pixel[3] == 0) continue;
        ++judged;
        same += pixel[0] == static_cast<float>(hits[i].steps) && pixel[1] == static_cast<float>(hits[i].fetches);
      }
      EXPECT_GT(judged, 500) << technique << " on " << name;
      EXPECT_EQ(same, judged) << technique << " on " << name;
    }
  }
}

}  // namespace
}  // namespace relievo::test
