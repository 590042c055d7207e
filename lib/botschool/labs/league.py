"""Let the robots of a class compete; measure every robot here and trust no stated result."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from botschool.arenas import arena as arenas
from botschool.errors import BotschoolError
from botschool.labs.entries import SUFFIX, Entry, Unusable, read_entry
from botschool.policies.net import Network
from botschool.policies.policy import Policy

SEED, EPISODES = 1, 5
"""Seed and number of episodes of each race."""
RACE_STEPS, CHASE_STEPS, POLE_STEPS = 1000, 1000, 500
POLES = tuple(round(1.0 * 1.1**k, 2) for k in range(41))
"""Lengths of poles in metres; the first one is CartPole's."""
MAX_ENTRIES, MAX_HUNTERS = 1000, 200
"""Robots that compete, and those of them that chase each other, each pair for 40 ms."""
UNITS = {
    "hopper": "metres in 8 seconds",
    "walker": "metres in 8 seconds",
    "cheetah": "metres in 50 seconds",
    "cart-pole": "metres: the longest pole balanced",
    "predator": "mean share of time left when it catches",
    "prey": "mean share of time that it stays free",
}
"""Discipline -> unit of its results; chases have a table for each side."""


@dataclass(frozen=True)
class Ranked:
    """A robot's rank in a discipline."""

    rank: int
    entry: Entry
    result: float


@dataclass
class League:
    """The results of a league."""

    tables: dict[str, list[Ranked]]
    refused: list[str]
    """A sentence on each file that is no entry."""
    equal: list[str] = field(default_factory=list)
    """A sentence on entries that are the same robot."""
    chases: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    """The predators' fitness: predators in rows, prey in columns."""
    hunters: list[Entry] = field(default_factory=list)
    """Entries in the order of the rows and columns of `chases`."""


def compete(folder: Path, told: Callable[[str], None] = lambda text: None) -> League:
    """Let all entries of a folder compete. Raises BotschoolError if there are none."""
    if not folder.is_dir():
        raise BotschoolError(f"There is no folder {folder}: name the one with the entries.")
    files, entries, refused = in_turn(folder), [], []
    for number, path in enumerate(files):
        if len(entries) == MAX_ENTRIES:
            refused.append(f"{len(files) - number} files beyond {MAX_ENTRIES} robots are left out.")
            break
        try:
            entries.append(read_entry(path))
        except Unusable as error:
            refused.append(f"{path.relative_to(folder)} {error}")
    if not entries:
        why = f" {refused[0]}" if refused else ""
        raise BotschoolError(
            f"{folder} holds no entries (*{SUFFIX}): botschool enter makes one.{why}"
        )
    league = League({}, refused, _equal(entries))
    for discipline, measure in MEASURES.items():
        group = [entry for entry in entries if entry.discipline == discipline]
        if group:
            told(f"{discipline}: {len(group)} robots")
            if results := _measured(group, measure, refused):
                league.tables[discipline] = ranked([*results], [*results.values()])
    hunters = [entry for entry in entries if entry.discipline == "chase"]
    if more := hunters[MAX_HUNTERS:]:
        refused.append(f"{len(more)} hunters beyond {MAX_HUNTERS} are left out.")
    league.hunters = [
        *_measured(hunters[:MAX_HUNTERS], lambda one: everybody([one])[0, 0], refused)
    ]
    if league.hunters:
        told(f"chases: {len(league.hunters)} pairs")
        league.chases = everybody(league.hunters)
        predators, prey = means(league.chases)
        league.tables["predator"] = ranked(league.hunters, predators)
        league.tables["prey"] = ranked(league.hunters, prey)
    return league


def _equal(entries: list[Entry]) -> list[str]:
    """Return a sentence on each group of entries that hold the same robot."""
    groups: dict[tuple, list[str]] = {}
    for entry in entries:
        key = entry.discipline, repr(entry.experiment.policy), entry.genotype.tobytes()
        groups.setdefault(key, []).append(f"{entry.file} ({entry.shown})")
    return [f"The same robot: {', '.join(files)}." for files in groups.values() if len(files) > 1]


def in_turn(folder: Path) -> list[Path]:
    """Return the files of entries, the first one of each person before the second one of any."""
    turns: Counter[str] = Counter()
    ordered = []
    for path in sorted(folder.rglob("*.robot*.npz")):  # browsers number copies: x.robot-1.npz
        inner = path.relative_to(folder)
        if ".git" not in path.parts:
            turns[inner.parts[0]] += 1
            ordered.append((turns[inner.parts[0]], path))
    return [path for _, path in sorted(ordered)]


def _measured(
    entries: list[Entry], measure: Callable[[Entry], float], refused: list[str]
) -> dict[Entry, float]:
    """Return the results of the entries that can play; tell of the others in `refused`."""
    found = {}
    for entry in entries:
        try:
            result = measure(entry)
            if not np.isfinite(result):
                raise BotschoolError(f"its result is {result}")
            found[entry] = result
        except Exception as error:  # one robot must not stop the others
            refused.append(f"{entry.file} cannot play: {error}")
    return found


def ranked(entries: list[Entry], results: list[float]) -> list[Ranked]:
    """Return the entries with their ranks, the best first; equal results share a rank."""
    order = sorted(range(len(entries)), key=lambda i: (-results[i], entries[i].file))
    return [
        Ranked(1 + sum(other > results[i] for other in results), entries[i], results[i])
        for i in order
    ]


def metres(entry: Entry) -> float:
    """Return the metres that a runner moves ahead, averaged over the episodes."""
    native: Any
    native, policy, genotype, normalisation = entry.robot()
    engine, steps = native.engine(policy), native.steps(RACE_STEPS)
    gone = []
    for episode in range(EPISODES):
        tape = engine.record(genotype[None], normalisation, SEED, episode, steps)
        gone.append(tape["states"][-1, 0] - tape["states"][0, 0])
    return float(np.mean(gone))


def longest_pole(entry: Entry) -> float:
    """Return the length in metres of the longest pole that stays up in all episodes.

    Poles get longer from CartPole's own length on, until one falls. 0 if the first one falls.
    """
    import gymnasium

    _, policy, genotype, normalisation = entry.robot()
    policy.load(genotype, normalisation)
    environment: Any = gymnasium.make("CartPole-v1").unwrapped
    best = 0.0
    for length in POLES:
        environment.length = length / 2
        environment.polemass_length = environment.masspole * environment.length
        if not all(_stays_up(environment, policy, episode) for episode in range(EPISODES)):
            break
        best = length
    return best


def _stays_up(environment: Any, policy: Policy, episode: int) -> bool:
    policy.reset(SEED, episode)
    observed, _ = environment.reset(seed=1000 * SEED + episode)
    for _ in range(POLE_STEPS):
        observed, _, fallen, *_ = environment.step(policy.act(observed))
        if fallen:
            return False
    return True


MEASURES: dict[str, Callable[[Entry], float]] = {
    "hopper": metres,
    "walker": metres,
    "cheetah": metres,
    "cart-pole": longest_pole,
}


def everybody(entries: list[Entry]) -> np.ndarray:
    """Return the predators' fitness of all chases: every predator (rows) and prey (columns)."""
    sides = [_networks(entry) for entry in entries]
    return np.array([[_chase(one[0], other[1]) for other in sides] for one in sides])


def _networks(entry: Entry) -> tuple[Network, Network]:
    """Return the networks of predator and prey."""
    _, policy, genotype, _ = entry.robot()
    found = []
    for half in np.split(genotype, 2):
        network = Network(policy.spec)
        network.parameters[:] = half
        found.append(network)
    return found[0], found[1]


def _chase(predator: Network, prey: Network) -> float:
    arena = arenas.make("predprey", max_steps=CHASE_STEPS)
    arena.reset(seed=0)
    networks = predator, prey
    for network in networks:
        network.reset()
    wheels, total = np.empty(4), 0.0
    while not arena.done:
        for side, network in enumerate(networks):
            network.observation[:] = arena.observation[24 * side : 24 * side + 24]
            wheels[2 * side : 2 * side + 2] = network.step()
        arena.action = wheels
        total += arena.step()
    return float(total)


def means(chases: np.ndarray) -> tuple[list[float], list[float]]:
    """Return the mean fitness of each predator and of each prey.

    Chases between the two robots of one entry do not count, unless there is just one entry.
    """
    others = ~np.eye(len(chases), dtype=bool) if len(chases) > 1 else np.ones((1, 1), dtype=bool)
    predators = [float(row[mask].mean()) for row, mask in zip(chases, others, strict=True)]
    prey = [1 - float(row[mask].mean()) for row, mask in zip(chases.T, others.T, strict=True)]
    return predators, prey


def results_csv(league: League) -> bytes:
    """Return all results with the names of the files as CSV, for the instructor."""
    from botschool.grading.classes.tables import made_table

    rows: list[list[object]] = [["discipline", "rank", "name", "result", "unit", "file"]]
    for discipline, places in league.tables.items():
        unit = UNITS[discipline]
        for place in places:
            entry, result = place.entry, float(f"{place.result:.4g}")
            rows.append([discipline, place.rank, entry.name, result, unit, entry.file])
    return made_table(rows)
