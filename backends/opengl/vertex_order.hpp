/// The winding of tessellated triangles.
#pragma once

#include <string>
#include <string_view>

namespace relievo::opengl {

/// Vulkan puts the origin of the tessellation domain at its upper left and OpenGL at its lower left, so `cw` and `ccw`
/// mean the opposite; SPIRV-Cross copies the word. Returns the source of a tessellation evaluation shader with the
/// words exchanged in its input layouts, so that OpenGL makes the triangles that Vulkan makes.
std::string exchange_vertex_order(std::string_view source);

}  // namespace relievo::opengl
