// The table of kernels of one instruction set, which BOTSCHOOL_ISA names (lib/CMakeLists.txt). Only
// this file, the rollout and the problems are compiled with the flags of that instruction set. So
// no shared inline function can use instructions that the machine lacks.
#include "kernel.hpp"

#include "generated/problem_list.hpp"
#include "simulation.hpp"

BOTSCHOOL_BEGIN

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
