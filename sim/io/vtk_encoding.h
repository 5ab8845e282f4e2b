#pragma once
// How VTK XML files write the bytes of an array: base64 or raw, whole or in blocks of zlib.
#include <bit>
#include <string>
#include <string_view>

namespace scree {

/// How all arrays of a file are written.
struct VtkEncoding {
  std::endian order = std::endian::little;
  std::size_t header_size = 4;  ///< bytes of each number before the data: 4 (UInt32) or 8 (UInt64)
  bool compressed = false;      ///< zlib
};

/// The `size` bytes of an array whose header begins at `text`; base64 may end and begin anew after the
/// header. Nothing is allocated that `text` does not bear out: its length for plain bytes, at most 1032 times
/// that for those of zlib. Throws std::runtime_error that says what is wrong: text that ends early, another
/// size, a letter that is not of base64, damaged blocks.
std::string decoded_array(std::string_view text, bool base64, const VtkEncoding& encoding, std::size_t size);

}  // namespace scree
