/// Generators of rays that break ray tracers of height maps.
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "evaluation/hard_cases.hpp"
#include "evaluation/synthetic_maps.hpp"

namespace relievo::cli {

namespace {

using synthetic::Random;

/// What the generators of one case draw from.
struct Source {
  const HardRays& rays;
  const HeightMap& map;
  const Oracle& oracle;
  Random random;

  int extent(bool along_v) const { return along_v ? map.height : map.width; }
  double sign() { return random.below(2) ? 1.0 : -1.0; }
  double angle() { return random.uniform(rays.angle[0], rays.angle[1]) * std::numbers::pi / 180; }
  double heading() { return random.uniform(0, 2 * std::numbers::pi); }
  /// Beyond the map as well, but for a clip map, which has nothing there: rays of kind `side` come to it from outside.
  double anywhere() { return map.address == AddressMode::clip ? random.uniform() : random.uniform(-0.5, 1.5); }
  /// The centre of a texel, so a grid line of the bilinear cells; one or two lie outside.
  double line(bool along_v) {
    const int n = extent(along_v);
    return (random.below(n + 2) - 0.5) / n;
  }
  /// A texel's centre, its border, an edge of the map, or anywhere.
  double awkward(bool along_v) {
    const int n = extent(along_v);
    switch (random.below(4)) {
      case 0:
        return line(along_v);
      case 1:
        return static_cast<double>(random.below(n + 1)) / n;
      case 2:
        return random.below(3) / 2.0;
      default:
        return anywhere();
    }
  }
};

/// How far a ray falls over a length in the uv plane.
double fall(Source& s, double length) {
  return -length * std::tan(s.angle()) / s.rays.scale;
}

Ray heading_ray(Source& s, double u, double v, double h, double heading) {
  const double a = s.angle();
  return {u, v, h, std::cos(heading) * std::cos(a), std::sin(heading) * std::cos(a), -std::sin(a) / s.rays.scale};
}

Ray random_ray(Source& s) {
  const double u = s.anywhere(), v = s.anywhere();
  return heading_ray(s, u, v, 1, s.heading());
}

/// Axis-parallel: along u or along v.
Ray axis_ray(Source& s, double u, double v, bool along_v) {
  Ray ray{u, v, 1, 0, 0, fall(s, 1)};
  (along_v ? ray.dv : ray.du) = s.sign();
  return ray;
}

Ray grid_line_ray(Source& s) {
  const bool along_v = s.random.below(2) == 1;
  const double along = s.awkward(along_v), across = s.line(!along_v);
  return along_v ? axis_ray(s, across, along, true) : axis_ray(s, along, across, false);
}

Ray axis_parallel_ray(Source& s) {
  const double u = s.awkward(false), v = s.awkward(true);
  return axis_ray(s, u, v, s.random.below(2) == 1);
}

/// From a texel's centre over the centres of others.
Ray corner_ray(Source& s) {
  Ray ray{s.line(false), s.line(true), 1};
  ray.du = s.sign() * (1 + s.random.below(3)) / s.map.width;
  ray.dv = s.sign() * (1 + s.random.below(3)) / s.map.height;
  ray.dh = fall(s, std::hypot(ray.du, ray.dv));
  return ray;
}

Ray vertical_ray(Source& s) {
  Ray ray{s.awkward(false), s.awkward(true), 1, 0, 0, -1};
  if (s.random.below(4) == 0) ray.dh = -s.random.uniform(1e-3, 1e3);
  if (s.random.below(8) == 0) ray.h = s.random.uniform(-0.5, 1.5), ray.dh = s.sign();
  return ray;
}

/// Within the slab; as high as a texel, on the base or on the lid too.
Ray horizontal_ray(Source& s) {
  Ray ray{s.awkward(false), s.awkward(true), s.random.uniform(), 0, 0, 0};
  const int k = s.random.below(6);
  if (k == 0) ray.h = s.map.at(s.random.below(s.map.width), s.random.below(s.map.height));
  if (k == 1) ray.h = s.random.below(2);
  const double heading = s.heading();
  ray.du = std::cos(heading), ray.dv = std::sin(heading);
  if (s.random.below(4) == 0) ray.dv = 0;
  ray.t_max = s.random.uniform(0.1, 4);
  return ray;
}

/// As shadow rays: from within the slab to the lid.
Ray rising_ray(Source& s) {
  const double u = s.anywhere(), v = s.anywhere();
  Ray ray = heading_ray(s, u, v, s.random.uniform(), s.heading());
  ray.dh = -ray.dh;
  return ray;
}

/// Starts on the surface, at a texel's centre, where its height is a float.
Ray surface_ray(Source& s) {
  const int i = s.random.below(s.map.width), j = s.random.below(s.map.height);
  Ray ray = heading_ray(s, (i + 0.5) / s.map.width, (j + 0.5) / s.map.height, s.map.at(i, j), s.heading());
  if (s.random.below(3) == 0) ray.dh = -ray.dh;
  return ray;
}

/// Starts below the surface, or below the base.
Ray inside_ray(Source& s) {
  const double u = s.anywhere(), v = s.anywhere();
  const double h = sample_height(s.map, u, v);
  Ray ray = heading_ray(s, u, v, s.random.below(4) == 0 ? -s.random.uniform() : h * s.random.uniform(), s.heading());
  if (s.random.below(2) == 0) ray.dh = -ray.dh;
  return ray;
}

/// Starts above the lid; over the place where it enters it, or a little beside.
Ray above_ray(Source& s) {
  Ray ray = random_ray(s);
  const double back = s.random.uniform(0, 1 / std::max(1e-3, -ray.dh));
  ray.u -= back * ray.du, ray.v -= back * ray.dv, ray.h -= back * ray.dh;
  if (s.random.below(4) == 0) ray.h += s.random.uniform(0, 50);
  return ray;
}

/// Starts exactly on the lid, and runs along it, down, or away.
Ray lid_ray(Source& s) {
  const double u = s.awkward(false), v = s.awkward(true);
  Ray ray = heading_ray(s, u, v, 1, s.heading());
  const int k = s.random.below(4);
  if (k == 0) ray.dh = 0, ray.t_max = s.random.uniform(0, 4);
  if (k == 1) ray.dh = -ray.dh;
  return ray;
}

/// Ends a little before or behind where the surface is met.
Ray limited_ray(Source& s) {
  Ray ray = random_ray(s);
  const Hit hit = s.oracle.trace(ray);
  ray.t_max = hit.t * (1 + s.sign() * std::exp2(-s.random.uniform(1, 12)));
  return ray;
}

Ray far_ray(Source& s) {
  Ray ray = random_ray(s);
  ray.u += s.rays.offset, ray.v -= s.rays.offset;
  return ray;
}

/// Along the surface, a little above or below a point of it.
Ray tangent_ray(Source& s) {
  constexpr double step = 1e-4;
  const double u = s.random.uniform(), v = s.random.uniform(), heading = s.heading();
  const double du = std::cos(heading), dv = std::sin(heading);
  const double here = sample_height(s.map, u, v);
  const double slope = (sample_height(s.map, u + step * du, v + step * dv) - here) / step;
  const double back = s.random.uniform(0, 0.5), lift = s.sign() * std::exp2(-s.random.uniform(4, 15));
  Ray ray{u - back * du, v - back * dv, here - back * slope + lift, du, dv, slope};
  ray.t_max = 2 * back + s.random.uniform();
  return ray;
}

/// Any length of direction: t grows as the direction shrinks.
Ray long_or_short_ray(Source& s) {
  Ray ray = random_ray(s);
  const double size = std::exp2(s.random.uniform(-60, 60));
  ray.du *= size, ray.dv *= size, ray.dh *= size;
  return ray;
}

/// Through the frame of a triangle whose texture is sheared, mirrored or nearly without area: the direction by the
/// adjugate of its Jacobian.
Ray sheared_ray(Source& s) {
  const Ray world = random_ray(s);
  const double a = 1, b = s.random.uniform(-20, 20), c = s.random.uniform(-0.1, 0.1);
  const double d = s.sign() * std::exp2(-s.random.uniform(0, 12));
  Ray ray = world;
  ray.du = d * world.du - b * world.dv, ray.dv = a * world.dv - c * world.du;
  ray.dh = world.dh * (a * d - b * c);
  if (ray.dh > 0) ray.dh = -ray.dh;
  const double travel = std::hypot(ray.du, ray.dv);
  if (travel > 200 * -ray.dh) ray.dh = -travel / 200;
  return ray;
}

/// Starts on a side of the domain, or outside of it and heads for it.
Ray side_ray(Source& s) {
  const bool along_v = s.random.below(2) == 1;
  const double side = s.random.below(2), outside = s.random.below(2) ? s.random.uniform(0, 0.5) : 0.0;
  const double across = side > 0 ? 1 + outside : -outside, along = s.awkward(!along_v);
  Ray ray = heading_ray(s, along_v ? along : across, along_v ? across : along, s.random.uniform(), s.heading());
  double& towards = along_v ? ray.dv : ray.du;
  towards = side > 0 ? -std::abs(towards) : std::abs(towards);
  if (s.random.below(2) == 0) ray.h = 1;
  if (s.random.below(4) == 0) ray.dh = 0, ray.t_max = 4;
  return ray;
}

/// The same from tens of tiles away, where a float t tells places on the side apart by a hundredth of a texel.
Ray distant_side_ray(Source& s) {
  Ray ray = side_ray(s);
  const double back = s.random.uniform(20, 60);
  ray.u -= back * ray.du, ray.v -= back * ray.dv, ray.h -= back * ray.dh;
  if (ray.dh == 0) ray.t_max += back;
  return ray;
}

/// A hair before a side and hardly towards it: it runs along the side, which yet decides where it enters.
Ray along_side_ray(Source& s) {
  const bool along_v = s.random.below(2) == 1;
  const bool at_one = s.random.below(2) == 1;
  const double hair = (1 + s.random.below(8)) * (at_one ? 0x1p-23 : 0x1p-25 / s.extent(!along_v));
  const double across = at_one ? 1 + hair : -hair;
  Ray ray = axis_ray(s, along_v ? across : s.awkward(false), along_v ? s.awkward(true) : across, along_v);
  ray.h = s.random.uniform();
  (along_v ? ray.du : ray.dv) = (at_one ? -hair : hair) / s.random.uniform(0.1, 2);
  return ray;
}

struct RayKind {
  std::string_view name;
  Ray (*make)(Source&);
};

constexpr std::array kinds = {RayKind{"above", above_ray},
                              RayKind{"along_side", along_side_ray},
                              RayKind{"axis_parallel", axis_parallel_ray},
                              RayKind{"corner", corner_ray},
                              RayKind{"distant_side", distant_side_ray},
                              RayKind{"far", far_ray},
                              RayKind{"grid_line", grid_line_ray},
                              RayKind{"horizontal", horizontal_ray},
                              RayKind{"inside", inside_ray},
                              RayKind{"lid", lid_ray},
                              RayKind{"limited", limited_ray},
                              RayKind{"any_length", long_or_short_ray},
                              RayKind{"random", random_ray},
                              RayKind{"rising", rising_ray},
                              RayKind{"sheared", sheared_ray},
                              RayKind{"side", side_ray},
                              RayKind{"surface", surface_ray},
                              RayKind{"tangent", tangent_ray},
                              RayKind{"vertical", vertical_ray}};

/// As job/trace_job.cpp splits it.
double tile_of(double coordinate, AddressMode address) {
  if (address == AddressMode::repeat) return std::floor(coordinate);
  if (address == AddressMode::mirror) return 2 * std::floor(coordinate / 2);
  return 0;
}

double rounded(double x) {
  return static_cast<double>(static_cast<float>(x));
}

}  // namespace

std::vector<std::string_view> hard_ray_kinds() {
  std::vector<std::string_view> names;
  for (const RayKind& kind : kinds) names.push_back(kind.name);
  return names;
}

Ray as_shader_sees(Ray ray, AddressMode address) {
  for (double* coordinate : {&ray.u, &ray.v}) {
    const double tile = tile_of(*coordinate, address);
    *coordinate = tile + rounded(*coordinate - tile);
  }
  for (double* number : {&ray.h, &ray.du, &ray.dv, &ray.dh, &ray.t_max}) *number = rounded(*number);
  return ray;
}

std::vector<Ray> make_hard_rays(const HardRays& rays, const HeightMap& map, int count) {
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const RayKind& k) { return k.name == rays.kind; });
  if (kind == kinds.end()) throw std::logic_error("ray kinds are checked when a case is read");
  const Oracle oracle(map);
  Source source{rays, map, oracle, Random(static_cast<std::uint64_t>(rays.seed))};
  std::vector<Ray> list;
  list.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) list.push_back(as_shader_sees(kind->make(source), map.address));
  return list;
}

}  // namespace relievo::cli
