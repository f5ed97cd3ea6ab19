/// The parts of validate_job(); each reports into a Check.
#pragma once

#include "job/check.hpp"
#include "relievo/job.hpp"

namespace relievo {

void check_program(Check& check, const ShaderProgram& program);
void check_buffer(Check& check, const Buffer& buffer);
void check_texture(Check& check, const Texture& texture);
/// Programs, buffers and textures must have passed their checks.
void check_command(Check& check, const Job& job, const Dispatch& dispatch);
void check_command(Check& check, const Job& job, const Draw& draw);

/// Whether `index` is a position in `list`.
template <class T>
bool in_range(int index, const std::vector<T>& list) {
  return index >= 0 && static_cast<std::size_t>(index) < list.size();
}

inline bool is_compute(const ShaderProgram& program) {
  return program.shaders.front().stage == ShaderStage::compute;
}

}  // namespace relievo
