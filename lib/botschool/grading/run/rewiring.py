"""Evaluate a submission's candidates on the grader's side, with secret gains of the parameters.

Evolution starts from parameters of random signs, so gains make no difference to it. Parameters that
the student wrote down, or computed without evaluating any, act differently.

The gains and the record of what was evaluated stay in the grader's process: `Rewired` answers
there. In the submission's process, within a block of `asking`, Robot.evaluate asks and waits.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any
from unittest.mock import patch

import numpy as np

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import expect, expect_array

MOST_EPISODES = 20_000
"""Episodes of one question."""
EXACT, MOST_NUMBERS = 100_000, 2**26
"""Candidates that a record holds in double precision, and parameters that it holds at all."""
FEW_CALLS = 3


class Rewired:
    """A robot of the grader, whose parameter i counts gains[i] times; it records evaluations.

    enough: 0, or the number of candidates after which a training may end: `asking` breaks it off
    once that many were evaluated, in at least FEW_CALLS calls.
    """

    def __init__(self, environment: str, gains: np.ndarray, enough: int = 0) -> None:
        from botschool.course.evaluation import Robot

        self.environment, self.gains, self.enough = environment, np.asarray(gains, float), enough
        self._robot = Robot(environment)
        self.calls: list[tuple[np.ndarray, np.ndarray]] = []
        """The candidates and the fitness of each call."""
        self.asked: list[tuple[int, int]] = []
        """Seed and number of episodes of each call."""
        self._many = 0

    def __len__(self) -> int:
        return self._many

    def answer(self, asked: Any) -> dict[str, Any]:
        """Return what `asking` needs for a question, which may be forged. Raises ValueError."""
        candidates, seed, episodes, maxsteps = _checked(asked, len(self.gains))
        if self.enough and len(self.calls) >= FEW_CALLS and len(self) >= self.enough:
            return {"enough": True}
        if (len(self) + len(candidates)) * len(self.gains) > MOST_NUMBERS:
            return {"error": f"robot.evaluate was given more than {len(self)} candidates in all."}
        try:
            fitness = self._robot.evaluate(candidates * self.gains, seed, episodes, maxsteps)
        except (BotschoolError, ValueError, OverflowError) as error:
            return {"error": str(error)}
        kept = np.float64 if len(self) + len(candidates) <= EXACT else np.float32
        self.calls.append((candidates.astype(kept, copy=False), fitness))
        self.asked.append((seed, episodes))
        self._many += len(candidates)
        return {"fitness": fitness}

    def first(self, many: int) -> np.ndarray:
        """Return the candidates of the first evaluations: at least this many, or all."""
        return self._some(self.calls, many)

    def last(self, many: int) -> np.ndarray:
        """Return those of the last evaluations, last one first: at least this many, or all."""
        return self._some(self.calls[::-1], many)

    def _some(self, calls: list[tuple[np.ndarray, np.ndarray]], many: int) -> np.ndarray:
        found, held = [np.empty((0, len(self.gains)))], 0
        for candidates, _ in calls:
            if held >= many:
                break
            found.append(candidates)
            held += len(candidates)
        return np.concatenate(found)

    @staticmethod
    def _nearest(rows: np.ndarray, parameters: np.ndarray) -> np.ndarray:
        return rows[np.abs(rows - parameters).max(axis=1).argmin()]

    def nearest(self, parameters: np.ndarray) -> np.ndarray | None:
        """Return the candidate nearest to these parameters; None if there is none."""
        rows = [self._nearest(rows, parameters) for rows, _ in self.calls if len(rows)]
        return min(rows, key=lambda row: np.abs(row - parameters).max(), default=None)


def _checked(asked: Any, size: int) -> tuple[np.ndarray, int, int, int]:
    """Return candidates, seed, episodes and steps of a question. Raises ValueError."""
    try:
        candidates, *numbers = (asked[n] for n in ("population", "seed", "episodes", "maxsteps"))
        if candidates.dtype == np.float64 and candidates.shape == (len(candidates), size):
            seed, episodes, maxsteps = map(operator.index, numbers)
            few = len(candidates) * episodes <= MOST_EPISODES
            if 0 <= seed < 2**64 and episodes > 0 < maxsteps < 2**31 and few:
                return candidates, seed, episodes, maxsteps
    except (TypeError, KeyError, AttributeError):
        pass
    raise ValueError("not a question")


class EnoughSeen(BaseException):
    """The grader has seen enough of a training."""


@contextmanager
def asking(environment: str, size: int, ask: Callable[[Any], dict]) -> Iterator[None]:
    """Have robots of this environment and size evaluated by `ask` within the block.

    EnoughSeen ends the block.
    """
    from botschool.course.evaluation import Robot

    evaluate = Robot.evaluate

    def evaluated(robot, population, seed, episodes=5, maxsteps=1000):
        rows = np.ascontiguousarray(population, dtype=np.float64)
        others = robot.environment != environment or rows.shape != (len(rows), size)
        if others or not (0 < episodes <= MOST_EPISODES and 0 < maxsteps < 2**31):
            return evaluate(robot, population, seed, episodes, maxsteps)
        question = {
            "seed": int(np.full(1, seed, dtype=np.uint64)[0]),
            "episodes": operator.index(episodes),
            "maxsteps": int(maxsteps),
        }
        at_once, parts = MOST_EPISODES // episodes, [np.empty(0)]
        for first in range(0, len(rows), at_once):
            found = ask({"population": rows[first : first + at_once], **question})
            if "enough" in found:
                raise EnoughSeen
            if "error" in found:
                raise BotschoolError(found["error"])
            parts.append(found["fitness"])
        return np.concatenate(parts)

    with patch.object(Robot, "evaluate", evaluated), suppress(EnoughSeen):
        yield


def found_in(module, ask, name, environment, size, arguments):
    """{0}(*{3}), with robots of the grader"""
    from botschool.grading.run.rewiring import asking

    with asking(environment, size, ask):
        return getattr(module, name)(*arguments)


class Disguised:
    """A robot whose parameters count with secret gains, of either sign and about as large as 1."""

    def __init__(self, environment: str, seed: int) -> None:
        """Draw the gains; `rng` draws what else the grader needs."""
        from botschool.course.evaluation import Robot

        self.environment, self.robot = environment, Robot(environment)
        self.size = self.robot.nbiases + self.robot.nweights
        self.rng = np.random.default_rng(seed)
        signs = self.rng.choice([-1.0, 1.0], size=self.size)
        self.gains = signs * 1.25 ** self.rng.uniform(-1, 1, self.size)

    def trained(
        self, student: Any, name: str, *arguments: Any, said: str, rows: tuple[int, ...] = ()
    ) -> np.ndarray:
        """Return the candidate that a function finds, or rows of them.

        Raises Wrong if one was never evaluated.
        """
        own = {"environment": self.environment, "gains": self.gains}
        given = name, self.environment, self.size, [*arguments]
        answer = student.run(found_in, *given, said=said, robot=own)
        found = expect_array(said, answer, (*rows, self.size))
        for row in np.atleast_2d(found):
            near = student.rewired.nearest(row)
            tried = near is not None and np.allclose(near, row, rtol=1e-5, atol=1e-5)
            expect(tried, f"{said} should return a candidate that it gave to robot.evaluate.")
        return found

    def means(self, candidates: Any, seed: int, episodes: int) -> np.ndarray:
        """Return the mean return of each candidate over new episodes."""
        return self.robot.evaluate(self.gains * candidates, seed, episodes=episodes)
