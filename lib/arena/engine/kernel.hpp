// The tables of kernels that arena/engine/kernel.cpp makes, one per instruction set.
#pragma once

#include <cstddef>

namespace botschool {

struct Kernel;
struct KernelTable {
  const Kernel* kernel;
  std::size_t count;
};

KernelTable kernel_table_baseline();
#ifdef BOTSCHOOL_X86
KernelTable kernel_table_avx2();
KernelTable kernel_table_avx512();
#endif

}  // namespace botschool
