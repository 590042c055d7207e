// The table of BalanceBot: a body on two round wheels, whose motors follow a speed.
// Numbers of data/robots/balance_bot.urdf; the root's origin is the middle of the body.
#pragma once

#include "solid.hpp"

namespace botschool {

inline constexpr Link kBalanceBotLinks[]{
    {"torso", -1, {}, {}, {}, -1, 0.8, {}, {0.001, 0.001, 0.001, 0, 0, 0}},
    {"left_axle",
     0,
     {-0.12, 0, -0.2},
     {-1, 0, 0},
     {0, 0, 0, 0, 0, 0, 1000},
     0,
     0.1,
     {},
     {0.0001, 0.0001, 0.0001, 0, 0, 0}},
    {"right_axle",
     0,
     {0.12, 0, -0.2},
     {1, 0, 0},
     {0, 0, 0, 0, 0, 0, 1000},
     1,
     0.1,
     {},
     {0.0001, 0.0001, 0.0001, 0, 0, 0}}};
/// A wheel touches the ground as a ball of its radius does. The body is two rods.
inline constexpr Shape kBalanceBotShapes[]{{0, {-0.075, 0, 0}, {0, 0, 0.175}, 0.025},
                                           {0, {0.075, 0, 0}, {0, 0, 0.175}, 0.025},
                                           {1, {}, {}, 0.1},
                                           {2, {}, {}, 0.1}};
inline constexpr Solid kBalanceBot{
    "balancebot", kBalanceBotLinks, kBalanceBotShapes, nullptr, 3, 4, 0, 2, 0, {0.8, 40000, 800}};

}  // namespace botschool
