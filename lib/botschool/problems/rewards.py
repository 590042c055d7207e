"""Rewards of one's own: expressions over a native problem's quantities.

C++ reads and runs them (lib/arena/engine/expression.cpp, reward.cpp); here are its sentences.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from botschool import _core
from botschool.errors import BotschoolError

if TYPE_CHECKING:
    from botschool.policies.policy import Policy


def aim(problem: str, options: Any, reward: str, ends: str) -> Any:
    """Return the options of C++ with a reward and an end of episodes, each of which may be "".

    Raises BotschoolError, whose sentence begins with the expression.
    """
    if not (reward or ends):
        return options
    try:
        return _core.Aim(problem, options, reward, ends)
    except ValueError as error:
        raise BotschoolError(str(error)) from None


def unmeasured(
    problem: Any,
    policy: Policy,
    genotypes: np.ndarray,
    normalisation: np.ndarray | None,
    seed: int,
    episode: int,
    limit: int,
) -> BotschoolError | None:
    """Return the error for an episode in which the user's reward gave no number; None if it did.

    genotypes: a row of one network for all robots, or one for each.
    """
    several = bool(policy.config.heterogeneous)
    tape = problem.engine(policy).record(
        genotypes, normalisation, seed, episode, limit, several, problem.options()
    )
    wrong = np.flatnonzero(~np.isfinite(tape["rewards"]))
    if not len(wrong):
        return None
    step, options = int(wrong[0]), problem.options(bare=True)
    known = [name for name, _, _ in problem.quantities()]
    body = genotypes[0, len(genotypes[0]) - policy.interface.morphology :]

    def value(name: str) -> float:
        stepper = _core.make_stepper(problem.dynamics)
        stepper.set(limit, _core.Aim(problem.dynamics, options, name))
        if policy.interface.morphology:
            stepper.set_body(np.ascontiguousarray(body))
        stepper.start(seed, episode)
        return [stepper.step(action)[0] for action in tape["actions"][: step + 1]][-1]

    names = [word for word in dict.fromkeys(re.findall(r"\w+", problem.reward)) if word in known]
    where = " and ".join(f"{name} = {value(name):.6g}" for name in names)
    what = "no number" if np.isnan(tape["rewards"][step]) else "infinite"
    return BotschoolError(
        f"reward = {problem.reward} is {what} in step {step + 1} of episode {episode} of seed "
        f"{seed}{', where ' if where else ''}{where}: keep it from dividing by 0 and from roots of "
        "negative numbers, as in x / max(y, 0.01) and sqrt(max(y, 0))."
    )
