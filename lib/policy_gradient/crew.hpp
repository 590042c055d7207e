// Threads that share out the tasks of a step. Who does which task changes no result.
#pragma once

#ifndef __wasm__
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>
#endif

namespace botschool::policy_gradient {

#ifdef __wasm__  // a page has one thread

struct Crew {
  explicit Crew(int) {}
  int threads() const { return 1; }
  template <class F>
  void run(int tasks, const F& f) {
    for (int i = 0; i < tasks; ++i) f(i, 0);
  }
};

#else

/// Steps are short, so a thread waits for the next one by spinning; after a while it sleeps, for the
/// machine may have other work. Nobody waits for a thread that has no task: where others keep the
/// cores busy, the caller does all tasks itself.
class Crew {
 public:
  explicit Crew(int threads);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  int threads() const { return static_cast<int>(others_.size()) + 1; }

  /// Calls f(task, thread) for each task.
  template <class F>
  void run(int tasks, const F& f) {
    if (others_.empty() || tasks < 2) {
      for (int i = 0; i < tasks; ++i) f(i, 0);
      return;
    }
    call_ = [](const void* f, int task, int thread) { (*static_cast<const F*>(f))(task, thread); };
    work_ = &f;
    share(tasks);
  }

 private:
  void share(int tasks);
  void work(int thread);
  void loop(int thread);

  const bool spins_;                         ///< whether each thread can have a core
  alignas(64) std::atomic<int> waiting_{0};  ///< tasks that no thread has taken
  alignas(64) std::atomic<int> unfinished_{0};
  std::atomic<int> asleep_{0};
  std::atomic<bool> quit_{false};
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  void (*call_)(const void*, int, int) = nullptr;
  const void* work_ = nullptr;
  int tasks_ = 0;
  std::vector<std::thread> others_;
};

#endif

}  // namespace botschool::policy_gradient
