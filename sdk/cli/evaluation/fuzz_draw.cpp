/// What a round of fuzzing tries.
#include <array>
#include <cmath>
#include <limits>

#include "evaluation/fuzz.hpp"

namespace relievo::cli {

namespace {

using synthetic::mix;
using synthetic::Random;

double log_uniform(Random& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

template <class List>
auto pick(Random& random, const List& list) {
  return list[static_cast<std::size_t>(random.below(static_cast<int>(std::size(list))))];
}

int draw_extent(Random& random) {
  constexpr std::array awkward = {1, 2, 3, 7, 16, 31, 32, 33};
  return random.below(2) ? pick(random, awkward) : 1 + random.below(48);
}

/// Heights where floats end and where comparisons with 0 and 1 tip.
float awkward_height(Random& random) {
  constexpr std::array<double, 10> heights = {0, 1, 0.5, 1e-45, 1e-39, 1.2e-38, 1e-7, 1 - 6e-8, 1 - 1e-7, 0.25};
  return static_cast<float>(pick(random, heights));
}

HeightMap draw_map(Random& random) {
  HardMap map;
  map.kind = pick(random, hard_map_kinds());
  map.width = draw_extent(random);
  map.height = draw_extent(random);
  map.value = random.uniform();
  map.along_v = random.below(2) == 1;
  map.period = 2 + random.below(8);
  map.steps = 1 + random.below(8);
  map.seed = random.below(1 << 20);
  constexpr std::array tops = {1.0, 1.0, 1.0, 1.0, 1.0, 0.5, 1e-3, 1e-6, 1e-39, 0.0};
  map.high = pick(random, tops);
  if (random.below(8) == 0) map.low = 0.9, map.high = 1;
  if (random.below(4) == 0) map.terraces = 1 + random.below(16);
  constexpr std::array modes = {AddressMode::repeat, AddressMode::mirror, AddressMode::clamp, AddressMode::clip};
  HeightMap result = make_hard_map(map, pick(random, modes));
  if (random.below(3) == 0) {
    for (float& texel : result.texels) {
      if (random.below(4) == 0) texel = awkward_height(random);
    }
  }
  return result;
}

/// What no ray should have, and what only a few have.
double awkward_number(Random& random) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double largest = std::numeric_limits<float>::max();
  constexpr std::array numbers = {0.0,     -0.0,     1.0,        -1.0,      0.5,
                                  1e-45,   -1e-45,   1e-38,      1e-20,     1e-7,
                                  -1e-7,   1e7,      -1e7,       1e20,      -1e20,
                                  largest, -largest, infinity,   1e300,     1e-300,
                                  0.03125, 2.0,      0.99999994, -infinity, std::numeric_limits<double>::quiet_NaN()};
  return pick(random, numbers);
}

Ray adversarial_ray(Random& random) {
  Ray ray{random.uniform(-1, 2), random.uniform(-1, 2), random.uniform(-0.2, 1.2),
          random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 1)};
  double* fields[] = {&ray.u, &ray.v, &ray.h, &ray.du, &ray.dv, &ray.dh, &ray.t_max};
  const int changed = 1 + random.below(7);
  for (int i = 0; i < changed; ++i) *pick(random, fields) = awkward_number(random);
  return ray;
}

void append_plausible(Random& random, const HeightMap& map, std::size_t count, std::vector<Ray>& rays) {
  HardRays kind;
  kind.kind = pick(random, hard_ray_kinds());
  kind.scale = log_uniform(random, 1e-2, 1e3);
  kind.angle = {log_uniform(random, 0.1, 80), 85};
  kind.offset = map.address == AddressMode::repeat || map.address == AddressMode::mirror ? 1e6 : 16;
  kind.seed = random.below(1 << 20);
  const std::vector<Ray> more = make_hard_rays(kind, map, static_cast<int>(count));
  rays.insert(rays.end(), more.begin(), more.end());
}

std::uint64_t seed_of(std::uint64_t seed, std::uint64_t round, std::string_view name) {
  std::uint64_t state = mix(mix(seed) ^ round);
  for (const char c : name) state = mix(state ^ static_cast<unsigned char>(c));
  return state;
}

double draw_value(Random& random, const Parameter& p) {
  if (p.name == "bits") return std::clamp(pick(random, std::array{8.0, 16.0, 32.0}), p.minimum, p.maximum);
  switch (random.below(6)) {
    case 0:
      return p.minimum;
    case 1:
      // The largest of a loop is there to be a bound; a hundredth of it is run, now and then.
      return p.is_loop && p.maximum > 4096 ? std::max(p.minimum, std::floor(p.maximum / 100)) : p.maximum;
    case 2:
    case 3:
      return p.value;
    default:
      break;
  }
  const bool spans_orders = p.minimum >= 0 && p.maximum > 100 * std::max(p.minimum, 1e-6);
  const double low = std::max(p.minimum, p.is_integer ? 1.0 : 1e-6);
  const double value = spans_orders ? log_uniform(random, low, p.maximum) : random.uniform(p.minimum, p.maximum);
  return std::clamp(p.is_integer ? std::round(value) : static_cast<double>(static_cast<float>(value)), p.minimum,
                    p.maximum);
}

}  // namespace

FuzzRound draw_round(std::uint64_t seed, std::uint64_t round, std::size_t rays) {
  Random random(seed_of(seed, round, "round"));
  FuzzRound result;
  result.map = draw_map(random);
  result.filter = random.below(4) == 0 ? HeightFilter::hardware : HeightFilter::exact;
  constexpr std::size_t kinds = 4;
  for (std::size_t i = 0; i < kinds; ++i) append_plausible(random, result.map, rays / (2 * kinds) + 1, result.rays);
  result.judged = result.rays.size();
  while (result.rays.size() < rays) result.rays.push_back(adversarial_ray(random));
  return result;
}

std::map<std::string, double> draw_values(const Registry& registry, const std::string& technique, std::uint64_t seed,
                                          std::uint64_t round) {
  Random random(seed_of(seed, round, technique));
  std::map<std::string, double> values;
  const auto draw = [&](const std::string& owner, const std::vector<Parameter>& parameters) {
    for (const Parameter& p : parameters) {
      // Axes stay at their defaults, or in every other round at what suits software drivers: their rules forbid some
      // combinations, and tests/conformance draws every value.
      if (p.choices.empty()) values[owner + "." + p.name] = draw_value(random, p);
      if (p.software_value) values[owner + "." + p.name] = round % 2 == 0 ? p.value : *p.software_value;
    }
  };
  draw("ray", registry.stages.at("ray").parameters);
  draw(technique, registry.techniques.at(technique).parameters);
  for (const std::string& map : registry.techniques.at(technique).maps) draw(map, registry.maps.at(map).parameters);
  return values;
}

}  // namespace relievo::cli
