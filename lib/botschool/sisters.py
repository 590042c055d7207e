"""Names in files of related projects, and what stands for them here: docs/specification.md, "Files
of related projects".

evorobotpy3 and competitive-evolution continue evorobotpy2. Some of their names mean something that
has another name here (`SAME`). For the others `INSTEAD` and `NEAREST` say what to write.
"""

from __future__ import annotations

import re

SAME = {"generalist": "coevo2", "coevosinglepop": "coevo"}
"""Algorithms with another name here."""

_ARENA = "a declared arena with several robots (environment = ErArena, as in arena_swarm.ini)"
_LEARN = "train with 'botschool rl train --algo {0} --env ENVIRONMENT'"
_LEARNERS = ("PPO", "A2C", "DDPG", "DQN", "SAC", "TD3")

INSTEAD = {
    "algo": {
        "generational": "the nearest is algo = GA, with selsize for nreproducing",
        "evostick": "the nearest is algo = GA, with selsize for nreproducing",
        "Hill-Climber": "the nearest is algo = (1+1)-ES, one climber with a step that adapts",
        "archivestar1": "the nearest is algo = archivestar",
        "archivestar1singlepop": "the nearest is algo = coevo, one population for both sides",
        "coevoarch": "the nearest is algo = archive, or maxsolvestar if fullarchive = 0",
        "coevoarchphase": "the nearest is algo = maxsolvestar",
        "coevoarchsinglepop": "the nearest is algo = coevo, one population for both sides",
        "coevoarch2": "the nearest is algo = archive",
        "coevoarch2multi": "the nearest is algo = archivestar",
        "coevoarch2multirr": "the nearest is algo = archivestar",
        **dict.fromkeys(("SSSHC", "SSS2"), "the nearest is algo = SSS"),
        **dict.fromkeys(("openaiesp", "openaiespop"), "the nearest is algo = OpenAI-ES, with -w"),
        **dict.fromkeys(("jade", "diffevo", "pso"), "the nearest is algo = CMA-ES"),
        "NEAT": "no algorithm here changes the shape of a network; the nearest is algo = GA",
        **{name: _LEARN.format(name.lower()) for name in _LEARNERS},
    },
    "key": {
        "algorithm": "for evolution write algo = NAME; for PPO and its kind train with "
        "'botschool rl train --algo ppo --env ENVIRONMENT'",
        "seed": "give the seed with -s",
        "folder": "give the folder with -o",
        "batchsize": "write samplesize (OpenAI-ES) or popsize",
        "nreproducing": "write selsize, the number of parents (algo = GA)",
        "tournamentsize": "remove the line, because GA has other rules here: parents are the "
        "selsize best, and mutation is the standard deviation of a mutation of all parameters",
        "crossover": "write crossrate, the share of children of two parents (algo = GA)",
        "crosstype": "remove the line: a child of two parents takes each parameter from one",
        "fullarchive": "use algo = archive, which keeps all, or maxsolvestar, which drops some",
        "nmates": "remove the line: candidates do not mate here",
        "mating": "remove the line: candidates do not mate here",
    },
}
"""Names of algorithms, and keys -> what to do instead."""

NEEDLESS = {
    "saveeveryn": "runs save every saveeach minutes",
    "elitism": "GA always keeps its best individual",
    "testmode": "-p -g FILE.npy tests a robot",
    "verbose": "runs always say as much",
}
"""Keys of theirs without which a file runs -> why."""

NEAREST = {
    "ErAggregation": _ARENA,
    "ErAggregationTwoAreas": _ARENA,
    "envAggregationCustom": _ARENA,
    "envMultiAgentCustom": _ARENA,
    "ErCforaging": f"{_ARENA}; arena_zones.ini has zones",
    "envSwarmForagingCustom": f"{_ARENA}; arena_zones.ini has zones",
    "ErCollectivePredprey": "ErPredprey, one predator and one prey",
    "envDiscriminationCustom": "ErDiscrim",
    "envObjDiscrimCustom": "ErDiscrim",
    "envHalfcheetah2DCustom": "PlanarHalfCheetah-v5",
    "envHalfcheetahBodybrainCustom": "PlanarBodyBrain-v0 (or envBodybrainCustom)",
    "envBipedalWalkerBodyBrainCustom": "PlanarBodyBrain-v0 (or envBodybrainCustom)",
    "DoublePole": "ErDpole",
    "DoubleTMaze": "a declared arena with walls and zones (environment = ErArena)",
    "GridWorld": "FrozenLake-v1 of Gymnasium",
    "SlimeVolley": "ALE/Pong-v5 (pong.ini), or a game of PettingZoo with algo = coevo2",
    "SlimeVolleyHard": "ALE/Pong-v5 (pong.ini), or a game of PettingZoo with algo = coevo2",
    "envAirHockeyCustom": "ALE/Pong-v5 (pong.ini), or a game of PettingZoo with algo = coevo2",
    **dict.fromkeys(("GameOfLife", "envEmbryoCustom", "envBitParityCustom"), ""),
    "envTestFunctionCustom": "",
}
"""Their environments that botschool lacks -> the nearest here, "" for none."""


def instead(place: str, name: str) -> str:
    """Return what to do instead of a name of theirs, "" for any other name.

    place: `algo` or `key`.
    """
    known = {_plain(key): remedy for key, remedy in INSTEAD.get(place, {}).items()}
    return known.get(_plain(name), "")


def missing(environment: str) -> str:
    """Return what is wrong with an environment of theirs that botschool lacks, else ""."""
    name = re.sub(r"^evorobotpy_envs/|-v\d+$", "", environment)
    if name not in NEAREST:
        return ""
    near = f"the nearest is {NEAREST[name]}" if NEAREST[name] else "there is nothing near it"
    return (
        f"{environment} is an environment of evorobotpy3 that botschool does not have: {near}; to "
        "use your own copy, register it with Gymnasium and write environment = MODULE:ID."
    )


def _plain(name: str) -> str:
    return re.sub(r"[\W_]", "", name).lower()
