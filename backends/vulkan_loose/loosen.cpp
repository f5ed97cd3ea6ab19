#include "loosen.hpp"

#include <spirv_cross/GLSL.std.450.h>

#include <array>
#include <map>
#include <set>
#include <spirv-tools/libspirv.hpp>
#include <spirv_cross/spirv.hpp>
#include <utility>

namespace relievo {

namespace {

using Id = std::uint32_t;

constexpr std::uint32_t sign_bit = 0x80000000, smallest_normal = 0x00800000, infinity = 0x7f800000;
constexpr std::uint32_t mantissa_bits = 0x007fffff, mantissa_of_root_2 = 0x003504f4;
constexpr std::uint32_t greatest_divisor = 0x7e800000;  // 2^126: beyond it quotients may be anything

/// What becomes of a correctly rounded result.
enum class Loosening {
  flush,     ///< denormals and signs of zeros only
  quotient,  ///< 2 ulp more, 2.5 in all
  root,      ///< 2 ulp of the inverse are r² of a root with the mantissa r; then a quotient: 3 ulp more, or 4
};

void append(SpirvWords& words, spv::Op opcode, std::initializer_list<std::uint32_t> operands) {
  words.push_back(static_cast<std::uint32_t>(operands.size() + 1) << 16 | opcode);
  words.insert(words.end(), operands);
}

void append(SpirvWords& words, SpirvInstruction instruction) {
  words.push_back(static_cast<std::uint32_t>(instruction.operands.size() + 1) << 16 | instruction.opcode);
  words.insert(words.end(), instruction.operands.begin(), instruction.operands.end());
}

/// ± a · b.
struct Product {
  spv::Op opcode = spv::OpFMul;  ///< or OpVectorTimesScalar
  Id a = 0, b = 0;
  bool is_negative = false;
};

/// What the module declares; ids are 0 where it does not.
struct Declared {
  Id bound = 0;
  Id extended = 0;                                          ///< GLSL.std.450
  std::array<Id, 5> floats{}, doubles{}, uints{}, bools{};  ///< types of so many components
  std::map<Id, unsigned> components;                        ///< of the types of floats
  std::set<Id> exact;                                       ///< NoContraction
  std::map<Id, Product> products;                           ///< those that may become part of a sum
};

Declared read(std::span<const std::uint32_t> words) {
  Declared found;
  found.bound = words[3];
  for_each_instruction(words, [&](const SpirvInstruction& one) {
    const auto operands = one.operands;
    const auto vector_of = [&](std::array<Id, 5>& types) {
      if (types[1] != 0 && operands[1] == types[1]) types[operands[2]] = operands[0];
    };
    switch (one.opcode) {
      case spv::OpExtInstImport:
        if (spirv_string(operands.subspan(1)) == "GLSL.std.450") found.extended = operands[0];
        break;
      case spv::OpTypeFloat:
        if (operands[1] == 32) found.floats[1] = operands[0];
        if (operands[1] == 64) found.doubles[1] = operands[0];
        break;
      case spv::OpTypeInt:
        if (operands[1] == 32 && operands[2] == 0) found.uints[1] = operands[0];
        break;
      case spv::OpTypeBool:
        found.bools[1] = operands[0];
        break;
      case spv::OpTypeVector:
        for (auto* types : {&found.floats, &found.doubles, &found.uints, &found.bools}) vector_of(*types);
        break;
      case spv::OpDecorate:
        if (operands[1] == spv::DecorationNoContraction) found.exact.insert(operands[0]);
        break;
      case spv::OpFMul:
      case spv::OpVectorTimesScalar:
        if (!found.exact.contains(operands[1]))
          found.products[operands[1]] = {static_cast<spv::Op>(one.opcode), operands[2], operands[3]};
        break;
      case spv::OpFNegate:
        if (const auto product = found.products.find(operands[2]); product != found.products.end()) {
          Product& negative = found.products[operands[1]] = product->second;
          negative.is_negative = !negative.is_negative;
        }
        break;
      default:
        break;
    }
  });
  for (unsigned n = 1; n < found.floats.size(); ++n) {
    if (found.floats[n] != 0) found.components[found.floats[n]] = n;
  }
  return found;
}

bool is_flushed(std::uint32_t opcode) {
  switch (opcode) {
    case spv::OpFAdd:
    case spv::OpFSub:
    case spv::OpFMul:
    case spv::OpFDiv:
    case spv::OpVectorTimesScalar:
    case spv::OpVectorTimesMatrix:
    case spv::OpMatrixTimesVector:
    case spv::OpDot:
    case spv::OpExtInst:
    case spv::OpImageSampleImplicitLod:
    case spv::OpImageSampleExplicitLod:
    case spv::OpImageFetch:
    case spv::OpImageGather:
    case spv::OpImageRead:
      return true;
    default:
      return false;
  }
}

class Rewriter {
 public:
  Rewriter(std::span<const std::uint32_t> words, bool has_float64)
      : words_(words), found_(read(words)), has_float64_(has_float64) {}

  SpirvWords run() {
    if (found_.floats[1] == 0) return {words_.begin(), words_.end()};
    for_each_instruction(words_, [&](const SpirvInstruction& one) {
      if (one.opcode == spv::OpFunction) in_functions_ = true;
      if (in_functions_) rewrite(one);
    });
    return assemble();
  }

 private:
  Id new_id() { return found_.bound++; }

  Id constant(unsigned components, std::uint32_t value) {
    auto [known, is_new] = constants_.try_emplace({components, value}, 0);
    if (!is_new) return known->second;
    if (components == 1) {
      const Id id = known->second = new_id();
      append(declarations_, spv::OpConstant, {uint_type(1), id, value});
      return id;
    }
    const Id part = constant(1, value), type = uint_type(components), id = new_id();
    constants_[{components, value}] = id;
    declarations_.push_back((3 + components) << 16 | spv::OpConstantComposite);
    declarations_.insert(declarations_.end(), {type, id});
    declarations_.insert(declarations_.end(), components, part);
    return id;
  }

  Id vector_type(std::array<Id, 5>& types, unsigned components) {
    if (types[components] != 0) return types[components];
    types[components] = new_id();
    append(declarations_, spv::OpTypeVector, {types[components], types[1], components});
    return types[components];
  }

  Id uint_type(unsigned components) {
    if (found_.uints[1] == 0) append(declarations_, spv::OpTypeInt, {found_.uints[1] = new_id(), 32, 0});
    return vector_type(found_.uints, components);
  }

  Id bool_type(unsigned components) {
    if (found_.bools[1] == 0) append(declarations_, spv::OpTypeBool, {found_.bools[1] = new_id()});
    return vector_type(found_.bools, components);
  }

  Id double_type(unsigned components) {
    if (found_.doubles[1] == 0) {
      append(capabilities_, spv::OpCapability, {spv::CapabilityFloat64});
      append(declarations_, spv::OpTypeFloat, {found_.doubles[1] = new_id(), 64});
    }
    return vector_type(found_.doubles, components);
  }

  Id emit(spv::Op opcode, Id type, std::initializer_list<Id> operands) {
    const Id id = new_id();
    functions_.push_back(static_cast<std::uint32_t>(operands.size() + 3) << 16 | opcode);
    functions_.insert(functions_.end(), {type, id});
    functions_.insert(functions_.end(), operands);
    return id;
  }

  /// Bits that look random and are the same for the same bits at the same place of the module.
  Id scramble(unsigned n, Id bits) {
    const Id type = uint_type(n);
    Id mixed = emit(spv::OpIMul, type, {bits, constant(n, 0x9e3779b1)});
    mixed = emit(spv::OpBitwiseXor, type, {mixed, constant(n, place_ * 0x85ebca6b)});
    mixed = emit(spv::OpBitwiseXor, type, {mixed, emit(spv::OpShiftRightLogical, type, {mixed, constant(n, 15)})});
    return emit(spv::OpShiftRightLogical, type,
                {emit(spv::OpIMul, type, {mixed, constant(n, 0xc2b2ae35)}), constant(n, 8)});
  }

  Id magnitude(unsigned n, Id bits) { return emit(spv::OpBitwiseAnd, uint_type(n), {bits, constant(n, ~sign_bit)}); }

  Id is_finite(unsigned n, Id bits) {
    return emit(spv::OpULessThan, bool_type(n), {magnitude(n, bits), constant(n, infinity)});
  }

  /// By how many ulp a root may be moved, twice, and one: a mantissa of √2 or more is worth another in either
  /// direction.
  Id root_choices(unsigned n, Id bits) {
    const Id mantissa = emit(spv::OpBitwiseAnd, uint_type(n), {bits, constant(n, mantissa_bits)});
    const Id is_less = emit(spv::OpULessThan, bool_type(n), {mantissa, constant(n, mantissa_of_root_2)});
    return emit(spv::OpSelect, uint_type(n), {is_less, constant(n, 7), constant(n, 9)});
  }

  /// Some ulp away, unless that or what it is moved from is infinite or no number.
  Id move(unsigned n, Id bits, Loosening how) {
    const Id type = uint_type(n);
    const Id choices = how == Loosening::root ? root_choices(n, bits) : constant(n, 5);
    const Id by = emit(spv::OpUMod, type, {scramble(n, bits), choices});
    const Id half = emit(spv::OpShiftRightLogical, type, {choices, constant(n, 1)});
    const Id moved = emit(spv::OpISub, type, {emit(spv::OpIAdd, type, {bits, by}), half});
    const Id may = emit(spv::OpLogicalAnd, bool_type(n), {is_finite(n, bits), is_finite(n, moved)});
    const Id is_zero = emit(spv::OpIEqual, bool_type(n), {magnitude(n, bits), constant(n, 0)});
    return emit(spv::OpSelect, type, {is_zero, bits, emit(spv::OpSelect, type, {may, moved, bits})});
  }

  Id is_too_great(unsigned n, Id divisor) {
    const Id bits = emit(spv::OpBitcast, uint_type(n), {divisor});
    return emit(spv::OpUGreaterThan, bool_type(n), {magnitude(n, bits), constant(n, greatest_divisor)});
  }

  /// From `exact`, the result of `one` as it is here, what a driver may make of it, as the result that `one` has.
  void loosen_value(const SpirvInstruction& one, Id exact) {
    ++place_;
    const unsigned n = found_.components.at(one.operands[0]);
    const Loosening how = loosening_of(one);
    Id bits = emit(spv::OpBitcast, uint_type(n), {exact});
    const Id parity = emit(spv::OpIAdd, uint_type(n), {bits, constant(n, place_)});
    const Id zero = emit(spv::OpShiftLeftLogical, uint_type(n), {parity, constant(n, 31)});
    if (how != Loosening::flush) bits = move(n, bits, how);
    Id is_none = emit(spv::OpULessThan, bool_type(n), {magnitude(n, bits), constant(n, smallest_normal)});
    if (how == Loosening::quotient) {
      const Id is_lost = emit(spv::OpLogicalAnd, bool_type(n), {is_too_great(n, one.operands[3]), is_finite(n, bits)});
      is_none = emit(spv::OpLogicalOr, bool_type(n), {is_none, is_lost});
    }
    const Id loose = emit(spv::OpSelect, uint_type(n), {is_none, zero, bits});
    append(functions_, spv::OpBitcast, {one.operands[0], one.operands[1], loose});
  }

  Loosening loosening_of(const SpirvInstruction& one) const {
    if (one.opcode == spv::OpFDiv) return Loosening::quotient;
    if (one.opcode != spv::OpExtInst || one.operands[2] != found_.extended) return Loosening::flush;
    switch (one.operands[3]) {
      case GLSLstd450Sqrt:
      case GLSLstd450Length:
      case GLSLstd450Distance:
      case GLSLstd450Normalize:
        return Loosening::root;
      default:
        return Loosening::flush;
    }
  }

  /// a · b ± c or c ± a · b as one operation, if this is such a sum and may be one. Drivers may take Fma for two
  /// operations; a product of floats is exact in double precision.
  bool contract(const SpirvInstruction& one, Id exact) {
    const bool is_difference = one.opcode == spv::OpFSub;
    if ((one.opcode != spv::OpFAdd && !is_difference) || !has_float64_) return false;
    if (found_.exact.contains(one.operands[1])) return false;
    const auto is_product = [&](Id id) { return found_.products.contains(id); };
    const Id left = one.operands[2], right = one.operands[3];
    if (!is_product(left) && !is_product(right)) return false;
    const Id type = double_type(found_.components.at(one.operands[0]));
    const auto widen = [&](Id id) { return emit(spv::OpFConvert, type, {id}); };
    const auto term = [&](Id id, bool as_product) {
      if (!as_product) return widen(id);
      const Product& product = found_.products.at(id);
      const bool by_number = product.opcode == spv::OpVectorTimesScalar;
      const Id number_type = by_number ? double_type(1) : type;
      const Id b = emit(spv::OpFConvert, number_type, {product.b});
      const Id exact_product = emit(product.opcode, type, {widen(product.a), b});
      return product.is_negative ? emit(spv::OpFNegate, type, {exact_product}) : exact_product;
    };
    const Id first = term(left, is_product(left)), second = term(right, !is_product(left));
    const Id sum = emit(is_difference ? spv::OpFSub : spv::OpFAdd, type, {first, second});
    append(functions_, spv::OpFConvert, {one.operands[0], exact, sum});
    return true;
  }

  void rewrite(const SpirvInstruction& one) {
    const auto operands = one.operands;
    if (!is_flushed(one.opcode) || !found_.components.contains(operands[0])) return append(functions_, one);
    const Id exact = new_id();
    renamed_[operands[1]] = exact;
    if (!contract(one, exact)) {
      SpirvWords changed(operands.begin(), operands.end());
      changed[1] = exact;
      append(functions_, {one.opcode, changed});
    }
    loosen_value(one, exact);
  }

  /// Decorations go along with the operations; what is declared anew stands before the functions.
  SpirvWords assemble() {
    SpirvWords result(words_.begin(), words_.begin() + static_cast<std::ptrdiff_t>(kSpirvHeaderWords));
    result[3] = found_.bound;
    result.insert(result.end(), capabilities_.begin(), capabilities_.end());
    bool in_globals = true;
    for_each_instruction(words_, [&](const SpirvInstruction& one) {
      in_globals = in_globals && one.opcode != spv::OpFunction;
      if (!in_globals) return;
      SpirvWords operands(one.operands.begin(), one.operands.end());
      if (one.opcode == spv::OpDecorate) {
        if (const auto renamed = renamed_.find(operands[0]); renamed != renamed_.end()) operands[0] = renamed->second;
      }
      append(result, {one.opcode, operands});
    });
    result.insert(result.end(), declarations_.begin(), declarations_.end());
    result.insert(result.end(), functions_.begin(), functions_.end());
    return result;
  }

  std::span<const std::uint32_t> words_;
  Declared found_;
  SpirvWords capabilities_, declarations_, functions_;
  std::map<std::pair<unsigned, std::uint32_t>, Id> constants_;
  std::map<Id, Id> renamed_;  ///< results → those of their exact operations
  std::uint32_t place_ = 0;
  bool has_float64_;
  bool in_functions_ = false;
};

}  // namespace

SpirvWords loosen(std::span<const std::uint32_t> words, bool has_float64) {
  const spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
  if (words.size() < kSpirvHeaderWords || !tools.Validate(words.data(), words.size())) {
    return {words.begin(), words.end()};
  }
  return Rewriter(words, has_float64).run();
}

}  // namespace relievo
