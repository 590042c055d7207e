// Reads an expression word by word. docs/specification.md, "Rewards of one's own".
#pragma once

#include <algorithm>
#include <cstring>
#include <string>

namespace botschool {

inline bool letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
inline bool digit(char c) { return c >= '0' && c <= '9'; }

/// A text and the word that comes next in it. The first thing that is wrong becomes `error_`, and the rest
/// of the text is skipped.
class Words {
 public:
  Words(const char* key, const std::string& text) : key_(key), text_(text) {}

  /// What is wrong, or "".
  std::string sentence() const {
    if (error_.empty()) return "";
    std::string start;
    for (const char c : text_) {
      if (start.size() == 60) {
        start += "...";
        break;
      }
      start += c >= ' ' && c != 127 ? c : ' ';
    }
    const bool asks = error_.back() == '?';
    return std::string(key_) + " = " + start + ": " + error_ + (asks ? "" : ".");
  }

 protected:
  enum class Kind { number, name, sign, end };

  void wrong(const std::string& reason) {
    if (error_.empty()) error_ = reason;
    at_ = text_.size();
    kind_ = Kind::end;
    word_.clear();
  }

  bool is(const char* word) const { return kind_ != Kind::end && word_ == word; }
  bool takes(const char* word) {
    if (!is(word)) return false;
    take();
    return true;
  }

  /// Goes to the next word.
  void take() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    word_.clear();
    kind_ = Kind::end;
    if (at_ >= text_.size()) return;
    const char c = text_[at_];
    if (digit(c) || (c == '.' && at_ + 1 < text_.size() && digit(text_[at_ + 1]))) return number();
    if (letter(c)) {
      while (at_ < text_.size() && (letter(text_[at_]) || digit(text_[at_]))) word_ += text_[at_++];
      kind_ = Kind::name;
      return;
    }
    for (const char* sign : kSigns)
      if (text_.compare(at_, std::strlen(sign), sign) == 0) {
        word_ = sign;
        at_ += word_.size();
        kind_ = Kind::sign;
        return;
      }
    unknown_sign(c);
  }

  const char* key_;
  const std::string& text_;
  std::string error_, word_;
  Kind kind_ = Kind::end;
  double value_ = 0;  ///< of a number

 private:
  static constexpr const char* kSigns[] = {"**", "<=", ">=", "==", "!=", "+", "-", "*",
                                           "/",  "<",  ">",  "(",  ")",  ",", "="};

  void unknown_sign(char c) {
    if (c == '"' || c == '\'')
      wrong("there is a text in quotes, but a reward is made of numbers");
    else if (c == '^')
      wrong("'^' has no meaning here: write ** for a power");
    else if (c == '&' || c == '|')
      wrong(std::string("'") + c + "' has no meaning here: write " + (c == '&' ? "and" : "or"));
    else if (c == '.')
      wrong("a point stands behind a name: quantities have no parts");
    else if (c == '[' || c == '{')
      wrong(std::string("'") + c + "' has no meaning here: write round brackets");
    else
      wrong((c > ' ' && c < 127 ? std::string("'") + c + "'" : std::string("a sign")) +
            " has no meaning here: an expression has names, numbers, brackets, + - * / ** and "
            "comparisons");
  }

  /// Digits up to 2^53 and a power of ten up to 22: then the nearest double is one operation away.
  void number() {
    double digits = 0;
    int count = 0, power = 0;
    bool point = false;
    for (; at_ < text_.size() && (digit(text_[at_]) || (text_[at_] == '.' && !point)); ++at_) {
      if (text_[at_] == '.') {
        point = true;
        continue;
      }
      digits = 10 * digits + (text_[at_] - '0');
      count += digits > 0;
      power -= point;
    }
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      std::size_t next = at_ + 1;
      const bool minus = next < text_.size() && text_[next] == '-';
      if (next < text_.size() && (text_[next] == '-' || text_[next] == '+')) ++next;
      int exponent = 0;
      const std::size_t first = next;
      for (; next < text_.size() && digit(text_[next]); ++next)
        exponent = std::min(1000, 10 * exponent + (text_[next] - '0'));
      if (next > first) power += minus ? -exponent : exponent, at_ = next;
    }
    if (at_ < text_.size() && letter(text_[at_])) {
      wrong("a number runs into a letter: write a sign between them, as in 2 * x");
      return;
    }
    if (count > 15 || power > 22 || power < -22) {
      wrong("a number has at most 15 digits and lies between 1e-22 and 1e22");
      return;
    }
    double scale = 1;
    for (int i = 0; i < (power < 0 ? -power : power); ++i) scale *= 10;
    value_ = power < 0 ? digits / scale : digits * scale;
    word_ = "a number";
    kind_ = Kind::number;
  }

  std::size_t at_ = 0;
};

}  // namespace botschool
