#pragma once
// Work whose parts do not depend on one another.
#include <algorithm>
#include <atomic>
#include <exception>
#include <future>
#include <vector>

namespace scree {

/// Calls body(k) for k from 0 to count - 1 on `threads` threads, the caller's among them. What a body throws
/// is thrown when all threads have ended.
template <class Body>
void in_parallel(std::size_t count, int threads, const Body& body) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < count; k = next++) body(k);
  };
  std::vector<std::future<void>> others;
  for (std::size_t t = 1; t < std::min(count, static_cast<std::size_t>(std::max(threads, 1))); ++t)
    others.push_back(std::async(std::launch::async, work));
  std::exception_ptr failure;
  const auto wait_for = [&](const auto& part) {
    try {
      part();
    } catch (...) {
      failure = std::current_exception();
      next = count;
    }
  };
  wait_for(work);
  for (std::future<void>& other : others) wait_for([&] { other.get(); });
  if (failure) std::rethrow_exception(failure);
}

}  // namespace scree
