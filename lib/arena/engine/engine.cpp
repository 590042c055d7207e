#include "engine.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "cpu.hpp"
#include "generated/problem_list.hpp"

namespace botschool {
namespace {

KernelTable table_for(const std::string& instruction_set) {
  const auto known = instruction_sets();
  const std::string& name = instruction_set.empty() ? known.back() : instruction_set;
  bool found = false;
  for (const auto& each : known) found |= each == name;
  if (!found) throw std::invalid_argument("this machine has no instruction set '" + name + "'.");
#ifdef BOTSCHOOL_AVX512
  if (name == "avx512") return kernel_table_avx512();
#endif
#ifdef BOTSCHOOL_AVX2
  if (name == "avx2") return kernel_table_avx2();
#endif
  return kernel_table_baseline();
}

class SharedQueue final : public Queue {
 public:
  explicit SharedQueue(std::size_t count) : count_(static_cast<std::ptrdiff_t>(count)) {}
  std::ptrdiff_t next() override {
    const std::ptrdiff_t job = next_.fetch_add(1, std::memory_order_relaxed);
    return job < count_ ? job : -1;
  }

 private:
  std::atomic<std::ptrdiff_t> next_{0};
  std::ptrdiff_t count_;
};

template <template <int> class... Problem>
std::unique_ptr<Stepper> find_stepper(const std::string& name, ProblemList<Problem...>) {
  const KernelTable table = kernel_table_baseline();  // in the order of the list
  std::unique_ptr<Stepper> found;
  std::size_t i = 0;
  ((table.kernel[i++].info.name == name ? void(found = stepper<Problem>()) : void()), ...);
  return found;
}

}  // namespace

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names{"baseline"};
#ifdef BOTSCHOOL_AVX2
  if (cpu_has_avx2()) names.push_back("avx2");
#endif
#ifdef BOTSCHOOL_AVX512
  if (cpu_has_avx2() && cpu_has_avx512()) names.push_back("avx512");
#endif
  return names;
}

const Kernel* find_kernel(const std::string& problem, const std::string& instruction_set) {
  const KernelTable table = table_for(instruction_set);
  for (std::size_t i = 0; i < table.count; ++i)
    if (problem == table.kernel[i].info.name) return &table.kernel[i];
  throw std::invalid_argument("there is no native problem '" + problem + "'.");
}

std::vector<Info> native_problems() {
  const KernelTable table = kernel_table_baseline();
  std::vector<Info> infos;
  for (std::size_t i = 0; i < table.count; ++i) infos.push_back(table.kernel[i].info);
  return infos;
}

Engine::Engine(const std::string& problem, const Spec& spec, const std::string& instruction_set,
               const Setting& setting)
    : layout_(make_layout(spec)),
      kernel_(find_kernel(problem, instruction_set)),
      info_(kernel_->given(setting)) {
  const Info& info = info_;
  if (spec.inputs != info.observations || spec.outputs != info.outputs)
    throw std::invalid_argument(std::string(info.name) + " needs a network of " +
                                std::to_string(info.observations) + " inputs and " +
                                std::to_string(info.outputs) + " outputs.");
}

void Engine::run(const Jobs& jobs, Queue& queue, Recorder* recorder) const {
  const Info given = kernel_->given(jobs.setting);
  if (given.robots != info_.robots || given.observations != info_.observations)
    throw std::invalid_argument("these episodes are of another arena than the engine's.");
  constexpr std::align_val_t alignment{64};
  const auto release = [&](void* p) { ::operator delete(p, alignment); };
  const std::unique_ptr<void, decltype(release)> workspace(
      ::operator new(kernel_->workspace(kernel_->entry, layout_, jobs.setting), alignment),
      release);
  kernel_->run(kernel_->entry, layout_, jobs, queue, recorder, workspace.get());
}

void Engine::evaluate(const Jobs& jobs, int threads) const {
  const std::size_t count = jobs.count;
  SharedQueue queue(count);
  // a thread's lanes cost the same whether they are used or not: fill one thread's lanes before
  // using another thread; one thread does a batch that takes no longer than starting a thread
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t loads = (count + kernel_->lanes - 1) / kernel_->lanes;
  const bool small = seconds_per_job_ * static_cast<double>(count) < 200e-6;
  const int useful = small ? 1 : static_cast<int>(std::min<std::size_t>(threads, loads));
  std::vector<std::thread> others;
  std::vector<std::exception_ptr> errors(std::max(useful, 1));
  const auto work = [&](int t) {
    try {
      run(jobs, queue, nullptr);
    } catch (...) {
      errors[t] = std::current_exception();
    }
  };
  try {
    for (int t = 1; t < useful; ++t) others.emplace_back(work, t);
  } catch (const std::system_error&) {
    // the system gives no more threads: the existing ones do all the work
  }
  work(0);
  for (auto& thread : others) thread.join();
  for (const auto& error : errors)
    if (error) std::rethrow_exception(error);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  if (count > 0) seconds_per_job_ = took.count() * useful / static_cast<double>(count);
}

void Engine::record(const Jobs& jobs, Recorder& recorder) const {
  SharedQueue queue(1);
  run(jobs, queue, &recorder);
}

std::unique_ptr<Stepper> make_stepper(const std::string& problem) {
  auto stepper = find_stepper(problem, NativeProblems());
  if (!stepper) throw std::invalid_argument("there is no native problem '" + problem + "'.");
  return stepper;
}

}  // namespace botschool
