// A reward of one's own: a short program over the quantities that a problem names. expression.cpp makes
// it from text, and all lanes run it. docs/specification.md, "Rewards of one's own".
#pragma once

#include <cstddef>
#include <cstdint>

#include "problem.hpp"

namespace botschool {

enum class Op : std::uint8_t {
  add,
  subtract,
  multiply,
  divide,
  smaller,
  larger,
  less,
  at_most,
  equal,
  unequal,
  both,
  either,
  size,
  root,
  exponential,
  sine,
  cosine,
  choose  // choose: b where a is not 0, else c
};

/// Where an instruction reads a row of lanes: numbers of quantities are places in Program::quantity.
enum class Source : std::uint8_t { quantity, before, constant, result };
struct Operand {
  Source source = Source::result;
  std::uint8_t number = 0;
};
struct Instruction {
  Op op;
  std::uint8_t to;  ///< the result's number
  Operand a, b, c;
};

/// The most that a program has.
constexpr int kMaxCode = 160, kMaxConstants = 32, kMaxResults = 24, kMaxUsed = 40, kMaxBefore = 16;
/// The most that a problem names, and that its robots have of actuators.
constexpr int kMaxQuantities = 512, kMaxActions = 64;

/// Plain data: kernels of all instruction sets read it.
struct Program {
  int size, constants, used, remembered;
  Instruction code[kMaxCode];
  double constant[kMaxConstants];
  std::uint16_t
      quantity[kMaxUsed];           ///< numbers of quantities, in the order in which they are named
  std::uint8_t before[kMaxBefore];  ///< which of them are remembered for the next step
  bool pays, ends;                  ///< whether there is a reward, and an end of the episode
  Operand reward, end;
};

/// Takes the names of quantities. A quantity that `differs` is how much a row grows in a second.
using TellQuantity = void (*)(void* to, const char* name, int number, const char* suffix,
                              const char* unit, const char* meaning, bool differs);

}  // namespace botschool

BOTSCHOOL_BEGIN

template <int L>
class Quantities;

/// Runs a program for L lanes after each step of a problem.
template <int L>
struct Payer {
  const Program* program = nullptr;
  Info info;
  bool computes;                     ///< whether a quantity is more than a row that exists anyway
  bool acts;                         ///< whether actions are needed
  std::int8_t slot[kMaxQuantities];  ///< where a quantity is among those in use, or -1
  const double* row[kMaxUsed];       ///< its lanes

  struct Ready {
    Op op;
    double* to;
    const double *a, *b, *c;
  };
  Ready code[kMaxCode];
  const double *paid, *over;

  /// Steps done, then what is remembered: they move with an episode to another lane.
  alignas(64) double kept[1 + kMaxBefore][L];
  double constant[kMaxConstants][L], result[kMaxResults][L], computed[kMaxUsed][L];
  double reward[L], ended[L], time[L], effort[L], action[kMaxActions][L];
  double scratch[L];

  int keeps() const { return program ? 1 + program->remembered : 0; }

  /// Before Quantities are listed, and after.
  void begin(const Program* given, const Info& of);
  void link();
  /// A lane's episode starts: what was paid and done before is forgotten. Then what the lane
  /// remembers.
  void start(int lane);
  void remember(int first, int last);
  /// After a step of the problem: keeps what it paid. Then runs the program and replaces it.
  void note(const double* actions, const double* paid, const std::int64_t* over);
  void pay(double* paid, std::int64_t* over);
  /// The quantities that every problem has.
  void list(Quantities<L>& q) const;

 private:
  const double* at(Operand operand) const;
};

/// Goes through the quantities of a problem: to tell their names, to find their rows, or to compute
/// those in use for the lanes from `first` to `last`.
template <int L>
class Quantities {
 public:
  Quantities(TellQuantity tell, void* to) : tell_(tell), to_(to) {}
  explicit Quantities(Payer<L>& payer) : payer_(&payer) {}
  Quantities(Payer<L>& payer, int first, int last)
      : payer_(&payer), computing_(true), first_(first), last_(last) {}

  struct Name {
    Name(const char* name, const char* suffix = "", int number = 0)
        : name(name), suffix(suffix), number(number) {}
    const char *name, *suffix;
    int number;  ///< written behind the name, unless it is 0
  };

  /// Lanes that the problem has anyway.
  void row(Name name, const char* unit, const char* meaning, const double* lanes) {
    next(name, unit, meaning, lanes, false);
  }
  /// How much such lanes have grown in the step, for each second.
  void growth(Name name, const char* unit, const char* meaning, const double* lanes) {
    next(name, unit, meaning, lanes, true);
  }
  /// What f(lane) gives.
  template <class F>
  void value(Name name, const char* unit, const char* meaning, F f) {
    double* to = next(name, unit, meaning, nullptr, false);
    if (!to) return;
    for (int l = first_; l < last_; ++l) to[l] = f(l);
  }
  /// What actuator i was told in this step, within its range; 0 before the first one.
  double action(int i, int lane) const {
    return limited(payer_->action[i][lane], payer_->info.low, payer_->info.high);
  }

 private:
  double* next(const Name& name, const char* unit, const char* meaning, const double* lanes,
               bool differs) {
    const int number = count_++;
    if (tell_) {
      tell_(to_, name.name, name.number, name.suffix, unit, meaning, differs);
      return nullptr;
    }
    const int slot = number < kMaxQuantities ? payer_->slot[number] : -1;
    if (slot < 0) return nullptr;
    if (computing_) return payer_->computed[slot];
    payer_->computes |= !lanes;
    payer_->row[slot] = lanes ? lanes : payer_->computed[slot];
    return nullptr;
  }

  TellQuantity tell_ = nullptr;
  void* to_ = nullptr;
  Payer<L>* payer_ = nullptr;
  bool computing_ = false;
  int first_ = 0, last_ = 0, count_ = 0;
};

/// A problem that pays what its user's program says, if there is one.
template <template <int> class Problem, int L>
struct Paid : Problem<L> {
  Payer<L> payer;

  void list(Quantities<L>& q) const {
    payer.list(q);
    Problem<L>::quantities(q);
  }
  void set(const Setting& setting) {
    Problem<L>::set(setting);
    payer.begin(setting.program, Problem<L>::given(Problem<L>::info(), setting));
    if (!payer.program) return;
    Quantities<L> q(payer);
    list(q);
    payer.link();
  }
  void start(int lane, Random& random) {
    Problem<L>::start(lane, random);
    if (!payer.program) return;
    payer.start(lane);
    look(lane);
  }
  /// What a lane remembers, after its state has been set.
  void look(int lane) {
    if (payer.computes) compute(lane, lane + 1);
    payer.remember(lane, lane + 1);
  }
  void step(const double* action, double* reward, std::int64_t* ended) {
    Problem<L>::step(action, reward, ended);
    if (!payer.program) return;
    payer.note(action, reward, ended);
    if (payer.computes) compute(0, L);
    payer.pay(reward, ended);
  }

 private:
  void compute(int first, int last) {
    Quantities<L> q(payer, first, last);
    list(q);
  }
};

BOTSCHOOL_END
