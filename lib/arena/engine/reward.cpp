// How lanes run the program of a reward, one instruction for all of them at a time. Compiled once for each
// instruction set, like the problems.
#include "reward.hpp"

#include <cmath>
#include <limits>

#include "simulation.hpp"

BOTSCHOOL_BEGIN

namespace {

template <int L, class Ready, class F>
BOTSCHOOL_INLINE void apply(const Ready& step, F f) {
  double* BOTSCHOOL_RESTRICT to = step.to;  // never one of those that it is made of
  const double *a = step.a, *b = step.b, *c = step.c;
  for (int l = 0; l < L; ++l) to[l] = f(a[l], b[l], c[l]);
}

template <int L, class Ready>
void run(const Ready& step) {
  switch (step.op) {
    case Op::add:
      return apply<L>(step, [](double a, double b, double) { return a + b; });
    case Op::subtract:
      return apply<L>(step, [](double a, double b, double) { return a - b; });
    case Op::multiply:
      return apply<L>(step, [](double a, double b, double) { return a * b; });
    case Op::divide:
      return apply<L>(step, [](double a, double b, double) { return a / b; });
    case Op::smaller:
      return apply<L>(step, [](double a, double b, double) { return a < b ? a : b; });
    case Op::larger:
      return apply<L>(step, [](double a, double b, double) { return a > b ? a : b; });
    case Op::less:
      return apply<L>(step, [](double a, double b, double) { return a < b ? 1.0 : 0.0; });
    case Op::at_most:
      return apply<L>(step, [](double a, double b, double) { return a <= b ? 1.0 : 0.0; });
    case Op::equal:
      return apply<L>(step, [](double a, double b, double) { return a == b ? 1.0 : 0.0; });
    case Op::unequal:
      return apply<L>(step, [](double a, double b, double) { return a != b ? 1.0 : 0.0; });
    case Op::both:
      return apply<L>(step,
                      [](double a, double b, double) { return (a != 0) & (b != 0) ? 1.0 : 0.0; });
    case Op::either:
      return apply<L>(step,
                      [](double a, double b, double) { return (a != 0) | (b != 0) ? 1.0 : 0.0; });
    case Op::size:
      return apply<L>(step, [](double a, double, double) { return std::fabs(a); });
    case Op::root:
      return apply<L>(step, [](double a, double, double) { return std::sqrt(a); });
    case Op::exponential:
      return apply<L>(step, [](double a, double, double) { return exponential(a); });
    case Op::sine:
      return apply<L>(step, [](double a, double, double) {
        double sine, cosine;
        sine_cosine(a, sine, cosine);
        return sine;
      });
    case Op::cosine:
      return apply<L>(step, [](double a, double, double) {
        double sine, cosine;
        sine_cosine(a, sine, cosine);
        return cosine;
      });
    case Op::choose:
      return apply<L>(step, [](double a, double b, double c) { return a != 0 ? b : c; });
  }
}

}  // namespace

template <int L>
const double* Payer<L>::at(Operand operand) const {
  switch (operand.source) {
    case Source::quantity:
      return row[operand.number];
    case Source::before:
      return kept[1 + operand.number];
    case Source::constant:
      return constant[operand.number];
    default:
      return result[operand.number];
  }
}

template <int L>
void Payer<L>::begin(const Program* given, const Info& of) {
  program = given;
  info = of;
  computes = acts = false;
  if (!given) return;
  for (auto& place : slot) place = -1;
  for (int i = 0; i < given->used; ++i) {
    slot[given->quantity[i]] = static_cast<std::int8_t>(i);
    row[i] = nullptr;
  }
}

template <int L>
void Payer<L>::link() {
  const auto& p = *program;
  for (int i = 0; i < p.constants; ++i)
    for (int l = 0; l < L; ++l) constant[i][l] = p.constant[i];
  for (int i = 0; i < p.size; ++i) {
    const Instruction& from = p.code[i];
    code[i] = {from.op, result[from.to], at(from.a), at(from.b), at(from.c)};
  }
  paid = at(p.reward);
  over = at(p.end);
  acts = computes;
  for (int i = 0; i < p.used; ++i)
    acts |= row[i] == effort || (row[i] >= action[0] && row[i] <= action[kMaxActions - 1]);
}

template <int L>
void Payer<L>::start(int lane) {
  kept[0][lane] = 0;
  for (double* own : {reward, ended, time, effort}) own[lane] = 0;
  for (auto& told : action) told[lane] = 0;
}

template <int L>
void Payer<L>::remember(int first, int last) {
  for (int i = 0; i < program->remembered; ++i) {
    const double* from = row[program->before[i]];
    for (int l = first; l < last; ++l) kept[1 + i][l] = from[l];
  }
}

template <int L>
void Payer<L>::note(const double* actions, const double* paid, const std::int64_t* over) {
  for (int l = 0; l < L; ++l) {
    reward[l] = paid[l];
    ended[l] = over[l] != 0 ? 1.0 : 0.0;
    kept[0][l] += 1;
    time[l] = kept[0][l] * info.seconds;
  }
  if (!acts) return;
  const int n = info.robots * (info.discrete ? 1 : info.outputs);
  for (int l = 0; l < L; ++l) effort[l] = 0;
  for (int i = 0; i < n && i < kMaxActions; ++i)
    for (int l = 0; l < L; ++l) {
      const double told = actions[i * L + l], within = limited(told, info.low, info.high);
      action[i][l] = told;
      effort[l] += within * within;
    }
}

template <int L>
void Payer<L>::pay(double* paid_here, std::int64_t* over_here) {
  for (int i = 0; i < program->size; ++i) run<L>(code[i]);
  if (program->pays)
    for (int l = 0; l < L; ++l) paid_here[l] = over_here[l] == kBroken ? 0 : paid[l];
  if (program->ends)
    for (int l = 0; l < L; ++l)
      over_here[l] = (over[l] != 0 ? 1 : 0) | (over_here[l] == kBroken ? 1 : 0);
  remember(0, L);
}

template <int L>
void Payer<L>::list(Quantities<L>& q) const {
  q.row("reward", "", "the problem's own reward for this step", reward);
  q.row("ended", "", "1 where the problem itself ends the episode, else 0", ended);
  q.row("time", "s", "since the start of the episode", time);
  const int n = info.robots * (info.discrete ? 1 : info.outputs);
  const char* what = info.discrete ? "number of the chosen action" : "what this actuator was told";
  for (int i = 0; i < n && i < kMaxActions; ++i)
    q.row({"action", "", n > 1 ? i + 1 : 0}, "", what, action[i]);
  if (!info.discrete) q.row("effort", "", "sum of the squares of all actions", effort);
}

template struct Payer<kLanes>;
template struct Payer<kLanes / 2>;
template struct Payer<1>;

BOTSCHOOL_END
