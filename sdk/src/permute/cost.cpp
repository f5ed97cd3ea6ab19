#include "permute/cost.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <spirv_cross/spirv.hpp>
#include <unordered_map>

namespace relievo {

namespace {

using Json = nlohmann::ordered_json;
using Id = std::uint32_t;

/// An instruction with what identifies it.
struct Node {
  std::uint32_t opcode = 0;
  std::vector<std::uint32_t> operands;  // after the result type and the result
};

/// A loop in a function's text: blocks from its header to its merge block.
struct Loop {
  Id merge = 0;
  std::size_t first = 0, last = 0;  // positions of its instructions in the function
};

struct Function {
  std::vector<Id> parameters;
  std::vector<SpirvInstruction> instructions;
};

std::optional<double> multiply(std::optional<double> a, std::optional<double> b) {
  if (a && b) return *a * *b;
  return std::nullopt;
}

bool is_fetch(std::uint32_t opcode) {
  switch (opcode) {
    case spv::OpImageSampleImplicitLod:
    case spv::OpImageSampleExplicitLod:
    case spv::OpImageSampleDrefImplicitLod:
    case spv::OpImageSampleDrefExplicitLod:
    case spv::OpImageSampleProjImplicitLod:
    case spv::OpImageSampleProjExplicitLod:
    case spv::OpImageFetch:
    case spv::OpImageGather:
    case spv::OpImageDrefGather:
    case spv::OpImageRead:
      return true;
    default:
      return false;
  }
}

bool has_no_typed_result(std::uint32_t opcode) {
  if (opcode >= spv::OpTypeVoid && opcode <= spv::OpTypeForwardPointer) return true;
  switch (opcode) {
    case spv::OpExtInstImport:
    case spv::OpLabel:
    case spv::OpStore:
    case spv::OpBranch:
    case spv::OpBranchConditional:
    case spv::OpSwitch:
    case spv::OpLoopMerge:
    case spv::OpSelectionMerge:
    case spv::OpReturn:
    case spv::OpReturnValue:
    case spv::OpKill:
    case spv::OpUnreachable:
    case spv::OpFunctionEnd:
    case spv::OpImageWrite:
    case spv::OpCopyMemory:
    case spv::OpName:
    case spv::OpMemberName:
    case spv::OpDecorate:
    case spv::OpMemberDecorate:
    case spv::OpEntryPoint:
    case spv::OpExecutionMode:
    case spv::OpCapability:
    case spv::OpMemoryModel:
    case spv::OpSource:
    case spv::OpExtension:
      return true;
    default:
      return false;
  }
}

/// A shader's module, read for its loops and fetches.
class CostReader {
 public:
  CostReader(const ComposedProgram& program, const SpirvWords& words) : program_(program) {
    for_each_instruction(words, [&](const SpirvInstruction& instruction) { read(instruction); });
    for (const auto& [id, function] : functions_) {
      for (const SpirvInstruction& instruction : function.instructions) {
        if (instruction.opcode == spv::OpStore) stores_[instruction.operands[0]].push_back(instruction.operands[1]);
      }
    }
  }

  Json describe(ShaderStage stage) {
    std::size_t instructions = 0, fetches = 0;
    for (const auto& [id, function] : functions_) {
      instructions += function.instructions.size();
      fetches += static_cast<std::size_t>(
          std::count_if(function.instructions.begin(), function.instructions.end(),
                        [](const SpirvInstruction& instruction) { return is_fetch(instruction.opcode); }));
    }
    const std::optional<double> bound = fetch_bound(entry_, {}, 0);
    Json loops = Json::array();
    for (const Json& loop : loops_) loops.push_back(loop);
    return {{"stage", to_string(stage)},
            {"instructions", instructions},
            {"fetches", fetches},
            {"loop_bounds", std::move(loops)},
            {"fetch_bound", bound ? Json(*bound) : Json(nullptr)}};
  }

 private:
  /// What the parameters of a function stand for where it is called.
  using Arguments = std::unordered_map<Id, std::optional<double>>;

  static constexpr int deepest_call = 32;

  void read(const SpirvInstruction& instruction) {
    const auto& operands = instruction.operands;
    switch (instruction.opcode) {
      case spv::OpEntryPoint:
        entry_ = operands[1];
        return;
      case spv::OpFunction:
        current_ = operands[1];
        functions_[current_];
        return;
      case spv::OpFunctionEnd:
        current_ = 0;
        return;
      case spv::OpDecorate:
        if (operands.size() == 3 && operands[1] == spv::DecorationDescriptorSet) sets_[operands[0]] = operands[2];
        if (operands.size() == 3 && operands[1] == spv::DecorationBinding) bindings_[operands[0]] = operands[2];
        return;
      case spv::OpMemberDecorate:
        if (operands.size() == 4 && operands[2] == spv::DecorationOffset)
          offsets_[{operands[0], operands[1]}] = operands[3];
        return;
      case spv::OpFunctionParameter:
        functions_[current_].parameters.push_back(operands[1]);
        return;
      default:
        break;
    }
    if (current_ != 0) functions_[current_].instructions.push_back(instruction);
    if (instruction.opcode == spv::OpTypePointer && operands.size() == 3) pointees_[operands[0]] = operands[2];
    if (has_no_typed_result(instruction.opcode) || operands.size() < 2) return;
    nodes_[operands[1]] = {instruction.opcode, {operands.begin() + 2, operands.end()}};
    types_[operands[1]] = operands[0];
  }

  const Node* node(Id id) const {
    const auto found = nodes_.find(id);
    return found == nodes_.end() ? nullptr : &found->second;
  }

  /// The default of the member of the Parameters block (set 0, binding 0) at this offset.
  std::optional<double> uniform_value(Id variable, Id member_index) const {
    const auto set = sets_.find(variable), binding = bindings_.find(variable);
    if (set == sets_.end() || binding == bindings_.end() || set->second != 0 || binding->second != 0)
      return std::nullopt;
    const auto pointer = types_.find(variable);
    const auto block = pointer == types_.end() ? pointees_.end() : pointees_.find(pointer->second);
    const std::optional<double> member = value(member_index, {}, 0);
    if (block == pointees_.end() || !member) return std::nullopt;
    const auto offset = offsets_.find({block->second, static_cast<std::uint32_t>(*member)});
    if (offset == offsets_.end()) return std::nullopt;
    for (const ParameterSlot& slot : program_.parameters) {
      if (slot.offset == static_cast<int>(offset->second)) return slot.default_value;
    }
    return std::nullopt;
  }

  std::optional<double> pointed_value(Id pointer, const Arguments& arguments, int depth) const {
    if (const auto argument = arguments.find(pointer); argument != arguments.end()) return argument->second;
    const Node* source = node(pointer);
    if (!source) return std::nullopt;
    if (source->opcode == spv::OpAccessChain && source->operands.size() == 2)
      return uniform_value(source->operands[0], source->operands[1]);
    const auto stored = stores_.find(pointer);
    if (source->opcode != spv::OpVariable || stored == stores_.end() || stored->second.size() != 1) return std::nullopt;
    return value(stored->second.front(), arguments, depth + 1);
  }

  /// What an integer is, where that can be read off the text.
  std::optional<double> value(Id id, const Arguments& arguments, int depth) const {
    if (depth > deepest_call) return std::nullopt;
    if (const auto argument = arguments.find(id); argument != arguments.end()) return argument->second;
    const Node* source = node(id);
    if (!source) return std::nullopt;
    const auto operand = [&](std::size_t i) { return value(source->operands[i], arguments, depth + 1); };
    switch (source->opcode) {
      case spv::OpConstant:
      case spv::OpSpecConstant:
        return static_cast<double>(static_cast<std::int32_t>(source->operands[0]));
      case spv::OpLoad:
        return pointed_value(source->operands[0], arguments, depth + 1);
      case spv::OpCopyObject:
        return operand(0);
      case spv::OpIAdd:
      case spv::OpISub: {
        const auto a = operand(0), b = operand(1);
        if (!a || !b) return std::nullopt;
        return source->opcode == spv::OpIAdd ? *a + *b : *a - *b;
      }
      case spv::OpIMul:
        return multiply(operand(0), operand(1));
      default:
        return std::nullopt;
    }
  }

  /// `i` of a loop that counts from a constant up by a constant: where it starts and its step.
  std::optional<std::pair<double, double>> counter(Id loaded, const Arguments& arguments) const {
    const Node* load = node(loaded);
    if (!load || load->opcode != spv::OpLoad) return std::nullopt;
    const auto stored = stores_.find(load->operands[0]);
    if (stored == stores_.end() || stored->second.size() != 2) return std::nullopt;
    std::optional<double> start, step;
    for (const Id id : stored->second) {
      const Node* source = node(id);
      if (source && source->opcode == spv::OpIAdd && is_load_of(source->operands[0], load->operands[0])) {
        step = value(source->operands[1], arguments, 0);
      } else {
        start = value(id, arguments, 0);
      }
    }
    if (!start || !step || *step <= 0) return std::nullopt;
    return std::pair(*start, *step);
  }

  bool is_load_of(Id id, Id variable) const {
    const Node* load = node(id);
    return load && load->opcode == spv::OpLoad && load->operands[0] == variable;
  }

  /// How often a condition can hold at the top of a loop.
  std::optional<double> trips(Id condition, const Arguments& arguments, int depth = 0) const {
    const Node* test = node(condition);
    if (!test || depth > deepest_call) return std::nullopt;
    if (test->opcode == spv::OpLogicalAnd) {
      const auto a = trips(test->operands[0], arguments, depth + 1), b = trips(test->operands[1], arguments, depth + 1);
      return a && b ? std::optional(std::min(*a, *b)) : a ? a : b;
    }
    const bool closed = test->opcode == spv::OpSLessThanEqual || test->opcode == spv::OpULessThanEqual;
    if (!closed && test->opcode != spv::OpSLessThan && test->opcode != spv::OpULessThan) return std::nullopt;
    const auto count = counter(test->operands[0], arguments);
    const auto limit = value(test->operands[1], arguments, 0);
    if (!count || !limit) return std::nullopt;
    return std::max(0.0, std::ceil((*limit + (closed ? 1 : 0) - count->first) / count->second));
  }

  /// The least bound that any way out of the loop at its own level gives: `for (i < n)` with `if (…) break` inside.
  std::optional<double> loop_bound(const Function& function, const Loop& loop, const Arguments& arguments) const {
    std::optional<double> least;
    for (std::size_t i = loop.first; i < loop.last; ++i) {
      const SpirvInstruction& instruction = function.instructions[i];
      if (instruction.opcode != spv::OpBranchConditional || instruction.operands[2] != loop.merge) continue;
      const auto bound = trips(instruction.operands[0], arguments);
      if (bound && (!least || *bound < *least)) least = bound;
    }
    return least;
  }

  static std::vector<Loop> loops_of(const Function& function) {
    std::vector<Loop> open, all;
    std::size_t block = 0;
    for (std::size_t i = 0; i < function.instructions.size(); ++i) {
      const SpirvInstruction& instruction = function.instructions[i];
      if (instruction.opcode == spv::OpLabel) {
        block = i;
        while (!open.empty() && open.back().merge == instruction.operands[0]) {
          open.back().last = i;
          all.push_back(open.back());
          open.pop_back();
        }
      }
      if (instruction.opcode == spv::OpLoopMerge) open.push_back({instruction.operands[0], block, 0});
    }
    return all;
  }

  std::optional<double> call_bound(const SpirvInstruction& call, const Arguments& arguments, int depth) {
    const auto callee = functions_.find(call.operands[2]);
    if (callee == functions_.end() || depth > deepest_call) return std::nullopt;
    Arguments passed;
    for (std::size_t i = 0; i < callee->second.parameters.size() && i + 3 < call.operands.size(); ++i) {
      const Id argument = call.operands[i + 3];
      const auto known = value(argument, arguments, 0);
      passed[callee->second.parameters[i]] = known ? known : pointed_value(argument, arguments, 0);
    }
    return fetch_bound(call.operands[2], passed, depth + 1);
  }

  /// The most fetches that one call of a function makes.
  std::optional<double> fetch_bound(Id id, const Arguments& arguments, int depth) {
    const Function& function = functions_[id];
    std::vector<std::pair<Loop, std::optional<double>>> loops;
    for (const Loop& loop : loops_of(function)) {
      loops.emplace_back(loop, loop_bound(function, loop, arguments));
      if (listed_.insert(loop.merge).second)
        loops_.push_back(loops.back().second ? Json(*loops.back().second) : Json());
    }
    std::optional<double> total = 0.0;
    for (std::size_t i = 0; i < function.instructions.size(); ++i) {
      const SpirvInstruction& instruction = function.instructions[i];
      std::optional<double> fetches;
      if (is_fetch(instruction.opcode)) {
        fetches = 1;
      } else if (instruction.opcode == spv::OpFunctionCall) {
        fetches = call_bound(instruction, arguments, depth);
      } else {
        continue;
      }
      if (fetches == 0.0) continue;
      for (const auto& [loop, bound] : loops) {
        if (loop.first <= i && i < loop.last) fetches = multiply(fetches, bound);
      }
      total = total && fetches ? std::optional(*total + *fetches) : std::nullopt;
    }
    return total;
  }

  const ComposedProgram& program_;
  Id entry_ = 0, current_ = 0;
  std::map<Id, Function> functions_;
  std::unordered_map<Id, Node> nodes_;
  std::unordered_map<Id, Id> types_, pointees_, sets_, bindings_;
  std::map<std::pair<Id, std::uint32_t>, std::uint32_t> offsets_;
  std::unordered_map<Id, std::vector<Id>> stores_;
  std::set<Id> listed_;
  std::vector<Json> loops_;  // in the order of the calls
};

}  // namespace

std::string describe_cost(const ComposedProgram& program, std::span<const SpirvWords> modules) {
  Json json = {{"schema", 1}};
  Json loops = Json::array();
  for (const ParameterSlot& slot : program.parameters) {
    if (!slot.is_loop) continue;
    loops.push_back({{"name", slot.name}, {"binding", to_string(slot.binding)}, {"default", slot.default_value}});
  }
  json["loops"] = std::move(loops);
  json["shaders"] = Json::array();
  for (std::size_t i = 0; i < modules.size(); ++i) {
    json["shaders"].push_back(CostReader(program, modules[i]).describe(program.shaders[i].stage));
  }
  return json.dump(2);
}

}  // namespace relievo
