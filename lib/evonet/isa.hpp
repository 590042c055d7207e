// One source, several instruction sets: every header of the inner loops opens its code with
// BOTSCHOOL_BEGIN, so that each build of it (plain, AVX2, AVX-512) has names of its own and the
// linker never mixes them. See arena/engine/kernel.cpp.
#pragma once

#ifndef BOTSCHOOL_ISA
#define BOTSCHOOL_ISA baseline
#endif

#define BOTSCHOOL_BEGIN \
  namespace botschool { \
  inline namespace BOTSCHOOL_ISA {
#define BOTSCHOOL_END \
  }                   \
  }

#if defined(_MSC_VER)
#define BOTSCHOOL_RESTRICT __restrict
#define BOTSCHOOL_INLINE __forceinline
#define BOTSCHOOL_INLINE_LAMBDA [[msvc::forceinline]]
#define BOTSCHOOL_OUTLINE __declspec(noinline)
#else
#define BOTSCHOOL_RESTRICT __restrict__
#define BOTSCHOOL_INLINE inline __attribute__((always_inline))
#define BOTSCHOOL_INLINE_LAMBDA __attribute__((always_inline))
#define BOTSCHOOL_OUTLINE __attribute__((noinline))
#endif

#define BOTSCHOOL_PRAGMA(text) _Pragma(#text)
/// Before a loop: does n rounds of it at a time (a hint).
#if defined(__clang__)
#define BOTSCHOOL_UNROLL(n) BOTSCHOOL_PRAGMA(unroll n)
#elif defined(__GNUC__)
#define BOTSCHOOL_UNROLL(n) BOTSCHOOL_PRAGMA(GCC unroll n)
#else
#define BOTSCHOOL_UNROLL(n)
#endif

BOTSCHOOL_BEGIN

/// Bytes of a vector register.
#if defined(__AVX512F__)
constexpr int kRegister = 64;
#elif defined(__AVX__)
constexpr int kRegister = 32;
#else
constexpr int kRegister = 16;
#endif

BOTSCHOOL_END
