#pragma once
// Pictures out of files and into them.
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string_view>

namespace scree {

/// Most pixels of a picture, 64 million: analysis then takes some 3 GB at most.
constexpr std::int64_t kLargestPicture = 64'000'000;

/// What the first bytes of a picture say, before anything is unpacked.
struct PictureHeader {
  enum class Format { png, jpeg } format = Format::png;
  std::int64_t width = 0, height = 0;  ///< px, before a turn that EXIF asks for
};

/// Reads the header of a PNG or JPEG. Throws std::runtime_error that says what is wrong: another format, no
/// size, cut off.
PictureHeader picture_header(std::string_view bytes);

/// Reads a photograph, three channels of 8 bits, turned upright as its EXIF orientation says. Memory is
/// bounded: size is checked before unpacking. Throws FileError: no PNG or JPEG, empty, too many pixels, cut
/// off or damaged, or without any contrast (all black, all white).
cv::Mat read_photograph(const std::filesystem::path& file);

/// Writes PNG or JPEG, by the file's ending, in one step. Throws std::runtime_error.
void write_picture(const std::filesystem::path& file, const cv::Mat& picture);

}  // namespace scree
