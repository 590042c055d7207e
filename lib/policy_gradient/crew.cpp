#include "crew.hpp"

#include <system_error>

namespace botschool::policy_gradient {
namespace {

/// Rounds of spinning: about 20 microseconds, what a short step takes.
constexpr int kSpins = 500;

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

template <class Ready>
bool spin(const Ready& ready) {
  for (int i = 0; i < kSpins; ++i) {
    if (ready()) return true;
    pause();
  }
  return ready();
}

}  // namespace

Crew::Crew(int threads) {
  try {
    for (int t = 1; t < threads; ++t) others_.emplace_back([this, t] { loop(t); });
  } catch (const std::system_error&) {
    // the system gives no more threads: those that there are do all the work
  }
}

Crew::~Crew() {
  quit_ = true;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++round_;
  }
  wake_.notify_all();
  for (auto& thread : others_) thread.join();
}

void Crew::share(int tasks) {
  tasks_ = tasks;
  next_ = 0;
  busy_ = static_cast<int>(others_.size());
  ++round_;
  if (asleep_ > 0) {  // a thread that falls asleep now looks at round_ first, under the mutex
    const std::lock_guard<std::mutex> lock(mutex_);
    wake_.notify_all();
  }
  work(0);
  const auto ready = [this] { return busy_ == 0; };
  if (spin(ready)) return;
  std::unique_lock<std::mutex> lock(mutex_);
  done_.wait(lock, ready);
}

void Crew::work(int thread) {
  for (int task; (task = next_.fetch_add(1)) < tasks_;) call_(work_, task, thread);
}

void Crew::loop(int thread) {
  for (unsigned seen = 0;; ++seen) {
    const auto ready = [&] { return round_ != seen; };
    if (!spin(ready)) {
      std::unique_lock<std::mutex> lock(mutex_);
      ++asleep_;
      wake_.wait(lock, ready);
      --asleep_;
    }
    if (quit_) return;
    work(thread);
    if (--busy_ == 0) {
      const std::lock_guard<std::mutex> lock(mutex_);
      done_.notify_one();
    }
  }
}

}  // namespace botschool::policy_gradient
