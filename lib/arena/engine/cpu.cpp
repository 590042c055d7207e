#include "cpu.hpp"

#ifdef BOTSCHOOL_X86
#ifdef _MSC_VER
#include <immintrin.h>
#include <intrin.h>

namespace botschool {
namespace {

bool feature(int bit) {  // of leaf 7, EBX
  int leaf[4];
  __cpuidex(leaf, 7, 0);
  return (leaf[1] >> bit & 1) != 0;
}

bool system_saves(unsigned long long registers) {
  int leaf[4];
  __cpuid(leaf, 1);
  const bool has_xgetbv = (leaf[2] >> 27 & 1) != 0;
  return has_xgetbv && (_xgetbv(0) & registers) == registers;
}

}  // namespace

bool cpu_has_avx2() { return system_saves(0x6) && feature(5); }
bool cpu_has_avx512() {
  return system_saves(0xe6) && feature(16) && feature(17) && feature(30) && feature(31);
}

}  // namespace botschool
#else
namespace botschool {

bool cpu_has_avx2() { return __builtin_cpu_supports("avx2"); }
bool cpu_has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
}

}  // namespace botschool
#endif
#endif
