// Photographs are the business of a program of its own beside this one, scree_pictures, with the same
// commands: the libraries of OpenCV take a sixth of a second to load, which every run of a sweep would pay.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/picture_options.h"

namespace {

// The same call by the other program; returns only if there is none.
int hand_over() {
  const std::filesystem::path other =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "scree_pictures";
  std::ifstream given("/proc/self/cmdline", std::ios::binary);
  std::string words{std::istreambuf_iterator<char>(given), {}};  // each ends with a zero
  std::vector<char*> arguments;
  for (std::size_t at = 0; at < words.size(); at += std::strlen(&words[at]) + 1)
    arguments.push_back(&words[at]);
  arguments.push_back(nullptr);
  execv(other.c_str(), arguments.data());
  fmt::print(stderr, "scree: {}: {}; photographs need it, build it beside scree\n", other.string(),
             std::strerror(errno));
  return kFailed;
}

}  // namespace

int run_image(const ImageOptions&) {
  return hand_over();
}

int run_render(const RenderOptions&) {
  return hand_over();
}
