#pragma once
// A few threads that share the loops of a step.
//
// A step has loops of some ten microseconds one after another. Workers of a task library that fall asleep in
// between miss most of them (oneTBB: no gain at all), and a barrier that waits for all workers waits for one
// that the system has taken off its processor (OpenMP: many times slower on a busy machine). Here a worker
// looks out for some tens of microseconds before it sleeps, and whoever gives out the work does it alone if
// nobody comes.
#include <atomic>
#include <cstdint>
#include <exception>
#include <thread>
#include <type_traits>
#include <vector>

namespace scree {

class Team {
 public:
  /// `threads` in all, the caller's included.
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// Calls body(k) for k from 0 to count - 1, beginning in this order, on any thread; one thread keeps the
  /// order. When bodies throw (no memory), the first of them to do so is heard when all that were begun
  /// have ended. One caller at a time.
  template <class Body>
  void run(int count, Body&& body) {
    if (workers_.empty() || count < 2) {
      for (int k = 0; k < count; ++k) body(k);
      return;
    }
    using Plain = std::remove_reference_t<Body>;
    share(
        count, [](void* what, int k) { (*static_cast<Plain*>(what))(k); },
        const_cast<void*>(static_cast<const void*>(&body)));
  }

 private:
  using Call = void (*)(void* body, int k);
  void share(int count, Call call, void* body);
  bool work(std::uint64_t ticket);
  void serve();

  // Job number << 32 | next k. A k is taken by counting up; the job's other fields are read before that and
  // hold if it succeeds, because a job does not end before all that was taken is done.
  std::atomic<std::uint64_t> ticket_{0};
  std::atomic<int> count_{0}, done_{0};
  std::atomic<Call> call_{nullptr};
  std::atomic<void*> body_{nullptr};
  std::atomic<std::uint32_t> job_{0};  // what sleeping workers wait for
  std::atomic<bool> end_{false}, failed_{false};
  std::exception_ptr failure_;  // of the job; the first
  std::vector<std::thread> workers_;
};

}  // namespace scree
