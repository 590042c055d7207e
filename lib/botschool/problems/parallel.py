"""Make any PettingZoo parallel environment of two agents a problem in which they compete."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from botschool import wrappers
from botschool.errors import BotschoolError
from botschool.policies.hyperparameters import PolicyConfig
from botschool.policies.pair import Pair
from botschool.problems.pictures import rate
from botschool.problems.python import PythonProblem, Wrong
from botschool.problems.spaces import Flattener, Unsupported, fitted, interface
from botschool.problems.transition import Transition
from botschool.problems.zoo import make_parallel
from botschool.seeds import seed_libraries


class ParallelProblem(PythonProblem):
    """The environment with that name (botschool.problems.zoo); its first agent is the predator.

    Each agent has its own spaces, network and return. An agent that leaves the episode early
    neither acts nor gets rewards after that; the episode lasts until both have left.
    """

    constant_sum = False

    def __init__(self, name: str, wrapped: str = "", options: str = "") -> None:
        """Make the environment; options: as in an experiment file. Raises BotschoolError."""
        if wrapped:
            raise BotschoolError(
                f"{name} is an environment of PettingZoo, which Gymnasium's wrappers do not fit: "
                "wrap it in a function of your own, name that as module:function, and remove the "
                f"line wrappers = {wrapped}."
            )
        self.name = self.dynamics = name
        self.made = {"name": name, "options": options, "competitive": True}
        self._options = wrappers.keywords(options)
        self._renew()
        self.limit = None
        self.fps = rate(self._metadata, name)
        self.agents = self._two_agents()
        one, other = map(str, self.agents)
        self.sides = one, other
        self._flatteners, self._spaces, self.interfaces = {}, {}, []
        for agent in self.agents:
            self._add(agent)
        self.interface = replace(self.interfaces[0], robots=2)

    def _two_agents(self) -> list[Any]:
        agents = getattr(self._env, "possible_agents", None)
        if agents is None:
            self._call(_start, "reset", self._env, [], 0)
            agents = self._env.agents
        agents = list(agents)
        if len(agents) != 2:
            shown = ", ".join(map(str, agents[:4])) + (", ..." if len(agents) > 4 else "")
            count = "1 agent" if len(agents) == 1 else f"{len(agents)} agents"
            raise BotschoolError(
                f"{self.name} has {count} ({shown}), but two evolve against each other: choose an "
                "environment of two agents, or set their number in a line options = ... if the "
                "environment has such an option."
            )
        return agents

    def _add(self, agent: Any) -> None:
        """Read the spaces of this agent."""
        seen = self._call(self._env.observation_space, f"observation_space({agent!r})", agent)
        acted = self._call(self._env.action_space, f"action_space({agent!r})", agent)
        try:
            flattener = Flattener(seen, f"{self.name}, {agent}")
            self.interfaces.append(interface(flattener.size, acted, 0, flattener.image, True))
        except Unsupported as error:
            raise BotschoolError(f"{self.name} cannot be evolved: of {agent}, {error}.") from None
        self._flatteners[agent] = flattener
        self._spaces[agent] = acted

    def policy(self, config: PolicyConfig) -> Pair:
        return Pair(self.name, self.interfaces, config)

    def _episode(self, env, policy: Any, seed: int, episode: int, maxsteps: int):
        policy.reset(seed, episode)
        where = f"episode {episode} of seed {seed}"
        start = seed_libraries(seed, episode)
        raw, here = self._call(_start, f"reset of {where}", env, self.agents, start)
        sides = dict(zip(self.agents, policy.sides, strict=True))
        gone: set = set()
        rewards = dict.fromkeys(self.agents, 0.0)
        totals = rewards.copy()
        for step in range(1, self.steps(maxsteps) + 1):
            seen = {a: self._seen(raw, a, seed, episode, step > 1) for a in here}
            acts = {a: sides[a].act(seen[a]) for a in here}
            given = {a: fitted(act, self._spaces[a]) for a, act in acts.items()}
            raw, paid, leaving = self._call(_step, f"step {step} of {where}", env, given)
            for agent in here:
                rewards[agent] = self._number(paid.get(agent), step, seed, episode)
                totals[agent] += rewards[agent]
            yield Transition(
                step,
                rewards[self.agents[0]],
                totals[self.agents[0]],
                np.concatenate([seen[a] for a in here]),
                np.concatenate([np.ravel(acts[a]) for a in here]),
                policy.activations,
                totals=tuple(totals.values()),
            )
            gone.update(leaving)
            rewards = dict.fromkeys(self.agents, 0.0)
            here = [agent for agent in self.agents if agent in env.agents and agent not in gone]
            if not here:
                return

    def _seen(self, raw: dict, agent: Any, seed: int, episode: int, acted: bool) -> np.ndarray:
        if agent not in raw:
            raise self.broken(f"no observation of {agent}", seed, episode, acted)
        return self._flat(self._flatteners[agent], raw[agent], seed, episode, acted)

    def _make(self, **options):
        return make_parallel(self.name, **(self._options | options))


def _start(env, agents: list, seed: int) -> tuple[dict, list]:
    """Start an episode; return the observations, and the agents that take part."""
    given = env.reset(seed=seed)
    if not isinstance(given, tuple) or len(given) != 2:
        raise Wrong("it gives no pair of observations and infos")
    here = [agent for agent in agents if agent in env.agents]
    if agents and not here:
        raise Wrong("no agent takes part")
    return dict(given[0]), here


def _step(env, actions: dict) -> tuple[dict, dict, list]:
    """Let all act; return observations, rewards, and the agents whose episode has ended."""
    given = env.step(actions)
    if not isinstance(given, tuple) or len(given) != 5:
        raise Wrong("it gives no five dicts, from observations to infos")
    observations, rewards, ended, cut, _ = given
    return dict(observations), dict(rewards), [a for a in actions if ended[a] or cut[a]]
