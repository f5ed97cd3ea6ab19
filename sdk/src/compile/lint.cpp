#include "compile/lint.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <spirv_cross/spirv.hpp>

namespace relievo {

namespace {

using Id = std::uint32_t;

struct Place {
  Id file = 0;
  int line = 0;
};

/// An instruction that takes derivatives, and where its author wrote it.
struct Derivative {
  std::string_view name;
  Place place;
};

struct Block {
  std::vector<Id> successors;
  Id loop_merge = 0;  ///< of a loop header; 0 otherwise
  std::vector<Derivative> derivatives;
  std::vector<Id> calls;
};

struct Function {
  Id first_block = 0;
  std::map<Id, Block> blocks;
};

struct Module {
  std::map<Id, std::string> strings;
  std::map<Id, Function> functions;
};

/// The GLSL name of what takes derivatives; empty for everything else.
std::string_view derivative_name(std::uint32_t opcode) {
  switch (opcode) {
    case spv::OpImageSampleImplicitLod:
    case spv::OpImageSampleDrefImplicitLod:
    case spv::OpImageSparseSampleImplicitLod:
    case spv::OpImageSparseSampleDrefImplicitLod:
      return "texture";
    case spv::OpImageSampleProjImplicitLod:
    case spv::OpImageSampleProjDrefImplicitLod:
      return "textureProj";
    case spv::OpImageQueryLod:
      return "textureQueryLod";
    case spv::OpDPdx:
    case spv::OpDPdxFine:
    case spv::OpDPdxCoarse:
      return "dFdx";
    case spv::OpDPdy:
    case spv::OpDPdyFine:
    case spv::OpDPdyCoarse:
      return "dFdy";
    case spv::OpFwidth:
    case spv::OpFwidthFine:
    case spv::OpFwidthCoarse:
      return "fwidth";
    default:
      return {};
  }
}

/// Reads what the lint needs of a module, in one pass.
class Reader {
 public:
  Module read(const SpirvWords& words) {
    for_each_instruction(words, [this](const SpirvInstruction& i) { visit(i.opcode, i.operands); });
    return std::move(module_);
  }

 private:
  void visit(std::uint32_t opcode, std::span<const std::uint32_t> operands) {
    switch (opcode) {
      case spv::OpString:
        module_.strings[operands[0]] = spirv_string(operands.subspan(1));
        break;
      case spv::OpLine:
        place_ = {operands[0], static_cast<int>(operands[1])};
        break;
      case spv::OpNoLine:
        place_ = {};
        break;
      case spv::OpFunction:
        function_ = &module_.functions[operands[1]];
        break;
      case spv::OpFunctionEnd:
        function_ = nullptr;
        block_ = nullptr;
        break;
      case spv::OpLabel:
        open_block(operands[0]);
        break;
      default:
        if (block_ != nullptr) visit_body(opcode, operands);
    }
  }

  void open_block(Id label) {
    if (function_->first_block == 0) function_->first_block = label;
    block_ = &function_->blocks[label];
  }

  void visit_body(std::uint32_t opcode, std::span<const std::uint32_t> operands) {
    switch (opcode) {
      case spv::OpLoopMerge:
        block_->loop_merge = operands[0];
        break;
      case spv::OpBranch:
        block_->successors = {operands[0]};
        break;
      case spv::OpBranchConditional:
        block_->successors = {operands[1], operands[2]};
        break;
      case spv::OpSwitch:  // selector, default, then (32-bit literal, label) pairs
        block_->successors = {operands[1]};
        for (std::size_t i = 3; i < operands.size(); i += 2) block_->successors.push_back(operands[i]);
        break;
      case spv::OpFunctionCall:
        block_->calls.push_back(operands[2]);
        break;
      default:
        if (const std::string_view name = derivative_name(opcode); !name.empty()) {
          block_->derivatives.push_back({name, place_});
        }
    }
  }

  Module module_;
  Function* function_ = nullptr;
  Block* block_ = nullptr;
  Place place_;
};

/// The loop's blocks: all that its header reaches without passing its merge block.
std::set<Id> loop_blocks(const Function& function, Id header) {
  const Id merge = function.blocks.at(header).loop_merge;
  std::set<Id> inside;
  std::vector<Id> open = {header};
  while (!open.empty()) {
    const Id label = open.back();
    open.pop_back();
    if (label == merge || !inside.insert(label).second) continue;
    const auto block = function.blocks.find(label);
    if (block == function.blocks.end()) continue;
    open.insert(open.end(), block->second.successors.begin(), block->second.successors.end());
  }
  return inside;
}

std::set<Id> blocks_in_loops(const Function& function) {
  std::set<Id> inside;
  for (const auto& [label, block] : function.blocks) {
    if (block.loop_merge != 0) inside.merge(loop_blocks(function, label));
  }
  return inside;
}

/// Finds the first derivative of a block, or of any function that it calls, directly or not.
std::optional<Derivative> find_derivative(const Module& module, const Block& block, std::set<Id>& visited) {
  if (!block.derivatives.empty()) return block.derivatives.front();
  for (const Id callee : block.calls) {
    const auto function = module.functions.find(callee);
    if (function == module.functions.end() || !visited.insert(callee).second) continue;
    for (const auto& [label, inner] : function->second.blocks) {
      if (auto found = find_derivative(module, inner, visited)) return found;
    }
  }
  return std::nullopt;
}

}  // namespace

Status lint_implicit_lod_in_loop(const SpirvWords& words, std::string_view permutation_key) {
  const Module module = Reader().read(words);
  std::set<Id> visited;
  for (const auto& [id, function] : module.functions) {
    for (const Id label : blocks_in_loops(function)) {
      const auto found = find_derivative(module, function.blocks.at(label), visited);
      if (!found) continue;
      const auto file = module.strings.find(found->place.file);
      return fail(
          ErrorCode::compile, "lint.implicit-lod-in-loop",
          fmt::format("'{}' takes derivatives inside a loop, which Direct3D's compiler unrolls; use an explicit "
                      "LOD or gradients (permutation '{}')",
                      found->name, permutation_key),
          file == module.strings.end() ? std::string() : file->second, found->place.line);
    }
  }
  return {};
}

}  // namespace relievo
