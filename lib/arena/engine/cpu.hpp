// Which instruction sets this machine and its operating system offer.
#pragma once

namespace botschool {

bool cpu_has_avx2();
bool cpu_has_avx512();

}  // namespace botschool
