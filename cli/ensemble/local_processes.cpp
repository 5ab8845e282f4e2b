#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "cli/ensemble/executor.h"
#include "cli/ensemble/exit_code.h"

namespace scree {
namespace {

constexpr auto kLook = std::chrono::milliseconds(20);  // between looks at the processes
constexpr double kToCheckpoint = 30;                   // s that interrupted runs have for their last

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

// Of a line " 42 %  about ..." in a run's log.
std::optional<double> share_of(const std::string& line) {
  std::istringstream words(line);
  double percent = 0;
  std::string sign;
  if (words >> percent >> sign && sign == "%") return 0.01 * percent;
  return std::nullopt;
}

// The first and the last share that a log tells; 0 without one.
ShareDone share_in(const std::filesystem::path& log, bool resumed) {
  std::optional<double> first;
  ShareDone share;
  for (const std::string& line : lines_of(log))
    if (const auto here = share_of(line)) {
      if (!first) first = *here;
      share.now = *here;
    }
  if (resumed) share.before = first.value_or(0);
  return share;
}

// Why a run failed, in its own words: what it says of its seed, or else its last line.
std::string words_in(const std::filesystem::path& log) {
  std::string of_seed, last;
  for (const std::string& line : lines_of(log)) {
    if (share_of(line)) continue;
    const std::size_t end = line.find_first_not_of("0123456789", 5);
    if (line.starts_with("seed ") && end != std::string::npos && line[end] == ':' &&
        line.find("particle-steps/s") == std::string::npos)
      of_seed = line;
    last = line;
  }
  return of_seed.empty() ? last : of_seed;
}

}  // namespace

LocalProcesses::LocalProcesses(int places, double checkpoint_minutes, std::filesystem::path program)
    : program_(std::move(program)), places_(places), checkpoint_minutes_(checkpoint_minutes) {}

LocalProcesses::~LocalProcesses() {
  cancel();
}

int LocalProcesses::free_places() const {
  int free = places_;
  for (const Process& process : processes_) free -= process.job.threads;
  return free;
}

void LocalProcesses::start(const Job& job) {
  const std::string program = program_.string(), scenario = (job.folder / "scenario.yaml").string(),
                    out = (job.folder / "run").string(), log = (job.folder / "log.txt").string();
  std::vector<std::string> words{program, "run", scenario, "--out", out};
  if (job.resume) words = {program, "run", "--resume", out};
  if (job.keep_pile && !job.resume) words.emplace_back("--keep-pile");  // one that goes on knows it
  if (!job.pile.empty()) words.insert(words.end(), {"--pile", job.pile.string()});
  words.insert(words.end(), {"--threads", fmt::format("{}", job.threads), "--summary-only",
                             "--checkpoint-minutes", fmt::format("{}", checkpoint_minutes_)});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error(fmt::format("a process cannot be started: {}", std::strerror(errno)));
  if (pid == 0) {  // only calls that are safe after a fork
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);  // it died before the line above
    setpgid(0, 0);                      // Ctrl-C goes to the sweep, which ends its runs itself
    signal(SIGINT, SIG_DFL);            // not ignored, as it is in the background of a script
    const int null = open("/dev/null", O_RDONLY),
              file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(null, STDIN_FILENO);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    execv(program.c_str(), arguments.data());
    _exit(127);
  }
  processes_.push_back({job, pid, now()});
}

std::optional<EndedJob> LocalProcesses::wait(double patience) {
  const double until = now() + patience;
  while (true) {
    for (auto process = processes_.begin(); process != processes_.end(); ++process) {
      int status = 0;
      const pid_t ended_one = waitpid(process->pid, &status, WNOHANG);
      const bool lost = ended_one < 0 && errno == ECHILD;  // it ended, and nobody knows how
      if (ended_one != process->pid && !lost) continue;
      const int code = !lost && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
      // By whoever lacks memory or shuts down; a crash of its own has another signal.
      const bool killed =
          !lost && WIFSIGNALED(status) &&
          (WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGTERM || WTERMSIG(status) == SIGHUP);
      EndedJob ended{process->job.key,
                     code == 0                        ? JobEnd::good
                     : killed || code == kInterrupted ? JobEnd::interrupted
                     : code == kBadInput              ? JobEnd::refused
                                                      : JobEnd::bad,
                     {},
                     now() - process->started,
                     process->job.resume,
                     share_in(process->job.folder / "log.txt", process->job.resume).before};
      if (killed || ended.end == JobEnd::bad || ended.end == JobEnd::refused) {
        const std::string words = words_in(process->job.folder / "log.txt");
        ended.message = lost                  ? "it ended, and how is not known"
                        : WIFSIGNALED(status) ? fmt::format("killed by signal {}", WTERMSIG(status))
                        : words.empty()       ? fmt::format("exit status {}", WEXITSTATUS(status))
                                              : words;
      }
      processes_.erase(process);
      return ended;
    }
    if (now() >= until) return std::nullopt;
    std::this_thread::sleep_for(kLook);
  }
}

std::vector<ShareDone> LocalProcesses::shares() const {
  std::vector<ShareDone> shares;
  for (const Process& process : processes_)
    shares.push_back(share_in(process.job.folder / "log.txt", process.job.resume));
  return shares;
}

void LocalProcesses::cancel() {
  for (const Process& process : processes_) kill(process.pid, checkpoint_minutes_ > 0 ? SIGINT : SIGKILL);
  const double until = now() + kToCheckpoint;
  while (!processes_.empty()) {
    std::erase_if(processes_, [](const Process& process) {
      const pid_t ended = waitpid(process.pid, nullptr, WNOHANG);
      return ended == process.pid || (ended < 0 && errno == ECHILD);
    });
    if (now() >= until)
      for (const Process& process : processes_) kill(process.pid, SIGKILL);
    if (!processes_.empty()) std::this_thread::sleep_for(kLook);
  }
}

}  // namespace scree
