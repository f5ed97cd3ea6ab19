/// Two-dimensional arrays of NumPy files: .npy, and the .npz archives of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image/decode.hpp"
#include "relievo/result.hpp"

namespace relievo {

/// A 2D array as it lies in the file.
struct NumberArray {
  int rows = 0, columns = 0;
  bool column_major = false;  ///< NumPy's fortran_order
  char kind = 'f';            ///< i, u or f
  int size = 4;               ///< bytes an element
  bool swap = false;          ///< the other byte order than this machine's
  std::vector<std::uint8_t> bytes;

  double at(int row, int column) const;
  bool is_integer() const { return kind != 'f'; }
};

bool is_npy(Bytes bytes);
bool is_zip(Bytes bytes);
Result<NumberArray> decode_npy(const ImageSource& source);
/// The one 2D array with more than one element; none or several are errors.
Result<NumberArray> decode_npz(const ImageSource& source);

/// What an .npy file says of itself.
struct NpyHeader {
  std::string descr;  ///< "<i2"
  bool column_major = false;
  std::vector<std::int64_t> shape;
  std::size_t data_offset = 0;
};

/// `bytes` is at least the beginning of the file. Errors: "image.corrupt", "image.truncated".
Result<NpyHeader> parse_npy_header(const ImageSource& source);

/// The array that a header describes, without its bytes. Errors: not 2D, a type without numbers, a size out of range.
Result<NumberArray> describe_array(const std::filesystem::path& path, const NpyHeader& header);

}  // namespace relievo
