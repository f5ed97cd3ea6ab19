/// The byte form of one program; docs/archive.md has its layout.
#include <cstring>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "permute/archive/format.hpp"
#include "permute/archive/output_order.hpp"
#include "relievo/archive.hpp"

namespace relievo {

namespace {

constexpr std::string_view kProgramMagic = "RLVP";
constexpr std::uint32_t kProgramVersion = 1;

struct ProgramHeader {
  char magic[4];
  std::uint32_t version;
  std::uint64_t hash;  ///< XXH3-64 of all that follows this field
  std::uint64_t output_count, reflection_size, cost_size;
};
constexpr std::size_t kProgramHashedFrom = offsetof(ProgramHeader, output_count);

struct OutputHeader {
  std::uint32_t stage, language, version, reserved;
  std::uint64_t size;
};
static_assert(sizeof(ProgramHeader) == 40 && sizeof(OutputHeader) == 24);

template <class Record>
void append(std::string& bytes, const Record& record) {
  static_assert(std::is_trivially_copyable_v<Record>);
  bytes.append(reinterpret_cast<const char*>(&record), sizeof record);
}

/// Takes what is asked for from the front, as long as there is enough.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  template <class Record>
  bool take(Record& record) {
    if (rest_.size() < sizeof record) return false;
    std::memcpy(&record, rest_.data(), sizeof record);
    rest_.remove_prefix(sizeof record);
    return true;
  }
  bool take(std::uint64_t size, std::string& bytes) {
    if (rest_.size() < size) return false;
    bytes.assign(rest_.substr(0, static_cast<std::size_t>(size)));
    rest_.remove_prefix(static_cast<std::size_t>(size));
    return true;
  }
  std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

tl::unexpected<Error> damaged(std::string_view reason) {
  return fail(ErrorCode::io, "archive.program", fmt::format("the bytes are not a program: {}", reason));
}

Result<ProgramHeader> read_header(Reader& reader, std::string_view bytes) {
  ProgramHeader header{};
  if (!reader.take(header) || std::string_view(header.magic, 4) != kProgramMagic)
    return damaged("they do not begin as one");
  if (header.version != kProgramVersion)
    return damaged(fmt::format("their version is {}; expected {}", header.version, kProgramVersion));
  if (archive::hash64(bytes.substr(kProgramHashedFrom)) != header.hash) return damaged("their hash differs");
  return header;
}

bool read_output_headers(Reader& reader, std::uint64_t count, std::vector<OutputHeader>& headers) {
  if (count > reader.left() / sizeof(OutputHeader)) return false;
  headers.resize(static_cast<std::size_t>(count));
  for (OutputHeader& header : headers) {
    if (!reader.take(header) || header.reserved != 0) return false;
    if (!archive::is_stage(header.stage) || !archive::is_language(header.language)) return false;
    if (header.version > static_cast<std::uint32_t>(std::numeric_limits<int>::max())) return false;
  }
  return true;
}

}  // namespace

std::string write_program(const ProgramImage& program) {
  ProgramHeader header{{'R', 'L', 'V', 'P'},   kProgramVersion,           0,
                       program.outputs.size(), program.reflection.size(), program.cost.size()};
  std::string bytes;
  append(bytes, header);
  for (const ProgramOutput& output : program.outputs) {
    append(bytes,
           OutputHeader{static_cast<std::uint32_t>(output.stage), static_cast<std::uint32_t>(output.target.language),
                        static_cast<std::uint32_t>(output.target.version), 0, output.bytes.size()});
  }
  for (const ProgramOutput& output : program.outputs) bytes += output.bytes;
  bytes += program.reflection;
  bytes += program.cost;
  const std::uint64_t hash = archive::hash64(std::string_view(bytes).substr(kProgramHashedFrom));
  std::memcpy(bytes.data() + offsetof(ProgramHeader, hash), &hash, sizeof hash);
  return bytes;
}

Result<ProgramImage> read_program(std::string_view bytes) {
  Reader reader(bytes);
  const Result<ProgramHeader> header = read_header(reader, bytes);
  if (!header) return tl::unexpected(header.error());
  std::vector<OutputHeader> output_headers;
  if (!read_output_headers(reader, header->output_count, output_headers)) return damaged("an output is none");
  ProgramImage program;
  for (const OutputHeader& output : output_headers) {
    ProgramOutput& made = program.outputs.emplace_back();
    made.stage = static_cast<ShaderStage>(output.stage);
    made.target = {static_cast<Language>(output.language), static_cast<int>(output.version)};
    if (!reader.take(output.size, made.bytes)) return damaged("they end too early");
  }
  if (!archive::in_order(program.outputs)) return damaged("the outputs are not in order");
  if (!reader.take(header->reflection_size, program.reflection) || !reader.take(header->cost_size, program.cost))
    return damaged("they end too early");
  if (reader.left() != 0) return damaged(fmt::format("{} bytes follow", reader.left()));
  return program;
}

}  // namespace relievo
