#include "compile/filtered.hpp"

#include <map>
#include <spirv_cross/spirv.hpp>
#include <utility>

namespace relievo {

namespace {

using Id = std::uint32_t;

bool samples(std::uint32_t opcode) {
  return (opcode >= spv::OpImageSampleImplicitLod && opcode <= spv::OpImageSampleProjDrefExplicitLod) ||
         (opcode >= spv::OpImageSparseSampleImplicitLod && opcode <= spv::OpImageSparseSampleProjDrefExplicitLod);
}

/// Where the images of a module come from.
struct ImageFlow {
  std::multimap<Id, Id> sources;  ///< an id and what it is made from
  std::vector<Id> sampled;
};

ImageFlow image_flow(std::span<const std::uint32_t> words) {
  ImageFlow flow;
  std::map<Id, std::vector<Id>> parameters;  // of a function
  std::vector<std::pair<Id, std::span<const std::uint32_t>>> calls;
  std::vector<Id>* of_function = nullptr;
  for_each_instruction(words, [&](const SpirvInstruction& one) {
    const auto operands = one.operands;
    if (samples(one.opcode)) flow.sampled.push_back(operands[2]);
    switch (one.opcode) {
      case spv::OpFunction:
        of_function = &parameters[operands[1]];
        break;
      case spv::OpFunctionParameter:
        of_function->push_back(operands[1]);
        break;
      case spv::OpFunctionCall:
        calls.emplace_back(operands[2], operands.subspan(3));
        break;
      case spv::OpLoad:
      case spv::OpAccessChain:
      case spv::OpInBoundsAccessChain:
      case spv::OpCompositeExtract:
      case spv::OpCopyObject:
      case spv::OpImage:
      case spv::OpSampledImage:
        flow.sources.emplace(operands[1], operands[2]);
        break;
      default:
        break;
    }
  });
  for (const auto& [function, arguments] : calls) {
    const std::vector<Id>& own = parameters[function];
    for (std::size_t k = 0; k < own.size() && k < arguments.size(); ++k) flow.sources.emplace(own[k], arguments[k]);
  }
  return flow;
}

}  // namespace

std::set<std::uint32_t> filtered_variables(std::span<const std::uint32_t> words) {
  const ImageFlow flow = image_flow(words);
  std::set<Id> found;
  std::vector<Id> open = flow.sampled;
  while (!open.empty()) {
    const Id id = open.back();
    open.pop_back();
    if (!found.insert(id).second) continue;
    const auto [first, last] = flow.sources.equal_range(id);
    for (auto source = first; source != last; ++source) open.push_back(source->second);
  }
  return found;
}

}  // namespace relievo
