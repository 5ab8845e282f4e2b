#include "sim/io/ply_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <vector>

#include "sim/material/input_bytes.h"

namespace scree {
namespace {

constexpr std::uint64_t kMostElements = 500'000'000;

/// Bytes of a number type, 0 when unknown.
std::size_t bytes_of(std::string_view type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "int" || type == "uint" || type == "float" || type == "int32" || type == "uint32" ||
      type == "float32")
    return 4;
  return type == "double" || type == "float64" ? 8 : 0;
}

struct Property {
  bool list = false;
  std::size_t count_bytes = 0;  // of a list's length
  bool count_is_signed = false;
  std::size_t bytes = 0;
};

struct Element {
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

using Words = std::vector<std::string_view>;

Words words_of(std::string_view line) {
  Words words;
  constexpr std::string_view blanks = " \t\r";
  for (std::size_t at = 0; (at = line.find_first_not_of(blanks, at)) != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

/// A line as a message shows it.
std::string start_of(const Words& words) {
  return fmt::format("{}", fmt::join(words, " ")).substr(0, 80);
}

std::optional<std::uint64_t> whole(std::string_view word) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

class PlyCheck {
 public:
  explicit PlyCheck(std::string_view text) : rest_(text) {}

  std::optional<std::string> complaint() {
    if (!rest_.starts_with("ply")) return "is not a PLY file";
    next_line();
    if (auto wrong = header()) return wrong;
    return form_ == "ascii" ? ascii() : binary();
  }

 private:
  bool next_line() {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return true;
  }

  std::optional<std::string> header() {
    while (next_line()) {
      const Words words = words_of(line_);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") return std::nullopt;
      if (!understood(words)) return fmt::format("is damaged: its header has '{}'", start_of(words));
    }
    return "is damaged: its header does not end";
  }

  bool understood(const Words& words) {
    if (words[0] == "format" && words.size() > 1) {
      form_ = words[1];
      return form_ == "ascii" || form_ == "binary_little_endian" || form_ == "binary_big_endian";
    }
    if (words[0] == "element" && words.size() == 3) {
      const auto count = whole(words[2]);
      if (!count || *count > kMostElements) return false;
      elements_.push_back({*count, {}});
      return true;
    }
    if (words[0] != "property" || elements_.empty()) return false;
    Property property;
    property.list = words.size() == 5 && words[1] == "list";
    if (!property.list && words.size() != 3) return false;
    property.bytes = bytes_of(words[property.list ? 3 : 1]);
    if (property.list) {
      property.count_bytes = bytes_of(words[2]);
      property.count_is_signed = words[2].front() != 'u';
      if (property.count_bytes == 0 || words[2].front() == 'f' || words[2].front() == 'd') return false;
    }
    elements_.back().properties.push_back(property);
    return property.bytes > 0;
  }

  std::optional<std::string> ascii() {
    std::uint64_t announced = 0, found = 0;
    for (const Element& element : elements_) announced += element.count;
    for (const Element& element : elements_)
      for (std::uint64_t k = 0; k < element.count; ++k) {
        Words words;
        do {
          if (!next_line())
            return fmt::format("is cut short: it announces {} lines of data and has {}", announced, found);
          words = words_of(line_);
        } while (words.empty() || words[0] == "comment");
        ++found;
        if (!fits(element, words))
          return fmt::format("is damaged: '{}' has fewer numbers than its header and its lists say",
                             start_of(words));
      }
    return std::nullopt;
  }

  static bool fits(const Element& element, const Words& words) {
    std::size_t left = words.size();
    for (const Property& property : element.properties) {
      if (left == 0) return false;
      std::uint64_t entries = 1;
      if (property.list) {
        const auto count = whole(words[words.size() - left]);
        if (!count) return false;
        entries = *count;
        --left;
      }
      if (entries > left) return false;
      left -= entries;
    }
    return true;
  }

  std::optional<std::string> binary() {
    for (const Element& element : elements_) {
      // Of a fixed size: no need to walk.
      std::uint64_t size = 0;
      bool lists = false;
      for (const Property& property : element.properties) {
        size += property.list ? property.count_bytes : property.bytes;
        lists = lists || property.list;
      }
      if (size * element.count > rest_.size())
        return fmt::format("is cut short: it announces at least {} more bytes of data and has {}",
                           size * element.count, rest_.size());
      if (!lists) {
        rest_.remove_prefix(size * element.count);
        continue;
      }
      for (std::uint64_t k = 0; k < element.count; ++k)
        for (const Property& property : element.properties)
          if (!skip(property)) return "is cut short, or damaged: a list is longer than the file";
    }
    return std::nullopt;
  }

  bool skip(const Property& property) {
    std::uint64_t bytes = property.bytes;
    if (property.list) {
      if (rest_.size() < property.count_bytes) return false;
      std::uint64_t count = 0;
      for (std::size_t k = 0; k < property.count_bytes; ++k) {
        const std::size_t at = form_ == "binary_big_endian" ? k : property.count_bytes - 1 - k;
        count = count << 8 | static_cast<unsigned char>(rest_[at]);
      }
      if (property.count_is_signed && count >> (8 * property.count_bytes - 1) != 0) return false;
      rest_.remove_prefix(property.count_bytes);
      if (count > rest_.size()) return false;
      bytes *= count;
    }
    if (bytes > rest_.size()) return false;
    rest_.remove_prefix(bytes);
    return true;
  }

  std::string_view rest_, line_, form_;
  std::vector<Element> elements_;
};

}  // namespace

std::optional<std::string> ply_complaint(const std::filesystem::path& file) {
  try {
    const std::string bytes = read_input_bytes(file);
    return PlyCheck(bytes).complaint();
  } catch (const FileError& error) {
    return error.message;
  }
}

}  // namespace scree
