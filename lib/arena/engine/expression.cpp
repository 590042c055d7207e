#include "expression.hpp"

#include "words.hpp"

namespace botschool {
namespace {

constexpr std::size_t kLongest = 1000;  // characters of an expression
constexpr int kDeepest = 60;            // brackets within brackets

struct Function {
  const char* name;
  int least, most;  // arguments
  Op op;
};
constexpr Function kFunctions[] = {{"min", 2, 99, Op::smaller},    {"max", 2, 99, Op::larger},
                                   {"abs", 1, 1, Op::size},        {"sqrt", 1, 1, Op::root},
                                   {"exp", 1, 1, Op::exponential}, {"sin", 1, 1, Op::sine},
                                   {"cos", 1, 1, Op::cosine},      {"clip", 3, 3, Op::smaller},
                                   {"where", 3, 3, Op::choose},    {"change", 1, 1, Op::subtract}};
constexpr const char* kWords[] = {"and", "or", "not", "if", "else", "True", "False"};

/// Changes of one letter that lead from one word to another.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t corner = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t same = corner + (a[i - 1] != b[j - 1]);
      corner = row[j];
      row[j] = std::min({same, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::string nearest_of(const std::string& word, const std::vector<std::string>& known) {
  std::string found;
  std::size_t best = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const auto& name : known) {
    const std::size_t away = distance(word, name);
    if (away < best) best = away, found = name;
  }
  return found;
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// Reads one expression from left to right and writes instructions as it goes. The first thing that is
/// wrong becomes `error`, and the rest of the text is skipped.
class Compiler : public Words {
 public:
  Compiler(const char* key, const std::string& text, const Info& info,
           const std::vector<Quantity>& known, Program& program)
      : Words(key, text), info_(info), known_(known), program_(program) {}

  Operand compile() {
    if (text_.size() > kLongest) fail("it has more than 1000 characters");
    take();
    const Operand value = choice();
    if (kind_ != Kind::end) stray();
    return value;
  }

 private:
  Operand fail(const std::string& reason) {
    wrong(reason);
    return {};
  }

  Operand stray() {
    if (!error_.empty()) return {};
    if (kind_ == Kind::end) return fail("it ends too early: something is missing at its end");
    if (is("=")) return fail("'=' has no meaning here: write == to compare");
    if (is(")")) return fail("there is a ')' without its '('");
    if (kind_ == Kind::sign) return fail("'" + word_ + "' does not fit where it stands");
    return fail("there is no sign before " + (kind_ == Kind::number ? word_ : "'" + word_ + "'"));
  }

  // --- instructions ---

  /// Keeps a result for one more use.
  Operand hold(Operand x) {
    if (x.source == Source::result) ++uses_[x.number];
    return x;
  }

  Operand emit(Op op, Operand a, Operand b, Operand c) {
    if (!error_.empty()) return {};
    if (program_.size == kMaxCode) return fail("it is too long: at most 160 operations");
    int to = 0;
    while (to < kMaxResults && uses_[to] > 0) ++to;
    if (to == kMaxResults)
      return fail("it keeps too many results at a time: write it in another order");
    uses_[to] = 1;
    program_.code[program_.size++] = {op, static_cast<std::uint8_t>(to), a, b, c};
    for (const Operand* x : {&a, &b, &c})
      if (x->source == Source::result) --uses_[x->number];
    return {Source::result, static_cast<std::uint8_t>(to)};
  }
  Operand emit(Op op, Operand a, Operand b) { return emit(op, a, b, constant(0)); }
  Operand emit(Op op, Operand a) { return emit(op, a, constant(0), constant(0)); }

  Operand constant(double value) {
    int i = 0;
    while (i < program_.constants && program_.constant[i] != value) ++i;
    if (i == kMaxConstants) return fail("it has too many numbers: at most 32 different ones");
    if (i == program_.constants) program_.constant[program_.constants++] = value;
    return {Source::constant, static_cast<std::uint8_t>(i)};
  }

  Operand used(std::size_t number) {
    int i = 0;
    while (i < program_.used && program_.quantity[i] != number) ++i;
    if (i == kMaxUsed) return fail("it names too many quantities: at most 40");
    if (i == program_.used) program_.quantity[program_.used++] = static_cast<std::uint16_t>(number);
    return {Source::quantity, static_cast<std::uint8_t>(i)};
  }

  /// How much a quantity has changed in the step.
  Operand changed(std::size_t number) {
    const Operand now = used(number);
    int i = 0;
    while (i < program_.remembered && program_.before[i] != now.number) ++i;
    if (i == kMaxBefore)
      return fail("it compares too many quantities with the last step: at most 16");
    if (i == program_.remembered) program_.before[program_.remembered++] = now.number;
    return emit(Op::subtract, now, {Source::before, static_cast<std::uint8_t>(i)});
  }

  // --- grammar, from what binds least to what binds most ---

  Operand choice() {
    if (++depth_ > kDeepest) return fail("it has too many brackets within brackets");
    Operand value = either();
    if (takes("if")) {
      const Operand when = either();
      if (!takes("else"))
        return error_.empty() ? fail("'if' needs an 'else': write a if b else c") : Operand{};
      const Operand otherwise = choice();
      value = emit(Op::choose, when, value, otherwise);
    }
    --depth_;
    return value;
  }

  Operand either() {
    Operand value = both();
    while (takes("or")) {
      const Operand right = both();
      value = emit(Op::either, value, right);
    }
    return value;
  }

  Operand both() {
    Operand value = negation();
    while (takes("and")) {
      const Operand right = negation();
      value = emit(Op::both, value, right);
    }
    return value;
  }

  Operand negation() {
    if (++depth_ > kDeepest) return fail("it has too many brackets within brackets");
    const Operand value = takes("not") ? emit(Op::equal, negation(), constant(0)) : comparison();
    --depth_;
    return value;
  }

  bool compares() const {
    return kind_ == Kind::sign &&
           (word_[0] == '<' || word_[0] == '>' || word_ == "==" || word_ == "!=");
  }

  Operand comparison() {
    Operand left = sum(), all;
    for (bool first = true; compares(); first = false) {
      const std::string sign = word_;
      take();
      const Operand right = sum();
      if (compares()) hold(right);
      const bool turned = sign[0] == '>';
      const Op op = sign == "=="       ? Op::equal
                    : sign == "!="     ? Op::unequal
                    : sign.size() == 2 ? Op::at_most
                                       : Op::less;
      const Operand now = turned ? emit(op, right, left) : emit(op, left, right);
      all = first ? now : emit(Op::both, all, now);
      left = right;
      if (!compares()) return all;
    }
    return left;
  }

  Operand sum() {
    Operand value = product();
    while (is("+") || is("-")) {
      const Op op = is("+") ? Op::add : Op::subtract;
      take();
      const Operand right = product();
      value = emit(op, value, right);
    }
    return value;
  }

  Operand product() {
    Operand value = signed_value();
    while (is("*") || is("/")) {
      const Op op = is("*") ? Op::multiply : Op::divide;
      take();
      const Operand right = signed_value();
      value = emit(op, value, right);
    }
    return value;
  }

  Operand signed_value() {
    if (++depth_ > kDeepest) return fail("it has too many signs in a row");
    Operand value;
    if (takes("-")) {
      const Operand of = signed_value();
      value = of.source == Source::constant ? constant(-program_.constant[of.number])
                                            : emit(Op::multiply, of, constant(-1));
    } else if (takes("+")) {
      value = signed_value();
    } else if (takes("not")) {  // as in 2 * not ended
      const Operand of = signed_value();
      value = emit(Op::equal, of, constant(0));
    } else {
      value = power();
    }
    --depth_;
    return value;
  }

  Operand power() {
    const Operand base = atom();
    if (!takes("**")) return base;
    const bool whole = kind_ == Kind::number && value_ == static_cast<int>(value_);
    const double exponent = value_;
    if (kind_ == Kind::number && exponent == 0.5) {
      take();
      return emit(Op::root, base);
    }
    if (!whole || exponent < 1 || exponent > 8)
      return fail("an exponent is a whole number from 1 to 8, or 0.5");
    take();
    for (int i = 1; i < exponent; ++i) hold(base);
    Operand value = base;
    for (int i = 1; i < exponent; ++i) value = emit(Op::multiply, value, base);
    return value;
  }

  Operand atom() {
    if (kind_ == Kind::number) {
      const Operand value = constant(value_);
      take();
      return value;
    }
    if (takes("(")) {
      const Operand value = choice();
      return closed(value);
    }
    if (kind_ != Kind::name) return stray();
    const std::string name = word_;
    if (name == "True" || name == "False") {
      take();
      return constant(name == "True");
    }
    for (const char* word : kWords)
      if (name == word) return fail("'" + name + "' does not fit where it stands");
    take();
    return takes("(") ? call(name) : quantity(name);
  }

  Operand closed(Operand value) {
    if (takes(")")) return value;
    if (kind_ == Kind::end) return fail("a bracket is not closed");
    return stray();
  }

  Operand quantity(const std::string& name) {
    for (std::size_t i = 0; i < known_.size(); ++i) {
      if (known_[i].name != name) continue;
      if (!known_[i].differs) return used(i);
      const Operand way = changed(i);
      return emit(Op::multiply, way, constant(1 / info_.seconds));
    }
    for (const auto& f : kFunctions)
      if (name == f.name) return fail(name + " needs brackets behind it, as in " + name + "(...)");
    return fail("there is no quantity '" + name + "' in " + info_.name + "; " + instead(name));
  }

  std::string instead(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto& each : known_) names.push_back(each.name);
    const std::string near = nearest_of(name, names);
    if (!near.empty()) return "did you mean " + near + "?";
    if (names.size() > 12) names.resize(12), names.push_back("...");
    return "there are " + listed(names);
  }

  Operand call(const std::string& name) {
    const Function* f = nullptr;
    std::vector<std::string> names;
    for (const auto& each : kFunctions) {
      names.push_back(each.name);
      if (name == each.name) f = &each;
    }
    if (!f) {
      const std::string near = nearest_of(name, names);
      return fail("there is no function '" + name + "'; " +
                  (near.empty() ? "there are " + listed(names) : "did you mean " + near + "?"));
    }
    if (name == "change") return change();
    Operand a[3];
    int count = 0;
    if (!is(")")) do {
        const Operand next = choice();
        if (f->most > 3 && count == 2)
          a[0] = emit(f->op, a[0], a[1]), a[1] = next;  // one after another
        else if (count < 3)
          a[count++] = next;
        else
          ++count;
      } while (takes(","));
    closed({});
    if (!error_.empty()) return {};
    if (count < f->least || count > f->most) {
      const char* number[] = {"", "1 value", "2 or more values", "3 values"};
      return fail(name + " takes " + number[f->least] + " in its brackets");
    }
    if (name == "clip") return emit(Op::smaller, emit(Op::larger, a[0], a[1]), a[2]);
    if (f->most == 1) return emit(f->op, a[0]);
    return f->op == Op::choose ? emit(f->op, a[0], a[1], a[2]) : emit(f->op, a[0], a[1]);
  }

  Operand change() {
    const std::string name = word_;
    const bool named = kind_ == Kind::name;
    if (named) take();
    for (std::size_t i = 0; named && is(")") && i < known_.size(); ++i)
      if (known_[i].name == name) {
        if (known_[i].differs) break;
        take();
        return changed(i);
      }
    if (named && is(")") && error_.empty()) {
      for (const auto& each : known_)
        if (each.name == name)
          return fail("change(" + name + ") is not possible: " + name + " is a change itself");
      return quantity(name);
    }
    return fail("change takes the name of one quantity, as in change(" + known_.back().name + ")");
  }

  const Info info_;
  const std::vector<Quantity>& known_;
  Program& program_;
  int depth_ = 0, uses_[kMaxResults] = {};

 public:
  /// Takes care that nothing overwrites a result of another expression.
  void keep(Operand value) { hold(value); }
};

}  // namespace

std::vector<Quantity> quantities(const Stepper& stepper) {
  std::vector<Quantity> all;
  stepper.quantities(
      [](void* to, const char* name, int number, const char* suffix, const char* unit,
         const char* meaning, bool differs) {
        std::string whole;
        for (const char* c = name; *c; ++c) whole += letter(*c) || digit(*c) ? *c : '_';
        if (number >= 10) whole += static_cast<char>('0' + number / 10);
        if (number > 0) whole += static_cast<char>('0' + number % 10);
        static_cast<std::vector<Quantity>*>(to)->push_back(
            {whole + suffix, unit, meaning, differs});
      },
      &all);
  if (all.size() > kMaxQuantities) all.resize(kMaxQuantities);
  return all;
}

std::string compile(const Stepper& stepper, const std::string& reward, const std::string& ends,
                    Program& program) {
  program = {};
  const auto known = quantities(stepper);
  const Info info = stepper.info();
  if (!reward.empty()) {
    Compiler compiler("reward", reward, info, known, program);
    program.reward = compiler.compile();
    program.pays = true;
    if (!compiler.sentence().empty()) return compiler.sentence();
  }
  if (!ends.empty()) {
    Compiler compiler("ends", ends, info, known, program);
    if (program.pays) compiler.keep(program.reward);
    program.end = compiler.compile();
    program.ends = true;
    if (!compiler.sentence().empty()) return compiler.sentence();
  }
  return "";
}

}  // namespace botschool
