/// Small composed programs, as the composer would make them, one for each shape of pipeline.
#pragma once

#include <string>

#include "relievo/compose.hpp"

namespace relievo::testing {

ComposedProgram make_program(std::vector<ComposedShader> shaders);

/// A compute program with `text` as its shader; `#version 450` and a work group of 64 are put in front.
ComposedProgram compute_program(const std::string& text);

/// A vertex shader that passes position and uv, and the given fragment shader.
ComposedProgram fragment_program(const std::string& text);

/// Marches rays of a buffer through a height map: storage buffers, a sampled map, loops, specialization constants, a
/// parameter block.
ComposedProgram ray_sample();

/// Vertex and fragment shaders with varyings of which one is not read, a 2D and a 3D map, explicit gradients, depth
/// write.
ComposedProgram surface_sample();

/// Vertex, geometry and fragment shaders, with a flat varying.
ComposedProgram prism_sample();

/// Vertex, both tessellation stages with a patch varying, and fragment.
ComposedProgram tessellation_sample();

/// Reads one storage image and writes another, in compute; uses the number of work groups and the size of an array.
ComposedProgram bake_sample();

}  // namespace relievo::testing
