// Threads that share out the tasks of a step. Who does which task changes no result.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace botschool::policy_gradient {

/// Steps are short, so that waiting for the next one begins by spinning; after a while a thread sleeps,
/// for the machine may have other work.
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

  std::vector<std::thread> others_;
  std::atomic<unsigned> round_{0};
  std::atomic<int> next_{0}, busy_{0}, asleep_{0};
  std::atomic<bool> quit_{false};
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  int tasks_ = 0;
  void (*call_)(const void*, int, int) = nullptr;
  const void* work_ = nullptr;
};

}  // namespace botschool::policy_gradient
