/// Jobs as CBOR. Every struct lists its fields once, in fields(); the writer and the reader both walk that list.
#include <fmt/format.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <type_traits>
#include <utility>

#include "relievo/job.hpp"

namespace relievo {

namespace {

using Json = nlohmann::json;

// Raise it when a field is added, removed or changes its meaning.
constexpr int schema_version = 2;

template <class Archive>
void fields(Archive& a, SamplerState& s) {
  a("min_mag", s.min_mag), a("mip", s.mip), a("address", s.address);
}

template <class Archive>
void fields(Archive& a, Texture& t) {
  a("name", t.name), a("format", t.format), a("width", t.width), a("height", t.height), a("depth", t.depth);
  a("is_3d", t.is_3d), a("is_array", t.is_array), a("levels", t.levels), a("data", t.data), a("sampler", t.sampler);
}

template <class Archive>
void fields(Archive& a, Buffer& b) {
  a("name", b.name), a("size", b.size), a("data", b.data);
}

template <class Archive>
void fields(Archive& a, BindingSlot& s) {
  a("kind", s.kind), a("set", s.set), a("binding", s.binding), a("name", s.name), a("gl_slot", s.gl_slot);
  a("is_filtered", s.is_filtered);
}

template <class Archive>
void fields(Archive& a, ShaderCode& s) {
  a("stage", s.stage), a("spirv", s.spirv), a("text", s.text);
}

template <class Archive>
void fields(Archive& a, SpecializationValue& v) {
  a("id", v.id), a("bits", v.bits);
}

template <class Archive>
void fields(Archive& a, ShaderProgram& p) {
  a("name", p.name), a("shaders", p.shaders), a("bindings", p.bindings), a("constants", p.constants);
}

template <class Archive>
void fields(Archive& a, ResourceBinding& b) {
  a("set", b.set), a("binding", b.binding), a("resource", b.resource);
}

template <class Archive>
void fields(Archive& a, Dispatch& d) {
  a("program", d.program), a("resources", d.resources), a("groups", d.groups);
}

template <class Archive>
void fields(Archive& a, VertexAttribute& v) {
  a("location", v.location), a("format", v.format), a("offset", v.offset);
}

template <class Archive>
void fields(Archive& a, Draw& d) {
  a("program", d.program), a("resources", d.resources), a("vertex_buffer", d.vertex_buffer);
  a("vertex_stride", d.vertex_stride), a("attributes", d.attributes), a("index_buffer", d.index_buffer);
  a("count", d.count), a("instances", d.instances), a("color_targets", d.color_targets);
  a("depth_target", d.depth_target), a("clear_color", d.clear_color), a("clear_depth", d.clear_depth);
  a("cull", d.cull);
}

template <class Archive>
void fields(Archive& a, ReadBack& r) {
  a("source", r.source), a("index", r.index), a("level", r.level);
}

template <class Archive>
void fields(Archive& a, Job& j) {
  a("name", j.name), a("programs", j.programs), a("buffers", j.buffers), a("textures", j.textures);
  a("commands", j.commands), a("read_backs", j.read_backs);
}

// Enums travel as their position; these are the last ones.
constexpr ShaderStage last(ShaderStage) {
  return ShaderStage::compute;
}
constexpr Format last(Format) {
  return Format::rgba16_uint;
}
constexpr TexelFilter last(TexelFilter) {
  return TexelFilter::linear;
}
constexpr TexelAddress last(TexelAddress) {
  return TexelAddress::clamp;
}
constexpr ResourceKind last(ResourceKind) {
  return ResourceKind::storage_texture;
}
constexpr CullMode last(CullMode) {
  return CullMode::front;
}
constexpr ReadBack::Source last(ReadBack::Source) {
  return ReadBack::Source::texture;
}

/// Byte and word arrays travel as byte strings, in the byte order of the machine.
template <class T>
constexpr bool is_raw = std::is_same_v<T, std::byte> || std::is_same_v<T, std::uint32_t>;

class Writer {
 public:
  template <class T>
  void operator()(const char* key, T& value) {
    object_[key] = write(value);
  }

  template <class T>
  static Json write_struct(T& value) {
    Writer writer;
    fields(writer, value);
    return std::move(writer.object_);
  }

 private:
  template <class T>
  static Json write(T& value) {
    if constexpr (std::is_enum_v<T>) {
      return static_cast<int>(value);
    } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
      return value;
    } else {
      return write_struct(value);
    }
  }

  static Json write(std::map<std::string, std::string>& value) { return value; }

  template <class T>
  static Json write(std::vector<T>& list) {
    if constexpr (is_raw<T>) {
      std::vector<std::uint8_t> bytes(list.size() * sizeof(T));
      if (!list.empty()) std::memcpy(bytes.data(), list.data(), bytes.size());
      return Json::binary(std::move(bytes));
    } else {
      return write_elements(list);
    }
  }

  template <class T, std::size_t N>
  static Json write(std::array<T, N>& list) {
    return write_elements(list);
  }

  template <class List>
  static Json write_elements(List& list) {
    Json array = Json::array();
    for (auto& element : list) array.push_back(write(element));
    return array;
  }

  template <class T>
  static Json write(std::optional<T>& value) {
    return value ? write(*value) : Json();
  }

  static Json write(Command& command) {
    const char* kind = std::holds_alternative<Dispatch>(command) ? "dispatch" : "draw";
    return {{kind, std::visit([](auto& value) { return write_struct(value); }, command)}};
  }

  Json object_ = Json::object();
};

/// Reads strictly: every field is present, nothing else is, types and ranges fit. Remembers the first thing wrong.
class Reader {
 public:
  template <class T>
  void read(const Json& json, T& value) {
    if constexpr (std::is_enum_v<T>) {
      int position = 0;
      read(json, position);
      if (!require(position >= 0 && position <= static_cast<int>(last(T{})), "a known enumerator")) return;
      value = static_cast<T>(position);
    } else if constexpr (std::is_same_v<T, bool>) {
      if (require(json.is_boolean(), "a boolean")) value = json.get<bool>();
    } else if constexpr (std::is_integral_v<T>) {
      if (require(fits<T>(json), "an integer in range")) value = json.get<T>();
    } else if constexpr (std::is_floating_point_v<T>) {
      if (require(json.is_number(), "a number")) value = json.get<T>();
    } else if constexpr (std::is_same_v<T, std::string>) {
      if (require(json.is_string(), "a string")) value = json.get<std::string>();
    } else {
      read_struct(json, value);
    }
  }

  void read(const Json& json, std::map<std::string, std::string>& value) {
    if (!require(json.is_object(), "an object")) return;
    for (const auto& [key, text] : json.items()) at(key, [&, &k = key, &t = text] { read(t, value[k]); });
  }

  template <class T>
  void read(const Json& json, std::vector<T>& list) {
    if constexpr (is_raw<T>) {
      if (!require(json.is_binary() && json.get_binary().size() % sizeof(T) == 0, "a byte string of whole elements")) {
        return;
      }
      const std::vector<std::uint8_t>& bytes = json.get_binary();
      list.resize(bytes.size() / sizeof(T));
      if (!bytes.empty()) std::memcpy(list.data(), bytes.data(), bytes.size());
    } else {
      if (!require(json.is_array(), "an array")) return;
      list.resize(json.size());
      read_elements(json, list);
    }
  }

  template <class T, std::size_t N>
  void read(const Json& json, std::array<T, N>& list) {
    if (require(json.is_array() && json.size() == N, "an array of the right length")) read_elements(json, list);
  }

  template <class T>
  void read(const Json& json, std::optional<T>& value) {
    if (!json.is_null()) read(json, value.emplace());
  }

  void read(const Json& json, Command& command) {
    if (!require(json.is_object() && json.size() == 1, "one command")) return;
    const std::string& kind = json.begin().key();
    if (!require(kind == "dispatch" || kind == "draw", "a dispatch or a draw")) return;
    at(kind, [&] {
      if (kind == "draw") return read_struct(*json.begin(), command.emplace<Draw>());
      return read_struct(*json.begin(), command.emplace<Dispatch>());
    });
  }

  template <class T>
  void operator()(const char* key, T& value) {
    ++field_count_;
    const auto found = object_->find(key);
    at(key, [&] {
      if (require(found != object_->end(), "a value")) read(*found, value);
    });
  }

  /// What is wrong, or empty.
  const std::string& problem() const { return problem_; }

 private:
  template <class T>
  void read_struct(const Json& json, T& value) {
    if (!require(json.is_object(), "an object")) return;
    const Json* const outer = std::exchange(object_, &json);
    const std::size_t outer_count = std::exchange(field_count_, 0);
    fields(*this, value);
    require(field_count_ == json.size(), "no unknown fields");
    object_ = outer;
    field_count_ = outer_count;
  }

  template <class List>
  void read_elements(const Json& json, List& list) {
    for (std::size_t i = 0; i < json.size() && problem_.empty(); ++i) {
      at(std::to_string(i), [&] { read(json[i], list[i]); });
    }
  }

  template <class T>
  static bool fits(const Json& json) {
    if (json.is_number_unsigned()) return std::in_range<T>(json.get<std::uint64_t>());
    return json.is_number_integer() && std::in_range<T>(json.get<std::int64_t>());
  }

  template <class Action>
  void at(const std::string& key, Action action) {
    const std::size_t length = path_.size();
    path_ += "/" + key;
    action();
    path_.resize(length);
  }

  bool require(bool holds, const char* expected) {
    if (!holds && problem_.empty()) problem_ = fmt::format("{} is not {}", path_.empty() ? "/" : path_, expected);
    return holds;
  }

  const Json* object_ = nullptr;
  std::size_t field_count_ = 0;
  std::string path_, problem_;
};

/// Whether the bytes are one whole CBOR item (RFC 8949 §3) as jobs have it: nested no deeper than they are, every
/// length given. The parser is recursive, over strings without a length too, and hostile bytes could exhaust the stack.
class CborOutline {
 public:
  explicit CborOutline(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool is_plain() {
    std::vector<std::uint64_t> open = {1};  // items still to come, by depth
    while (!open.empty()) {
      if (open.back() == 0) {
        open.pop_back();
        continue;
      }
      --open.back();
      std::uint64_t items = 0;
      if (!read_item(items)) return false;
      if (items > 0) open.push_back(items);
      if (open.size() > max_depth) return false;
    }
    return at_ == bytes_.size();
  }

 private:
  static constexpr std::size_t max_depth = 16;

  std::size_t left() const { return bytes_.size() - at_; }

  /// Passes over an item's head, and over a string; `items`: what it holds.
  bool read_item(std::uint64_t& items) {
    enum Major { byte_string = 2, text_string = 3, array = 4, map = 5, tag = 6 };
    if (left() == 0) return false;
    const int major = bytes_[at_] >> 5, size = bytes_[at_] & 31;
    ++at_;
    std::uint64_t argument = static_cast<std::uint64_t>(size);
    if (size >= 28 || major == tag || !(size < 24 || read_argument(std::size_t{1} << (size - 24), argument)))
      return false;
    if (major == array) items = argument;
    if (major == map) items = argument <= left() ? 2 * argument : argument;
    if (items > left()) return false;
    if (major != byte_string && major != text_string) return true;
    if (argument > left()) return false;
    at_ += static_cast<std::size_t>(argument);
    return true;
  }

  bool read_argument(std::size_t size, std::uint64_t& argument) {
    if (size > left()) return false;
    argument = 0;
    for (std::size_t i = 0; i < size; ++i) argument = argument << 8 | bytes_[at_ + i];
    at_ += size;
    return true;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

tl::unexpected<Error> parse_failure(const std::string& reason) {
  return fail(ErrorCode::io, "job.parse", fmt::format("The bytes are not a job: {}", reason));
}

Json parse_cbor(const std::vector<std::uint8_t>& bytes) {
  if (!CborOutline(bytes).is_plain()) return Json(Json::value_t::discarded);
  return Json::from_cbor(bytes, true, false);
}

Result<Job> read_job(const Json& document) {
  const auto version = document.find("relievo_job");
  if (version == document.end() || *version != schema_version) {
    return parse_failure(fmt::format("the schema version is not {}", schema_version));
  }
  const auto body = document.find("job");
  if (body == document.end() || document.size() != 2) return parse_failure("expected one job beside the version");
  Job job;
  Reader reader;
  reader.read(*body, job);
  if (!reader.problem().empty()) return parse_failure(reader.problem());
  if (const Status valid = validate_job(job); !valid) return parse_failure(valid.error().message);
  return job;
}

}  // namespace

std::vector<std::uint8_t> serialize_job(const Job& job) {
  Job fields_are_mutable = job;
  return Json::to_cbor({{"relievo_job", schema_version}, {"job", Writer::write_struct(fields_are_mutable)}});
}

Result<Job> parse_job(const std::vector<std::uint8_t>& bytes) {
  try {
    const Json document = parse_cbor(bytes);
    if (!document.is_object()) return parse_failure("not CBOR, or truncated");
    return read_job(document);
  } catch (const std::exception& error) {  // the parser throws for lengths beyond any memory
    return parse_failure(error.what());
  }
}

}  // namespace relievo
