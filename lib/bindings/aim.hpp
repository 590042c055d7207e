// A problem's options as Python gives them.
#pragma once

#include "arena.hpp"
#include "arena/engine/reward.hpp"
#include "spatial.hpp"

namespace botschool {

/// A reward or an end of episodes of one's own, and the options that go with it.
struct Aim {
  Program program;
  nb::object options;
};

/// options: None, of either kind, or an Aim around them.
inline Setting setting_of(int limit, nb::handle options) {
  if (nb::isinstance<Aim>(options)) {
    const Aim& aim = nb::cast<const Aim&>(options);
    Setting setting = setting_of(limit, aim.options);
    setting.program = &aim.program;
    return setting;
  }
  if (limit < 1) throw std::invalid_argument("an episode needs at least one step.");
  Setting setting{limit};
  if (nb::isinstance<Race>(options))
    setting.space = &nb::cast<const Race&>(options).options;
  else if (!options.is_none())
    setting.arena = &nb::cast<const Options&>(options);
  return setting;
}

}  // namespace botschool
