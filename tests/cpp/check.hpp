// The least that tests need: TEST(name) { CHECK(...); } anywhere, run by main.cpp.
#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

struct Test {
  const char* name;
  void (*run)();
};

inline std::vector<Test>& all_tests() {
  static std::vector<Test> tests;
  return tests;
}

struct Registered {
  Registered(const char* name, void (*run)()) { all_tests().push_back({name, run}); }
};

/// Ends the test that it is thrown in.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

#define TEST(name)                                        \
  static void name();                                     \
  static const Registered registered_##name(#name, name); \
  static void name()

#define CHECK(condition)                                                                     \
  do {                                                                                       \
    if (!(condition))                                                                        \
      throw Failure(std::string(__FILE__ ":") + std::to_string(__LINE__) + ": " #condition); \
  } while (false)

/// Whether f() throws std::invalid_argument with these words in it.
template <class F>
bool refused(F f, const std::string& words) {
  try {
    f();
  } catch (const std::invalid_argument& error) {
    return std::string(error.what()).find(words) != std::string::npos;
  }
  return false;
}
