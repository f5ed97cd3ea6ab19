#include "compile/constant_parameters.hpp"

#include <glslang/Include/intermediate.h>
#include <glslang/MachineIndependent/localintermediate.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace relievo {

namespace {

using glslang::TIntermAggregate;
using glslang::TIntermBinary;
using glslang::TIntermSymbol;
using glslang::TIntermTyped;
using glslang::TIntermUnary;
using glslang::TVisit;

std::string_view name_of(const TIntermAggregate& node) {
  return {node.getName().data(), node.getName().size()};
}

bool is_written(glslang::TStorageQualifier qualifier) {
  return qualifier == glslang::EvqOut || qualifier == glslang::EvqInOut;
}

/// The variable that `expression` is or is a part of; null for a value.
const TIntermSymbol* find_variable(TIntermTyped* expression) {
  while (TIntermBinary* part = expression->getAsBinaryNode()) expression = part->getLeft();
  return expression->getAsSymbolNode();
}

/// Collects what is defined, called and written. Symbols are unique in a tree, so one set serves all functions.
class Collector : public glslang::TIntermTraverser {
 public:
  std::vector<TIntermAggregate*> functions;
  std::vector<TIntermAggregate*> calls;
  std::unordered_set<long long> written;  ///< ids of symbols

  bool visitAggregate(TVisit, TIntermAggregate* node) override {
    if (node->getOp() == glslang::EOpFunction) functions.push_back(node);
    if (node->getOp() == glslang::EOpFunctionCall) calls.push_back(node);
    const auto& qualifiers = node->getQualifierList();  // empty but for calls, built-in functions included
    for (std::size_t i = 0; i < qualifiers.size(); ++i) {
      if (is_written(qualifiers[i])) note_write(node->getSequence()[i]->getAsTyped());
    }
    return true;
  }

  bool visitBinary(TVisit, TIntermBinary* node) override {
    if (node->modifiesState()) note_write(node->getLeft());
    return true;
  }

  bool visitUnary(TVisit, TIntermUnary* node) override {
    if (node->modifiesState()) note_write(node->getOperand());
    return true;
  }

 private:
  void note_write(TIntermTyped* target) {
    if (const TIntermSymbol* variable = find_variable(target)) written.insert(variable->getId());
  }
};

bool can_be_a_value(const glslang::TType& type) {
  const auto is_indexed = [](const glslang::TType* part) { return part->isArray() || part->isMatrix(); };
  return !type.contains(is_indexed) && !type.containsOpaque() && type.getBasicType() != glslang::EbtBlock &&
         type.getBasicType() != glslang::EbtReference;
}

/// A function's parameters, one entry each: whether it is made constant here.
std::vector<bool> make_constant(TIntermAggregate& function, const std::unordered_set<long long>& written) {
  std::vector<bool> constant;
  for (TIntermNode* node : function.getSequence().front()->getAsAggregate()->getSequence()) {
    TIntermSymbol* parameter = node->getAsSymbolNode();
    glslang::TQualifier& qualifier = parameter->getWritableType().getQualifier();
    constant.push_back(qualifier.storage == glslang::EvqIn && can_be_a_value(parameter->getType()) &&
                       written.count(parameter->getId()) == 0);
    if (constant.back()) qualifier.storage = glslang::EvqConstReadOnly;
  }
  return constant;
}

}  // namespace

void make_read_parameters_constant(glslang::TIntermediate& tree) {
  if (tree.getTreeRoot() == nullptr) return;
  Collector found;
  tree.getTreeRoot()->traverse(&found);
  std::unordered_map<std::string_view, std::vector<bool>> constant;  // by mangled name
  for (TIntermAggregate* function : found.functions) {
    constant.emplace(name_of(*function), make_constant(*function, found.written));
  }
  for (TIntermAggregate* call : found.calls) {
    const auto callee = constant.find(name_of(*call));
    if (callee == constant.end()) continue;
    for (std::size_t i = 0; i < callee->second.size(); ++i) {
      if (callee->second[i]) call->getQualifierList()[i] = glslang::EvqConstReadOnly;
    }
  }
}

}  // namespace relievo
