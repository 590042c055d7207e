"""The common part of archive, archivestar and maxsolvestar: two sides with archives take turns.

A side has one or more evolving centres and an archive of its earlier individuals. The other side
evolves against this archive: a hall of fame (Rosin and Belew 1997, "New methods for competitive
coevolution"). So a side that forgets how to beat an old competitor meets it again. The three
algorithms of Nolfi and Pagliuca (2024), https://doi.org/10.3389/frobt.2024.1470886, differ in which
individuals enter an archive, leave it and are drawn from it. See docs/specification.md,
"Algorithms".
"""

# Hyperparameters keep the names they have in .ini files.
# ruff: noqa: N815

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from botschool.evolution.algorithm import (
    Initial,
    Play,
    Stateful,
    generations_between_saves,
    million_steps,
)
from botschool.evolution.algorithms.drawing import draw, mirrored
from botschool.evolution.algorithms.openaies import climb
from botschool.evolution.algorithms.sides import PREDATORS, PREY, SIDES, everyone, mean, means
from botschool.policies.hyperparameters import WEIGHT_DECAY, hyper
from botschool.seeds import Numbers

SAVED = 10
"""Individuals of a side that a run keeps in its files."""


@dataclass
class HallOfFameConfig:
    """Hyperparameters that all three have."""

    maxmsteps: float = million_steps(75000.0)
    ngenerations: int = hyper(
        0,
        "length of the run, in generations (0 = maxmsteps alone counts)",
        low=0,
        high=1000000000,
        free=True,
    )
    popsize: int = hyper(1, "evolving centres of each side", choices={1: "archivestar has more"})
    samplesize: int = hyper(
        20, "perturbations per generation, two candidates each", low=1, high=1000000
    )
    stepsize: float = hyper(0.01, "step size of Adam", above=0, high=1000)
    noiseStdDev: float = hyper(0.02, "standard deviation of perturbations", above=0, high=1000)
    wdecay: int = hyper(0, "pull of the centre towards 0", choices=WEIGHT_DECAY)
    ncompetitors: int = hyper(
        10, "archived opponents that a candidate meets; as many begin an archive", low=1, high=10000
    )
    checkoverfiteveryn: int = hyper(
        0, "generations between diagnoses of overfitting", choices={0: "never; there is none here"}
    )
    saveeach: int = generations_between_saves(1000)


class HallOfFame(Stateful):
    """ask() -> candidates and opponents; tell(their fitness) -> one step of one side's centres.

    advance(play) does both. The predators evolve in even generations, the prey in odd ones.
    """

    evolves = ("generation", "centres", "m", "v", "saved", "champions", "fitness")
    known: tuple[str, ...] = ()
    """Attributes in the form of `archives` with data about each archived individual."""

    share = 0.0
    plays = 1
    sides = SIDES

    def __init__(self, config: Any, initial: Initial, seed: int, constant_sum: bool = True) -> None:
        """Start both sides; initial(index) returns two random networks, a predator and a prey.

        The first `popsize` networks of each side are its centres, the next `ncompetitors` its
        archive.
        """
        self.config = config
        self.seed = seed
        self.generation = 0
        count, most = config.popsize, config.popsize * (1 + 2 * config.samplesize)
        saved = min(max(SAVED, count), most)
        pairs = np.array([initial(i) for i in range(max(count + config.ncompetitors, saved))])
        networks = np.stack(np.split(pairs, 2, axis=1))
        self.centres = networks[:, :count].copy()
        """Centres of predators, then prey: shape (2, popsize, parameters)."""
        self.m = np.zeros_like(self.centres)
        self.v = np.zeros_like(self.centres)
        self.archives: tuple[list, list] = ([], [])
        """Networks in single precision, as evaluation uses them; the oldest first."""
        for archive, first in zip(self.archives, networks[:, count:], strict=True):
            archive.extend(first[: config.ncompetitors].astype(np.float32))
        self.saved = networks[:, :saved].copy()
        """Saved individuals of predators, then prey: shape (2, individuals, parameters).

        First the centres after the side's newest turn; then the best sample of each centre in that
        turn, the second best, and so on. Before the first turn: centres and other random
        individuals.
        """
        self.champions = networks[:, 0].copy()
        """The best sample of the newest turn of each side."""
        self.fitness = np.full((2, 2), np.nan)
        """Fitness of both sides in their newest turns: of the best sample, and the average."""

    @property
    def side(self) -> int:
        """Return the side that evolves in the next generation: predators and prey take turns."""
        return self.generation % 2

    @property
    def turn(self) -> int:
        """Return the number of that side's turn, from 1."""
        return self.generation // 2 + 1

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return candidates, shape (popsize, 2 * samplesize, parameters), and their opponents.

        Opponents are places in the other side's archive, shape (popsize, samplesize, ncompetitors):
        both candidates of a perturbation meet the same ones.
        """
        raise NotImplementedError

    def tell(self, fitness: np.ndarray) -> None:
        """End the turn with the fitness of each candidate against each of its opponents.

        fitness: shape (popsize, 2 * samplesize, ncompetitors), in the order of ask(), from the
        side's own point of view.
        """
        raise NotImplementedError

    def advance(self, play: Play) -> None:
        """Run a generation; it changes nothing before its end, so an exception leaves no trace."""
        candidates, opponents = self.ask()
        places, rivals = np.unique(opponents, return_inverse=True)
        # both candidates of a perturbation meet an opponent in a row, so that its weights are read
        # once
        ours, rivals = np.broadcast_arrays(
            np.arange(candidates.shape[0] * candidates.shape[1]).reshape(-1, 1, 2),
            rivals.reshape(-1, opponents.shape[2], 1),
        )
        pairs = np.stack([ours.ravel(), rivals.ravel()]).astype(np.int32)
        archive = self.archives[1 - self.side]
        theirs = np.stack([archive[place] for place in places]).astype(np.float64)
        flat = candidates.reshape(-1, candidates.shape[2])
        if self.side == PREDATORS:
            met = play(flat, theirs, pairs)
        else:
            met = play(theirs, flat, np.ascontiguousarray(pairs[::-1]))
        if met.ndim == 2:  # each side has its own fitness
            met = met[self.side]
        elif self.side == PREY:
            met = 1 - met
        met = met.reshape(ours.shape).swapaxes(1, 2)
        self.tell(met.reshape(*candidates.shape[:2], -1))

    def _samples(self, numbers: Numbers) -> np.ndarray:
        """Draw a turn's directions and return the candidates on both sides of each centre."""
        centres, config = self.centres[self.side], self.config
        self.samples, drawn = draw(numbers, centres, config.samplesize, config.noiseStdDev)
        return drawn.reshape(len(centres), -1, centres.shape[1])

    def _climb(self, fitness: np.ndarray) -> np.ndarray:
        """Move the side's centres, and return the best sample of each: (popsize, parameters)."""
        side, config = self.side, self.config
        count, candidates, _ = fitness.shape
        average = means(fitness.reshape(count * candidates, -1)).reshape(count, candidates)
        samples = mirrored(self.centres[side], self.samples, config.noiseStdDev)
        order = np.argsort(-average, axis=1, kind="stable")
        ranked = np.take_along_axis(samples, order[..., None], axis=1)
        first = int(average.max(axis=1).argmax())
        self.champions[side] = ranked[first, 0]
        self.fitness[side] = average.max(), mean(average)

        centres, m, v = (array[side] for array in (self.centres, self.m, self.v))
        self.centres[side], self.m[side], self.v[side] = climb(
            centres, m, v, self.samples, average, config
        )
        shown = np.concatenate([self.centres[side][:, None], ranked], axis=1).swapaxes(0, 1)
        self.saved[side] = shown.reshape(-1, shown.shape[2])[: self.saved.shape[1]]
        return ranked[:, 0]

    def best(self) -> tuple[np.ndarray, float]:
        """Return the best samples of the sides' newest turns, and the predator's mean fitness."""
        return np.concatenate(self.champions), float(self.fitness[PREDATORS, 0])

    def summary(self) -> dict[str, float]:
        """Return each side's mean fitness in its newest turn, against archived opponents."""
        return dict(zip(SIDES, self.fitness[:, 1].tolist(), strict=True))

    def individuals(self, play: Play) -> tuple[np.ndarray, np.ndarray]:
        """Return `saved`; the run plays its meetings only for the files."""
        return self.saved, everyone(play, *self.saved)

    def remembered(self) -> None:
        """Return None: no meeting can be repeated, because drawn opponents are not kept."""

    def average_parameter(self) -> float:
        """Return the average absolute parameter of all centres."""
        return float(np.mean(np.abs(self.centres)))

    def state(self) -> dict[str, np.ndarray]:
        """Return the attributes that evolve, and the archives, which get longer."""
        state = super().state()
        for place, side in enumerate(SIDES):
            state[f"archive_{side}"] = np.array(self.archives[place])
            for name in self.known:
                state[f"archive_{side}_{name}"] = np.array(getattr(self, name)[place])
        return state

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore the state. Raises ValueError if archives and the data about them do not fit."""
        super().restore(state)
        predators, prey = (list(state[f"archive_{side}"]) for side in SIDES)
        self.archives = predators, prey
        for name in self.known:
            saved = [state[f"archive_{side}_{name}"] for side in SIDES]
            if [len(each) for each in saved] != [len(archive) for archive in self.archives]:
                raise ValueError("archives and the data about their individuals do not fit")
            setattr(self, name, tuple(x.tolist() if x.ndim == 1 else list(x) for x in saved))
