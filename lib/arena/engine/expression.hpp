// Makes the program of a reward from text. docs/specification.md, "Rewards of one's own".
#pragma once

#include <string>
#include <vector>

#include "stepper.hpp"

namespace botschool {

/// A quantity that a problem names.
struct Quantity {
  std::string name, unit, meaning;
  bool differs;  ///< how much its row grows in a second
};

/// The quantities of a problem, with the choices that its stepper was set to.
std::vector<Quantity> quantities(const Stepper& stepper);

/// Adds to a program what its user writes behind `reward =` and `ends =`; "" adds nothing. Returns "", or
/// a sentence about what is wrong.
std::string compile(const Stepper& stepper, const std::string& reward, const std::string& ends,
                    Program& program);

}  // namespace botschool
