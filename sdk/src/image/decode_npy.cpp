#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstring>
#include <string_view>

#include "files/whole_file.hpp"
#include "image/array.hpp"
#include "relievo/height_map.hpp"

namespace relievo {

namespace {

constexpr std::string_view magic = "\x93NUMPY";

/// The text after `'key':` in the header's dictionary, or empty.
std::string_view value_of(std::string_view dictionary, std::string_view key) {
  const std::size_t at = dictionary.find(fmt::format("'{}'", key));
  if (at == std::string_view::npos) return {};
  const std::size_t colon = dictionary.find(':', at);
  if (colon == std::string_view::npos) return {};
  const std::size_t begin = dictionary.find_first_not_of(' ', colon + 1);
  return begin == std::string_view::npos ? std::string_view() : dictionary.substr(begin);
}

/// "(344, 403)" → {344, 403}; false when it is no tuple of numbers.
bool parse_shape(std::string_view text, std::vector<std::int64_t>& shape) {
  if (text.empty() || text.front() != '(') return false;
  const char* at = text.data() + 1;
  const char* const end = text.data() + text.size();
  while (at < end && *at != ')') {
    if (*at == ' ' || *at == ',') {
      ++at;
      continue;
    }
    std::int64_t extent = 0;
    const auto [next, code] = std::from_chars(at, end, extent);
    if (code != std::errc() || extent < 0) return false;
    shape.push_back(extent);
    at = next;
  }
  return at < end;
}

bool parse_quoted(std::string_view text, std::string& value) {
  if (text.empty() || text.front() != '\'') return false;
  const std::size_t end = text.find('\'', 1);
  if (end == std::string_view::npos) return false;
  value = text.substr(1, end - 1);
  return true;
}

template <class T>
double read(const std::uint8_t* from, bool swap) {
  std::uint8_t bytes[sizeof(T)];
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes[i] = from[swap ? sizeof(T) - 1 - i : i];
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

bool is_supported(char kind, int size) {
  const bool integer = (kind == 'i' || kind == 'u') && (size == 1 || size == 2 || size == 4 || size == 8);
  return integer || (kind == 'f' && (size == 4 || size == 8));
}

}  // namespace

double NumberArray::at(int row, int column) const {
  const auto r = static_cast<std::size_t>(row), c = static_cast<std::size_t>(column);
  const std::size_t index =
      column_major ? c * static_cast<std::size_t>(rows) + r : r * static_cast<std::size_t>(columns) + c;
  const std::uint8_t* from = bytes.data() + index * static_cast<std::size_t>(size);
  if (kind == 'f') return size == 4 ? read<float>(from, swap) : read<double>(from, swap);
  switch (size) {
    case 1:
      return kind == 'i' ? read<std::int8_t>(from, swap) : read<std::uint8_t>(from, swap);
    case 2:
      return kind == 'i' ? read<std::int16_t>(from, swap) : read<std::uint16_t>(from, swap);
    case 4:
      return kind == 'i' ? read<std::int32_t>(from, swap) : read<std::uint32_t>(from, swap);
    default:
      return kind == 'i' ? read<std::int64_t>(from, swap) : read<std::uint64_t>(from, swap);
  }
}

bool is_npy(Bytes bytes) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

Result<NpyHeader> parse_npy_header(const ImageSource& source) {
  const Bytes bytes = source.bytes;
  const auto truncated = [&] {
    return file_error(source.path, "image.truncated", "is truncated: its NumPy header ends too early");
  };
  if (!is_npy(bytes)) return file_error(source.path, "image.corrupt", "is corrupt: it has no NumPy header");
  if (bytes.size() < 12) return truncated();
  const bool wide = bytes[6] >= 2;  // since format 2.0 the header's length has four bytes
  std::size_t length = bytes[8] | (std::size_t{bytes[9]} << 8);
  if (wide) length |= (std::size_t{bytes[10]} << 16) | (std::size_t{bytes[11]} << 24);
  NpyHeader header;
  header.data_offset = (wide ? 12 : 10) + length;
  if (header.data_offset > bytes.size()) return truncated();

  const std::string_view dictionary(reinterpret_cast<const char*>(bytes.data()) + (wide ? 12 : 10), length);
  const std::string_view order = value_of(dictionary, "fortran_order");
  header.column_major = order.starts_with("True");
  const bool valid =
      (header.column_major || order.starts_with("False")) && parse_shape(value_of(dictionary, "shape"), header.shape);
  if (!valid) return file_error(source.path, "image.corrupt", "is corrupt: its NumPy header has no order or no shape");
  if (!parse_quoted(value_of(dictionary, "descr"), header.descr)) header.descr = "a structure";
  return header;
}

Result<NumberArray> describe_array(const std::filesystem::path& path, const NpyHeader& header) {
  if (header.shape.size() != 2) {
    return file_error(path, "image.format",
                      fmt::format("holds an array of {} dimensions; 2 are expected", header.shape.size()));
  }
  NumberArray array;
  array.column_major = header.column_major;
  const std::string& descr = header.descr;
  const bool ordered = descr.size() == 3 && std::string_view("<>|=").find(descr[0]) != std::string_view::npos;
  if (ordered) {
    array.kind = descr[1];
    array.size = descr[2] - '0';
    array.swap = (descr[0] == '<' && std::endian::native == std::endian::big) ||
                 (descr[0] == '>' && std::endian::native == std::endian::little);
  }
  if (!ordered || !is_supported(array.kind, array.size)) {
    return file_error(path, "image.format",
                      fmt::format("holds elements of type '{}'; i1 to i8, u1 to u8, f4 or f8 is expected", descr));
  }
  const std::int64_t rows = header.shape[0], columns = header.shape[1];
  if (rows < 1 || columns < 1 || rows > max_height_map_extent || columns > max_height_map_extent) {
    return file_error(path, "image.size",
                      fmt::format("holds an array of {} rows and {} columns; 1 to {} are expected", rows, columns,
                                  max_height_map_extent));
  }
  array.rows = static_cast<int>(rows);
  array.columns = static_cast<int>(columns);
  return array;
}

Result<NumberArray> decode_npy(const ImageSource& source) {
  const auto header = parse_npy_header(source);
  if (!header) return tl::unexpected(header.error());
  auto array = describe_array(source.path, *header);
  if (!array) return array;
  const std::size_t needed = static_cast<std::size_t>(array->rows) * static_cast<std::size_t>(array->columns) *
                             static_cast<std::size_t>(array->size);
  const Bytes data = source.bytes.subspan(header->data_offset);
  if (data.size() < needed) {
    return file_error(source.path, "image.truncated",
                      fmt::format("is truncated: it has {} bytes of elements and needs {}", data.size(), needed));
  }
  array->bytes.assign(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(needed));
  return array;
}

}  // namespace relievo
