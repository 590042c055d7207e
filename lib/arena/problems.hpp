// The native problems. A new one is a header and a line here.
#pragma once

#include "classic/acrobot.hpp"
#include "classic/cartpole.hpp"
#include "classic/dpole.hpp"
#include "classic/mountaincar.hpp"
#include "classic/pendulum.hpp"
#include "classic/swingup.hpp"
#include "wheels/discrim.hpp"
#include "wheels/predprey.hpp"

BOTSCHOOL_BEGIN

template <template <int> class... Problem>
struct ProblemList {};

using NativeProblems = ProblemList<CartPole, Pendulum, Acrobot, MountainCarContinuous, Swingup,
                                   DoublePole, Discrim, Predprey>;

BOTSCHOOL_END
