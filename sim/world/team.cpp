#include "sim/world/team.h"

#include <utility>

namespace scree {
namespace {

constexpr int kLooks = 2000;  // before a worker sleeps: some 40 microseconds

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

Team::Team(int threads) {
  for (int k = 1; k < threads; ++k) workers_.emplace_back([this] { serve(); });
}

Team::~Team() {
  end_ = true;
  ++job_;
  job_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

// Takes one k of the ticket's job and does it; false if there was none to take.
bool Team::work(std::uint64_t ticket) {
  const auto k = static_cast<int>(ticket & 0xffffffffu);
  if (k >= count_.load(std::memory_order_acquire)) return false;
  const Call call = call_.load(std::memory_order_relaxed);
  void* const body = body_.load(std::memory_order_relaxed);
  if (ticket_.compare_exchange_strong(ticket, ticket + 1, std::memory_order_acq_rel)) {
    try {
      call(body, k);
    } catch (...) {
      if (!failed_.exchange(true)) failure_ = std::current_exception();
    }
    done_.fetch_add(1, std::memory_order_release);
  }
  return true;
}

void Team::share(int count, Call call, void* body) {
  const std::uint64_t number = (ticket_.load(std::memory_order_relaxed) >> 32) + 1;
  // Nobody takes a k of the job before: all of it is given out.
  count_.store(0, std::memory_order_relaxed);
  call_.store(call, std::memory_order_relaxed);
  body_.store(body, std::memory_order_relaxed);
  done_.store(0, std::memory_order_relaxed);
  ticket_.store(number << 32, std::memory_order_release);
  count_.store(count, std::memory_order_release);
  job_.fetch_add(1, std::memory_order_release);
  job_.notify_all();
  while (work(ticket_.load(std::memory_order_acquire))) {
  }
  while (done_.load(std::memory_order_acquire) < count) pause();
  if (!failed_) return;
  failed_ = false;
  std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Team::serve() {
  while (true) {
    const std::uint32_t seen = job_.load(std::memory_order_acquire);
    if (end_) return;
    while (work(ticket_.load(std::memory_order_acquire))) {
    }
    for (int look = 0; look < kLooks && job_.load(std::memory_order_acquire) == seen; ++look) pause();
    if (job_.load(std::memory_order_acquire) == seen) job_.wait(seen, std::memory_order_acquire);
  }
}

}  // namespace scree
