#include "sim/io/results_store.h"

#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace scree {
namespace {

constexpr int kFormat = 1;            // PRAGMA user_version
constexpr int kBusyTimeout = 60'000;  // ms to wait for another program's transaction

constexpr const char* kTables = R"(
CREATE TABLE IF NOT EXISTS runs (
  key TEXT PRIMARY KEY,
  scenario TEXT NOT NULL,
  seed INTEGER NOT NULL,
  version TEXT NOT NULL,
  state TEXT NOT NULL CHECK (state IN ('running', 'done', 'failed')),
  owner TEXT,
  seen REAL,
  wall_seconds REAL,
  message TEXT,
  summary TEXT
) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS outputs (
  key TEXT NOT NULL REFERENCES runs (key),
  name TEXT NOT NULL,
  value REAL NOT NULL,
  PRIMARY KEY (key, name)
) WITHOUT ROWID;
)";

double now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

// Time at which a process started, in ticks since the machine did; empty when it is not there, or is dead and
// only waits for its parent to notice.
std::string start_of(const std::string& pid) {
  std::ifstream in("/proc/" + pid + "/stat");
  std::string line;
  std::getline(in, line);
  const auto name_end = line.rfind(')');  // the name may hold anything
  if (name_end == std::string::npos) return {};
  std::istringstream fields(line.substr(name_end + 1));
  std::string field;
  for (int k = 3; k <= 22; ++k) {  // proc(5): state is field 3, starttime field 22
    fields >> field;
    if (k == 3 && (field == "Z" || field == "X")) return {};
  }
  return field;
}

// The machine, or the container in it, in which process numbers mean the same.
std::string place_of_processes() {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  std::error_code none;
  std::ifstream boot("/proc/sys/kernel/random/boot_id");
  std::string id;
  std::getline(boot, id);
  return fmt::format("{} {} {}", host, id, std::filesystem::read_symlink("/proc/self/ns/pid", none).string());
}

std::string this_program() {
  const std::string pid = std::to_string(getpid());
  return fmt::format("{}|{}|{}", place_of_processes(), pid, start_of(pid));
}

bool lives(const std::string& owner, double seen) {
  const auto second = owner.rfind('|'), first = owner.rfind('|', second - 1);
  if (second == std::string::npos || first == std::string::npos) return false;
  if (owner.substr(0, first) != place_of_processes()) return now() - seen < ResultsStore::kLostAfter;
  const std::string start = start_of(owner.substr(first + 1, second - first - 1));
  return !start.empty() && start == owner.substr(second + 1);
}

// A prepared statement.
class Statement {
 public:
  Statement(sqlite3* db, const char* sql) : db_(db) {
    if (sqlite3_prepare_v2(db, sql, -1, &statement_, nullptr) != SQLITE_OK) fail();
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;
  Statement& with(const std::string& text) {
    sqlite3_bind_text(statement_, ++bound_, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
    return *this;
  }
  Statement& with(double value) {
    sqlite3_bind_double(statement_, ++bound_, value);
    return *this;
  }
  Statement& with(std::int64_t value) {
    sqlite3_bind_int64(statement_, ++bound_, value);
    return *this;
  }
  /// True if there is a row.
  bool step() {
    const int code = sqlite3_step(statement_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) fail();
    return code == SQLITE_ROW;
  }
  std::string text(int column) const {
    const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    return bytes == nullptr
               ? std::string()
               : std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)));
  }
  double number(int column) const { return sqlite3_column_double(statement_, column); }

 private:
  [[noreturn]] void fail() const {
    const int code = sqlite3_errcode(db_);
    throw std::runtime_error(fmt::format(
        "{}: {}{}", sqlite3_db_filename(db_, "main"), sqlite3_errmsg(db_),
        code == SQLITE_CORRUPT || code == SQLITE_NOTADB ? "; put a copy back, or take another --store" : ""));
  }
  sqlite3* db_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
};

// All or nothing.
class Transaction {
 public:
  explicit Transaction(sqlite3* db) : db_(db) { Statement(db_, "BEGIN IMMEDIATE").step(); }
  ~Transaction() {
    if (open_) sqlite3_exec(db_, "ROLLBACK", nullptr, nullptr, nullptr);
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit() {
    Statement(db_, "COMMIT").step();
    open_ = false;
  }

 private:
  sqlite3* db_;
  bool open_ = true;
};

}  // namespace

ResultsStore::ResultsStore(const std::filesystem::path& file, Access access)
    : file_(file), owner_(this_program()) {
  try {
    const int flags =
        access == Access::look ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
    if (sqlite3_open_v2(file.c_str(), &db_, flags, nullptr) != SQLITE_OK)
      throw std::runtime_error(fmt::format("{}: {}", file.string(), sqlite3_errmsg(db_)));
    sqlite3_busy_timeout(db_, kBusyTimeout);
    std::optional<Transaction> transaction;
    if (access == Access::change) transaction.emplace(db_);
    const auto number = [&](const char* sql) {
      Statement statement(db_, sql);
      statement.step();
      return static_cast<int>(statement.number(0));
    };
    const int format = number("PRAGMA user_version");
    if (format > kFormat)
      throw std::runtime_error(fmt::format("{}: was written by a newer scree", file.string()));
    if (format == 0 && (access == Access::look || number("SELECT count(*) FROM sqlite_master") > 0))
      throw std::runtime_error(fmt::format("{}: is a database, but not a store of scree", file.string()));
    if (!transaction) return;
    execute(kTables);
    execute(fmt::format("PRAGMA user_version = {}", kFormat).c_str());
    transaction->commit();
  } catch (...) {
    sqlite3_close(db_);
    throw;
  }
}

ResultsStore::~ResultsStore() {
  sqlite3_close(db_);
}

void ResultsStore::execute(const char* sql) {
  char* message = nullptr;
  if (sqlite3_exec(db_, sql, nullptr, nullptr, &message) == SQLITE_OK) return;
  const std::string text = fmt::format("{}: {}", file_.string(), message);
  sqlite3_free(message);
  throw std::runtime_error(text);
}

Claim ResultsStore::claim(const RunRequest& run, const std::string& version, bool again) {
  Transaction transaction(db_);
  Statement known(db_, "SELECT state, owner, seen FROM runs WHERE key = ?");
  if (known.with(run.key).step()) {
    const std::string state = known.text(0);
    if (state == "done") return Claim::done;
    if (state == "failed" && !again) return Claim::failed;
    if (state == "running" && lives(known.text(1), known.number(2))) return Claim::others;
  }
  Statement(db_,
            "INSERT OR REPLACE INTO runs (key, scenario, seed, version, state, owner, seen) "
            "VALUES (?, ?, ?, ?, 'running', ?, ?)")
      .with(run.key)
      .with(run.scenario)
      .with(static_cast<std::int64_t>(run.seed))
      .with(version)
      .with(owner_)
      .with(now())
      .step();
  transaction.commit();
  return Claim::ours;
}

bool ResultsStore::finish(const std::string& key, const std::string& summary,
                          const std::map<std::string, double>& outputs, double wall_seconds) {
  Transaction transaction(db_);
  Statement(db_,
            "UPDATE runs SET state = 'done', owner = NULL, seen = NULL, wall_seconds = ?, summary = ? "
            "WHERE key = ? AND owner = ?")
      .with(wall_seconds)
      .with(summary)
      .with(key)
      .with(owner_)
      .step();
  if (sqlite3_changes(db_) == 0) return false;
  for (const auto& [name, value] : outputs)
    Statement(db_, "INSERT OR REPLACE INTO outputs (key, name, value) VALUES (?, ?, ?)")
        .with(key)
        .with(name)
        .with(value)
        .step();
  transaction.commit();
  return true;
}

bool ResultsStore::fail(const std::string& key, const std::string& message, double wall_seconds) {
  Statement(db_,
            "UPDATE runs SET state = 'failed', owner = NULL, seen = NULL, wall_seconds = ?, message = ? "
            "WHERE key = ? AND owner = ?")
      .with(wall_seconds)
      .with(message)
      .with(key)
      .with(owner_)
      .step();
  return sqlite3_changes(db_) > 0;
}

void ResultsStore::release(const std::string& key) {
  Statement(db_, "DELETE FROM runs WHERE key = ? AND owner = ? AND state = 'running'")
      .with(key)
      .with(owner_)
      .step();
}

void ResultsStore::sign_of_life() {
  Statement(db_, "UPDATE runs SET seen = ? WHERE owner = ? AND state = 'running'")
      .with(now())
      .with(owner_)
      .step();
}

std::optional<StoredResult> ResultsStore::find(const std::string& key) const {
  Statement row(db_, "SELECT state, version, message, wall_seconds FROM runs WHERE key = ?");
  if (!row.with(key).step()) return std::nullopt;
  StoredResult result;
  const std::string state = row.text(0);
  result.state = state == "done" ? RunState::done : state == "failed" ? RunState::failed : RunState::running;
  result.version = row.text(1);
  result.message = row.text(2);
  result.wall_seconds = row.number(3);
  Statement outputs(db_, "SELECT name, value FROM outputs WHERE key = ?");
  outputs.with(key);
  while (outputs.step()) result.outputs[outputs.text(0)] = outputs.number(1);
  return result;
}

std::string ResultsStore::summary(const std::string& key) const {
  Statement row(db_, "SELECT summary FROM runs WHERE key = ?");
  return row.with(key).step() ? row.text(0) : std::string();
}

}  // namespace scree
