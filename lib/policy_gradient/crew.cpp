#include "crew.hpp"

#include <chrono>
#include <system_error>

namespace botschool::policy_gradient {
namespace {

/// About twice the time that waking a thread takes: longer waits are rare, and then sleeping is cheaper.
constexpr std::chrono::microseconds kSpin{100};

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

template <class Ready>
bool spin(const Ready& ready) {
  const auto end = std::chrono::steady_clock::now() + kSpin;
  do {
    for (int i = 0; i < 16; ++i) {
      if (ready()) return true;
      pause();
    }
  } while (std::chrono::steady_clock::now() < end);
  return ready();
}

}  // namespace

Crew::Crew(int threads) : spins_(threads <= static_cast<int>(std::thread::hardware_concurrency())) {
  try {
    for (int t = 1; t < threads; ++t) others_.emplace_back([this, t] { loop(t); });
  } catch (const std::system_error&) {
    // the system gives no more threads: the existing ones do all the work
  }
}

Crew::~Crew() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    quit_ = true;
  }
  wake_.notify_all();
  for (auto& thread : others_) thread.join();
}

void Crew::share(int tasks) {
  tasks_ = tasks;
  unfinished_ = tasks;
  waiting_ = tasks;
  if (asleep_ > 0) {  // a thread that falls asleep now looks at waiting_ first, under the mutex
    const std::lock_guard<std::mutex> lock(mutex_);
    wake_.notify_all();
  }
  work(0);
  const auto ready = [this] { return unfinished_ == 0; };
  if (spins_ && spin(ready)) return;
  std::unique_lock<std::mutex> lock(mutex_);
  done_.wait(lock, ready);
}

/// A task that was taken keeps share() from returning, so that call_, work_ and tasks_ belong to it.
void Crew::work(int thread) {
  for (int left = waiting_; left > 0;) {
    if (!waiting_.compare_exchange_weak(left, left - 1)) continue;
    call_(work_, tasks_ - left, thread);  // the caller begins: task 0 is usually its own
    if (--unfinished_ == 0 && thread > 0) {
      const std::lock_guard<std::mutex> lock(mutex_);
      done_.notify_one();
    }
    left = waiting_;
  }
}

void Crew::loop(int thread) {
  const auto ready = [this] { return waiting_ > 0 || quit_; };
  while (!quit_) {
    if (!spins_ || !spin(ready)) {
      std::unique_lock<std::mutex> lock(mutex_);
      ++asleep_;
      if (!ready()) wake_.wait(lock);
      --asleep_;
    }
    work(thread);
  }
}

}  // namespace botschool::policy_gradient
