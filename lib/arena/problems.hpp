// The native problems. A new one is a header and a line here.
#pragma once

#include "problems/acrobot.hpp"
#include "problems/cartpole.hpp"
#include "problems/dpole.hpp"
#include "problems/mountaincar.hpp"
#include "problems/pendulum.hpp"
#include "problems/swingup.hpp"
#include "problems/discrim.hpp"
#include "problems/predprey.hpp"

BOTSCHOOL_BEGIN

template <template <int> class... Problem>
struct ProblemList {};

using NativeProblems = ProblemList<CartPole, Pendulum, Acrobot, MountainCarContinuous, Swingup,
                                   DoublePole, Discrim, Predprey>;

BOTSCHOOL_END
