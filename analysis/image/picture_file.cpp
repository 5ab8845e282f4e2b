#include "analysis/image/picture_file.h"

#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <vector>

#include "sim/material/input_text.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

unsigned byte_at(std::string_view bytes, std::size_t at) {
  if (at >= bytes.size()) throw std::runtime_error("is cut off within its header");
  return static_cast<unsigned char>(bytes[at]);
}

std::int64_t big_endian(std::string_view bytes, std::size_t at, int n) {
  std::int64_t value = 0;
  for (int i = 0; i < n; ++i) value = value << 8 | byte_at(bytes, at + i);
  return value;
}

// Size of a JPEG: in its start-of-frame segment (ITU T.81, B.2.2), which stands behind others.
PictureHeader jpeg_header(std::string_view bytes) {
  std::size_t at = 2;
  for (;;) {
    if (byte_at(bytes, at) != 0xff)
      throw std::runtime_error("is a damaged JPEG: no segment where one must be");
    while (byte_at(bytes, at) == 0xff) ++at;  // fill bytes
    const unsigned marker = byte_at(bytes, at++);
    // C4, C8 and CC are tables and reserved ones within the range of frames.
    if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc)
      return {PictureHeader::Format::jpeg, big_endian(bytes, at + 5, 2), big_endian(bytes, at + 3, 2)};
    if (marker == 0xd9 || marker == 0xda) throw std::runtime_error("is a damaged JPEG: it states no size");
    if (marker == 0x01 || (marker >= 0xd0 && marker <= 0xd7)) continue;  // stand alone
    at += static_cast<std::size_t>(big_endian(bytes, at, 2));
  }
}

// A decoder fills what is missing at the end with grey; a grading of that is none.
bool is_complete(PictureHeader::Format format, std::string_view bytes) {
  const std::string_view end = format == PictureHeader::Format::png ? "IEND"sv : "\xff\xd9"sv;
  // Cameras may add a few bytes; a thumbnail within the head has an end of its own.
  const auto at = bytes.rfind(end);
  return at != std::string_view::npos && at >= bytes.size() / 2;
}

}  // namespace

PictureHeader picture_header(std::string_view bytes) {
  PictureHeader header;
  if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) {
    header.width = big_endian(bytes, 16, 4);
    header.height = big_endian(bytes, 20, 4);
  } else if (bytes.starts_with("\xff\xd8\xff"sv)) {
    header = jpeg_header(bytes);
  } else {
    throw std::runtime_error("is no PNG or JPEG; convert it to one of these");
  }
  if (header.width <= 0 || header.height <= 0)
    throw std::runtime_error(
        fmt::format("has {} x {} pixels: there is nothing to see", header.width, header.height));
  return header;
}

cv::Mat read_photograph(const fs::path& file) {
  const std::string bytes = read_input_bytes(file);
  PictureHeader header;
  try {
    header = picture_header(bytes);
  } catch (const std::runtime_error& error) {
    throw FileError(file, 0, error.what());
  }
  if (header.width > kLargestPicture / header.height)
    throw FileError(file, 0,
                    fmt::format("has {} x {} pixels; at most {} megapixels are read: scale it down",
                                header.width, header.height, kLargestPicture / 1'000'000));
  if (!is_complete(header.format, bytes)) throw FileError(file, 0, "is cut off: its end is missing");
  cv::Mat picture;
  try {
    const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    picture = cv::imdecode(raw, cv::IMREAD_COLOR);  // turns it as EXIF says
  } catch (const cv::Exception&) {
    picture.release();
  }
  if (picture.empty()) throw FileError(file, 0, "is damaged: it cannot be unpacked");
  double low = 0, high = 0;
  cv::minMaxLoc(picture.reshape(1), &low, &high);
  if (high - low < 16)
    throw FileError(
        file, 0,
        fmt::format("shows nothing: all of its pixels are between {:.0f} and {:.0f} of 255", low, high));
  return picture;
}

void write_picture(const fs::path& file, const cv::Mat& picture) {
  std::vector<uchar> bytes;
  const std::string ending = file.extension().string();
  if (ending != ".png" && ending != ".jpg" && ending != ".jpeg")
    throw std::runtime_error(
        fmt::format("cannot write {}: a picture's name ends with .png or .jpg", file.string()));
  if (!cv::imencode(ending, picture, bytes, {cv::IMWRITE_JPEG_QUALITY, 88, cv::IMWRITE_PNG_COMPRESSION, 6}))
    fail_to_write(file, "the picture cannot be packed");
  write_text_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace scree
