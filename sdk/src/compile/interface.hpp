/// What passes between the stages of a program: names that agree, and outputs that nobody reads.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <vector>

#include "compile/shader_module.hpp"

namespace relievo {

/// A stage and its neighbours in the program.
struct StageNeighbours {
  std::optional<ShaderStage> producer;  ///< the stage before
  std::optional<ShaderStage> consumer;  ///< the stage after
  std::set<int> unread_outputs;         ///< locations that this stage writes and the consumer does not read
};

/// Every input of a stage is an output of the stage before, of the same type. Error: "compile.interface", naming both.
Status check_interfaces(std::span<const ShaderModule> modules, std::string_view permutation_key);

/// One entry a module, in order. Stages follow each other as in `ShaderStage`.
std::vector<StageNeighbours> find_neighbours(std::span<const ShaderModule> modules);

/// Names every user varying after the stage that writes it and its location ("relievo_vertex_out_3"): GLSL 330 and
/// ESSL 300 match varyings by name. Vertex inputs and fragment outputs keep the author's names.
void rename_varyings(spirv_cross::Compiler& compiler, const ShaderModule& module, const StageNeighbours& neighbours);

/// A copy of the module's parsed form in which the outputs that nobody reads are private variables. Direct3D and Metal
/// link stages by the list of varyings, so both sides must list the same.
spirv_cross::ParsedIR hide_unread_outputs(const ShaderModule& module, const StageNeighbours& neighbours);

}  // namespace relievo
