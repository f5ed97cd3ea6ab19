#include "compose/parameters.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>

namespace relievo {

namespace {

std::string identifier(const std::string& qualified) {
  std::string name = qualified;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

std::string literal(const ParameterSlot& slot) {
  if (slot.is_integer) return fmt::format("{}", static_cast<long long>(slot.value));
  std::string text = fmt::format("{:.9g}", slot.value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

Status check_value(const std::string& name, const Parameter& parameter, double value) {
  if (!std::isfinite(value) || value < parameter.minimum || value > parameter.maximum) {
    return fail(ErrorCode::usage, "compose.range",
                fmt::format("{} is {}; expected {} to {}", name, value, parameter.minimum, parameter.maximum));
  }
  if (parameter.is_integer && value != std::floor(value)) {
    return fail(ErrorCode::usage, "compose.type", fmt::format("{} is {}; expected a whole number", name, value));
  }
  return {};
}

Status check_binding(const ParameterSlot& slot, const Parameter& parameter) {
  const std::vector<BindingTime>& allowed = parameter.bindings;
  if (allowed.empty() || std::find(allowed.begin(), allowed.end(), slot.binding) != allowed.end()) return {};
  std::vector<std::string_view> names;
  for (const BindingTime time : allowed) names.push_back(to_string(time));
  return fail(
      ErrorCode::usage, "compose.binding",
      fmt::format("{} is bound as {}; expected {}", slot.name, to_string(slot.binding), fmt::join(names, " or ")));
}

template <class T>
Status check_known(const std::map<std::string, T>& given, const std::vector<ParameterSlot>& slots) {
  for (const auto& [name, value] : given) {
    if (std::any_of(slots.begin(), slots.end(), [&name = name](const ParameterSlot& s) { return s.name == name; }))
      continue;
    std::vector<std::string> known;
    for (const ParameterSlot& slot : slots) known.push_back(slot.name);
    std::string nearest = nearest_name(name, known);
    return fail(ErrorCode::usage, "compose.unknown-parameter",
                fmt::format("parameter '{}' is unknown here; {}", name,
                            !nearest.empty() ? fmt::format("did you mean '{}'?", nearest)
                            : known.empty()  ? std::string("there are none")
                                             : fmt::format("expected one of {}", fmt::join(known, ", "))));
  }
  return {};
}

}  // namespace

Result<std::vector<ParameterSlot>> assign_parameters(const std::vector<ParameterOwner>& owners,
                                                     const std::map<std::string, double>& values,
                                                     const std::map<std::string, BindingTime>& times) {
  std::vector<ParameterSlot> slots;
  int next_constant = 0, next_offset = 0;
  for (const ParameterOwner& owner : owners) {
    for (const Parameter& parameter : *owner.parameters) {
      ParameterSlot slot{owner.name + "." + parameter.name, parameter.is_integer, parameter.binding, parameter.value};
      slot.default_value = parameter.value;
      slot.is_loop = parameter.is_loop;
      slot.choices = parameter.choices;
      if (auto time = times.find(slot.name); time != times.end()) slot.binding = time->second;
      if (Status status = check_binding(slot, parameter); !status) return tl::unexpected(status.error());
      if (auto value = values.find(slot.name); value != values.end()) slot.value = value->second;
      if (Status status = check_value(slot.name, parameter, slot.value); !status) return tl::unexpected(status.error());
      if (slot.binding == BindingTime::specialization) slot.constant_id = next_constant++;
      if (slot.binding == BindingTime::uniform) {
        slot.offset = next_offset;
        next_offset += 4;
      }
      slots.push_back(std::move(slot));
    }
  }
  if (Status status = check_known(values, slots); !status) return tl::unexpected(status.error());
  if (Status status = check_known(times, slots); !status) return tl::unexpected(status.error());
  return slots;
}

int parameter_block_size(const std::vector<ParameterSlot>& slots) {
  int size = 0;
  for (const ParameterSlot& slot : slots) size = std::max(size, slot.offset + 4);
  bool any = std::any_of(slots.begin(), slots.end(), [](const ParameterSlot& s) { return s.offset >= 0; });
  return any ? (size + 15) / 16 * 16 : 0;
}

std::string declare_parameters(const std::vector<ParameterSlot>& slots) {
  std::string constants, members;
  for (const ParameterSlot& slot : slots) {
    const char* type = slot.is_integer ? "int" : "float";
    std::string name = identifier(slot.name);
    for (std::size_t i = 0; i < slot.choices.size(); ++i)
      constants += fmt::format("#define {}_{} {}\n", name, slot.choices[i], i);
    switch (slot.binding) {
      case BindingTime::macro:
        constants += fmt::format("#define {} {}\n", name, slot.value < 0 ? "(" + literal(slot) + ")" : literal(slot));
        break;
      case BindingTime::specialization:
        constants +=
            fmt::format("layout(constant_id = {}) const {} {} = {};\n", slot.constant_id, type, name, literal(slot));
        break;
      case BindingTime::uniform:
        members += fmt::format("  {} {};\n", type, name);
        break;
    }
  }
  if (!members.empty()) constants += "layout(std140, set = 0, binding = 0) uniform Parameters {\n" + members + "};\n";
  return constants;
}

std::vector<std::byte> parameter_block(const ComposedProgram& program) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(program.parameter_block_size));
  for (const ParameterSlot& slot : program.parameters) {
    if (slot.offset < 0) continue;
    std::int32_t integer = static_cast<std::int32_t>(slot.value);
    float real = static_cast<float>(slot.value);
    std::memcpy(bytes.data() + slot.offset, slot.is_integer ? static_cast<const void*>(&integer) : &real, 4);
  }
  return bytes;
}

}  // namespace relievo
