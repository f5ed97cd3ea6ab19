#include "oracle/lattice.hpp"

namespace relievo::oracle {
namespace {

int cell_count(int extent, AddressMode mode) {
  if (mode == AddressMode::repeat) return extent;
  if (mode == AddressMode::mirror) return 2 * extent;
  return extent + 1;
}

LatticeAxis make_axis(int extent, AddressMode mode, std::size_t stride) {
  LatticeAxis axis;
  axis.extent = extent;
  axis.cells = cell_count(extent, mode);
  axis.periodic = mode == AddressMode::repeat || mode == AddressMode::mirror;
  const int first_line = axis.periodic ? 0 : -1;
  for (int line = 0; line <= axis.cells; ++line)
    axis.offset.push_back(static_cast<std::size_t>(wrap_texel(first_line + line, extent, mode)) * stride);
  return axis;
}

float valid_height(float h) {
  return h >= 0 ? std::min(h, 1.0f) : 0.0f;
}

}  // namespace

Lattice::Lattice(const HeightMap& map)
    : address_(map.address),
      x_(make_axis(std::max(map.width, 1), map.address, 1)),
      y_(make_axis(std::max(map.height, 1), map.address, static_cast<std::size_t>(x_.extent))),
      texels_(map.texels) {
  texels_.resize(static_cast<std::size_t>(x_.extent) * static_cast<std::size_t>(y_.extent));
  std::transform(texels_.begin(), texels_.end(), texels_.begin(), valid_height);
}

}  // namespace relievo::oracle
