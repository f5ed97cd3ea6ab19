#include "relievo/oracle.hpp"

#include <atomic>
#include <system_error>
#include <thread>

#include "oracle/walk.hpp"

namespace relievo {

std::string_view to_string(HitStatus status) {
  switch (status) {
    case HitStatus::miss:
      return "miss";
    case HitStatus::hit:
      return "hit";
    case HitStatus::exhausted:
      return "exhausted";
    case HitStatus::inside:
      return "inside";
    case HitStatus::outside:
      return "outside";
  }
  return "unknown";
}

struct Oracle::Impl {
  Impl(const HeightMap& map, OracleOptions given) : lattice(map), pyramid(lattice), options(given) {}

  oracle::Lattice lattice;
  oracle::MaxPyramid pyramid;
  OracleOptions options;
};

namespace {

/// Few enough for the threads to end together, many enough that the shared counter costs nothing.
constexpr std::size_t rays_per_chunk = 512;

std::size_t thread_count(unsigned wanted, std::size_t chunks) {
  const std::size_t threads = wanted ? wanted : std::max(1u, std::thread::hardware_concurrency());
  return std::clamp<std::size_t>(chunks, 1, threads);
}

}  // namespace

Oracle::Oracle(const HeightMap& map, OracleOptions options) : impl_(new Impl(map, options)) {}

Oracle::~Oracle() {
  delete impl_;
}

Oracle::Oracle(Oracle&& other) noexcept : impl_(std::exchange(other.impl_, nullptr)) {}

Oracle& Oracle::operator=(Oracle&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

Hit Oracle::trace(const Ray& ray) const {
  return oracle::find_first_hit(impl_->lattice, &impl_->pyramid, impl_->options, ray);
}

std::vector<Hit> Oracle::trace(std::span<const Ray> rays) const {
  std::vector<Hit> hits(rays.size());
  const std::size_t chunks = (rays.size() + rays_per_chunk - 1) / rays_per_chunk;
  std::atomic<std::size_t> next_chunk = 0;
  const auto work = [&] {
    for (std::size_t chunk = next_chunk++; chunk < chunks; chunk = next_chunk++) {
      const std::size_t end = std::min(rays.size(), (chunk + 1) * rays_per_chunk);
      for (std::size_t i = chunk * rays_per_chunk; i < end; ++i) hits[i] = trace(rays[i]);
    }
  };
  std::vector<std::thread> helpers;
  try {
    for (std::size_t i = 1; i < thread_count(impl_->options.threads, chunks); ++i) helpers.emplace_back(work);
  } catch (const std::system_error&) {  // no more threads to be had: those there are do the work
  }
  work();
  for (std::thread& helper : helpers) helper.join();
  return hits;
}

}  // namespace relievo
