// Compiled once per instruction set, with BOTSCHOOL_ISA naming it (see lib/CMakeLists.txt). Nothing
// but the inner loops is compiled here, so no shared inline function can end up using instructions
// that the machine lacks.
#include "kernel.hpp"

#include "generated/problem_list.hpp"
#include "rollout.hpp"

namespace botschool {
namespace {

/// Episodes in lockstep: one AVX-512 register of single-precision numbers.
constexpr int kLanes = 16;

template <template <int> class Problem>
Info given(const Setting& setting) {
  return Problem<1>::given(Problem<1>::info(), setting);
}

template <template <int> class Problem>
Kernel kernel() {
  using R = Rollout<Problem, kLanes>;
  return {Problem<1>::info(), &given<Problem>, kLanes, &R::workspace, &R::run};
}

template <template <int> class... Problem>
KernelTable table(ProblemList<Problem...>) {
  static const Kernel kernels[] = {kernel<Problem>()...};
  return {kernels, sizeof...(Problem)};
}

}  // namespace

#define TABLE_OF(isa) kernel_table_##isa
#define TABLE(isa) TABLE_OF(isa)
KernelTable TABLE(BOTSCHOOL_ISA)() { return table(NativeProblems()); }

}  // namespace botschool
