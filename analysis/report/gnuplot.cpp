// How gnuplot is called: a script file in a folder of its own, no shell between.
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "analysis/report/pictures.h"
#include "sim/io/scratch_folder.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

/// Runs gnuplot on a script with its messages in `log`; the exit status, or -1 with errno when it cannot
/// start.
int spawn_gnuplot(const std::filesystem::path& script, const std::filesystem::path& log) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  std::string program = "gnuplot", no_settings = "-d", file = script.string();
  char* arguments[] = {program.data(), no_settings.data(), file.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    errno = error;
    return -1;
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Whether a picture is whole: gnuplot does not notice a full disk. Both formats have an end of their own.
bool is_whole(const std::filesystem::path& picture) {
  std::ifstream in(picture, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const auto end = bytes.rfind(bytes.starts_with("\x89PNG") ? "IEND" : "</svg>");
  return end != std::string::npos && bytes.size() - end <= 10;
}

}  // namespace

std::string gnuplot_quoted(std::string_view text) {
  // Between single quotes gnuplot expands nothing; a quote is doubled, and a line ends the string.
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "'";
}

std::string chart_terminal(int width, int height) {
  return fmt::format(
      "set terminal svg noenhanced size {},{} font 'Helvetica,Arial,DejaVu Sans,sans-serif,13' lw 1.4\n"
      "set minussign\nset clip two\nset border 3 lc rgb '#888888'\nset tics nomirror "
      "out scale 0.5 tc rgb '#333333'\n"
      "set grid lc rgb '#e6e6e6' lw 0.6 lt 1\n",
      width, height);
}

void run_gnuplot(const std::string& script, const std::filesystem::path& output) {
  const ScratchFolder scratch;
  const std::filesystem::path place = linked_file(output), part = place.string() + ".part";
  write_text_file(scratch.path() / "picture.gp",
                  fmt::format("set encoding utf8\nset output {}\n{}\nunset output\n",
                              gnuplot_quoted(std::filesystem::absolute(part).string()), script));
  const int status = spawn_gnuplot(scratch.path() / "picture.gp", scratch.path() / "messages.txt");
  if (status == -1 || status == 127)
    throw std::runtime_error(
        "cannot draw pictures: gnuplot does not start; install it (Debian: apt install gnuplot-nox)");
  std::error_code error;
  if (status == 0 && is_whole(part)) {
    std::filesystem::rename(part, place, error);
    if (error) fail_to_write(output, error.message());
    return;
  }
  const bool cut_off = status == 0 && std::filesystem::exists(part, error);
  std::filesystem::remove(part, error);
  if (cut_off) fail_to_write(output, "the picture is not whole; is the disk full?");
  std::ifstream in(scratch.path() / "messages.txt");
  std::string words{std::istreambuf_iterator<char>(in), {}};
  for (char& c : words)
    if (c == '\n') c = ' ';
  throw GnuplotFailed(
      output, fmt::format("gnuplot failed on {} (exit status {}): {}", output.string(), status, words));
}

void add_picture(std::vector<Picture>& pictures, const std::function<std::optional<Picture>()>& draw) {
  try {
    if (std::optional<Picture> drawn = draw()) pictures.push_back(std::move(*drawn));
  } catch (const GnuplotFailed& failed) {
    std::error_code ignored;
    std::filesystem::remove(failed.picture, ignored);  // one of an older report, of other numbers
    pictures.push_back({"", "", "", failed.what()});
  }
}

}  // namespace scree
