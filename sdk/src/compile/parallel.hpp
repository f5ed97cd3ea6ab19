/// Loops over independent tasks.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <numeric>
#include <span>
#include <system_error>
#include <thread>
#include <vector>

namespace relievo {

/// Threads that run one loop after another: starting a thread, and filling its allocator's pools, costs more than a
/// short loop saves. They start with the first loop that has work for them, and end with the crew.
class Crew {
 public:
  /// Of `threads` (0 = all that the machine has), the calling one included.
  explicit Crew(unsigned threads) : size_(threads == 0 ? std::max(1u, std::thread::hardware_concurrency()) : threads) {}
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  ~Crew() {
    {
      const std::scoped_lock lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    for (std::thread& other : others_) other.join();
  }

  /// Calls task(i) for every i in this order; returns when all have ended. The first exception of a task is thrown
  /// here.
  template <class Task>
  void run(std::span<const std::size_t> order, const Task& task) {
    run(order.size(), [&](std::size_t k) { task(order[k]); });
  }

  /// The same for every i below `count`.
  template <class Task>
  void run(std::size_t count, const Task& task) {
    std::atomic<std::size_t> next = 0;
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const std::function<void()> work = [&] {
      try {
        for (std::size_t i = next++; i < count; i = next++) task(i);
      } catch (...) {
        const std::scoped_lock lock(failure_mutex);
        if (!failure) failure = std::current_exception();
      }
    };
    if (size_ > 1 && count > 1) begin(work, std::min<std::size_t>(size_, count) - 1);
    work();
    wait();
    if (failure) std::rethrow_exception(failure);
  }

 private:
  void begin(const std::function<void()>& work, std::size_t helpers) {
    {
      const std::scoped_lock lock(mutex_);
      work_ = &work;
      wanted_ = helpers;
      ++loop_;
    }
    changed_.notify_all();
    try {
      while (others_.size() < helpers) others_.emplace_back([this] { help(); });
    } catch (const std::system_error&) {  // no more threads to be had: fewer do the same
    }
  }

  /// Until nobody works on this loop, nor will begin to.
  void wait() {
    std::unique_lock lock(mutex_);
    wanted_ = 0;
    rested_.wait(lock, [&] { return busy_ == 0; });
  }

  void help() {
    std::size_t last = 0;
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return ends_ || (wanted_ > 0 && loop_ != last); });
      if (ends_) return;
      last = loop_;
      --wanted_;
      ++busy_;
      const std::function<void()>& work = *work_;
      lock.unlock();
      work();
      lock.lock();
      if (--busy_ == 0) rested_.notify_one();
    }
  }

  const std::size_t size_;
  std::vector<std::thread> others_;
  std::mutex mutex_;
  std::condition_variable changed_, rested_;
  const std::function<void()>* work_ = nullptr;  ///< of the present loop
  std::size_t loop_ = 0;                         ///< how many loops there have been
  std::size_t wanted_ = 0;                       ///< helpers that the present loop can still use
  std::size_t busy_ = 0;
  bool ends_ = false;
};

/// The order in which `count` tasks of size_of(i) should begin: a long one at the end would leave the other threads
/// idle, and the first begins while those still wake up.
template <class SizeOf>
std::vector<std::size_t> largest_first(std::size_t count, const SizeOf& size_of) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return size_of(a) > size_of(b); });
  return order;
}

/// One loop by a crew of its own.
template <class Task>
void run_parallel(std::size_t count, unsigned threads, const Task& task) {
  Crew(threads).run(count, task);
}

}  // namespace relievo
