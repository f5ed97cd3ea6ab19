/// Mesh attributes as GLM vectors in double, for geometry that must not lose bits.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace relievo {

inline glm::dvec3 to_double(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}
inline glm::dvec2 to_double(const std::array<float, 2>& v) {
  return {v[0], v[1]};
}

inline std::array<float, 3> to_float(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline std::array<float, 2> to_float(const glm::dvec2& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y)};
}

/// Twice the signed area of a triangle in texture space.
inline double cross2(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace relievo
