// Compiled once per instruction set, with BOTSCHOOL_ISA naming it (see lib/CMakeLists.txt). Nothing
// but the inner loops is compiled here, so no shared inline function can end up using instructions
// that the machine lacks.
#include "kernel.hpp"

#include "generated/problem_list.hpp"
#include "rollout.hpp"

BOTSCHOOL_BEGIN

// rollout.cpp
std::size_t workspace(const void* entry, const Layout& layout, const Setting& setting);
void run(const void* entry, const Layout& layout, const Jobs& jobs, Queue& queue, Recorder* recorder,
         void* memory);

namespace {

template <template <int> class Problem>
Kernel kernel() {
  static const Entry made = entry<Problem>();
  return {made.info, made.given, kLanes, &made, &workspace, &run};
}

template <template <int> class... Problem>
KernelTable table(ProblemList<Problem...>) {
  static const Kernel kernels[] = {kernel<Problem>()...};
  return {kernels, sizeof...(Problem)};
}

}  // namespace
BOTSCHOOL_END

namespace botschool {

#define TABLE_OF(isa) kernel_table_##isa
#define TABLE(isa) TABLE_OF(isa)
KernelTable TABLE(BOTSCHOOL_ISA)() { return table(NativeProblems()); }

}  // namespace botschool
