"""Grader of exercise 6; run it with `make test-ex6`.

Nothing here is a matter of luck, and no check needs a margin: the arena and its noise follow from a
seed, and the grader steps each episode again with a network of its own. Brains are variations of
the pre-evolved robots of data/genotypes, and of robots that drive into a wall, drawn from the
grading seed like starts, cylinders, seeds and ways to remember.
"""

from collections.abc import Callable
from functools import cache, lru_cache, partial

import numpy as np
from slips import (
    GATES,
    MEANT,
    REMEMBERED,
    UNITS,
    answer_of,
    changed_described,
    described,
    grid_of,
    grouped,
    inside,
    mistaken_parts,
    numbered,
    scaled,
    wrong_described,
    wrong_families,
    wrong_grids,
    wrong_memories,
    wrong_reactions,
    wrong_scales,
)

from botschool import arena as arenas
from botschool.course import genotype_file
from botschool.grading import (
    Exercise,
    Student,
    expect,
    expect_array,
    expect_close,
    expect_fields,
    spoiled,
)
from botschool.net import Network, NetworkSpec

exercise = Exercise(6, "A foraging robot", file="foraging_robot.py")
INPUTS = 8
WAYS = ("keep", "forget", "mixed", "mixed")


def rng_of(index: int) -> np.random.Generator:
    return np.random.default_rng(exercise.seed(index))


def weights(genotype: np.ndarray) -> dict:
    gates = genotype[12:732].reshape(UNITS, 4, INPUTS + UNITS).swapaxes(0, 1).copy()
    return {"gates": gates, "readout": genotype[732:].reshape(2, UNITS), "bias": genotype[10:12]}


def evolved(rng: np.random.Generator, which: int) -> np.ndarray:
    """A variation of a pre-evolved robot."""
    genotype = np.load(genotype_file(f"discrimS{which + 1}.npy"))
    return genotype + 0.01 * rng.normal(size=len(genotype))


def bold(rng: np.random.Generator) -> np.ndarray:
    """A robot that soon meets a wall: it drives fast, and nearly straight on."""
    genotype = 0.05 * rng.normal(size=752)
    genotype[10:12] = rng.uniform(1.4, 1.6) + 0.05 * rng.normal(size=2)
    return genotype


# ------------------------------------------------------------------- the grader's own robot


def remembered(way, step: int, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    if way == "mixed":
        return 0.6 * after + 0.3 * before + 0.01 * np.sin(step)
    if way == "forget":
        return 0 * after
    if isinstance(way, str) and way.startswith("forget "):
        return after if step < int(way.split()[1]) else 0 * after
    return after if way == "keep" or step < way else before


def lived(brain: dict, start, cylinder, seed: int, way, maxsteps: int, slip: str = "") -> dict:
    """An episode; way: keep, forget, mixed, or the step from which memory is frozen.

    slip: a key of SLIPS, for what a mistake makes of it.
    """
    arena = arenas.make("discrim", max_steps=500 if slip == "500" else maxsteps)
    if slip == "reset last":
        start, cylinder = None, None
    arena.reset(seed + (slip == "seed + 1"))
    if start is not None:
        x, y, heading = start
        arena.robots[0] = {
            "heading 0": (x, y, 0.0),
            "degrees": (x, y, np.degrees(heading)),
            "radians": (x, y, np.radians(heading)),
            "x and y": (y, x, heading),
        }.get(slip, start)
    if cylinder is not None and slip != "cylinder":
        arena.objects[0, :2] = cylinder[::-1] if slip == "cylinder y, x" else cylinder
    if slip != "sense":
        arena.sense()
    memory, rows = np.ones((2, UNITS)) if slip == "ones" else np.zeros((2, UNITS)), []
    begun = earlier = made = memory
    poses, last = [arena.robots[0].copy()], np.zeros(2)
    while not arena.done:
        seen = arena.observation.copy()
        given = {
            "no memory": 0 * memory,
            "no cells": memory * [[0], [1]],
            "no outputs": memory * [[1], [0]],
            "rows": memory[::-1],
        }.get(slip, memory)
        action, after = answer_of(brain, 0 * seen if slip == "blind" else seen, given)
        if slip == "think again":
            action, _ = answer_of(brain, seen, after)
        if slip == "think twice":
            action, after = answer_of(brain, seen, after)
        arena.action = {
            "late": last,
            "half": action / 2,
            "wheels": action[::-1],
            "sign": np.sign(action),
            "still": 0 * action,
            "forwards": np.maximum(action, 0),
            "amount": np.abs(action),
            "0 to 1": (action + 1) / 2,
            "back": -action,
        }.get(slip, action)
        last = action
        reward = arena.step()
        if slip == "two steps" and not arena.done:
            reward = arena.step()
        if slip == "two rewards" and not arena.done:
            reward += arena.step()
        rows.append((seen, memory, action.copy(), reward))
        poses.append(arena.robots[0].copy())
        step = {"from 1": len(rows), "step 0": 0, "backwards": maxsteps - len(rows)}.get(
            slip, len(rows) - 1
        )
        one, other = {
            "exchanged": (after, memory),
            "after twice": (after, after),
            "before twice": (memory, memory),
            "begun": (begun, after),
            "earlier": (earlier, after),
            "made": (made, after),
        }.get(slip, (memory, after))
        earlier, made = memory, after
        memory = after if slip == "not asked" else remembered(way, step, one, other)
        if (slip == "found" and reward > 0) or (slip == "lost" and reward == 0 and len(rows) > 1):
            break
    seen, memories, actions, rewards = map(np.array, zip(*rows, strict=True))
    return {"poses": np.array(poses), "observations": seen, "memories": memories,
            "actions": actions, "rewards": rewards}  # fmt: skip


SLIPS = {
    "no memory": "`think` is given an empty memory in each step, not what `remember` returned.",
    "no cells": "`think` is given memories whose cells are 0, not the whole memory.",
    "no outputs": "`think` is given memories whose outputs are 0, not the whole memory.",
    "rows": "`think` is given the memory with its two rows exchanged.",
    "blind": "`think` is given zeros instead of the observation.",
    "think again": "The action is that of `think` with the memory after the step, not with that "
    "before it.",
    "think twice": "The network makes two steps, one after the other, in each step of the arena, "
    "but should make one.",
    "late": "The wheels do in each step the action of the step before, not that of this step.",
    "half": "The wheels get half of the action, but should get the whole.",
    "wheels": "The two wheels are exchanged when the action is set.",
    "sign": "The wheels get only the sign of the action, but should get the action itself.",
    "forwards": "The wheels get 0 where the action is negative, but they should roll backwards "
    "then.",
    "amount": "The wheels get the absolute value of the action, but should roll backwards where it "
    "is negative.",
    "0 to 1": "The wheels get numbers from 0 to 1, but should get the action, from -1 to 1.",
    "back": "The wheels get the action with the opposite sign.",
    "still": "The wheels never get an action and stand still, but should do that of `think`.",
    "two steps": "Two steps of the arena are made with each action, and only the second one is "
    "recorded, but there should be one.",
    "two rewards": "Two steps of the arena are made with each action, and their rewards are added, "
    "but there should be one.",
    "from 1": "`remember` is told that the first step is number 1, but it should be number 0.",
    "step 0": "`remember` is told in each step that its number is 0, not its own number.",
    "backwards": "`remember` is told how many steps are left, not the number of the step.",
    "exchanged": "`remember` gets the memory after the step first and that before it second, but "
    "should get that before it first.",
    "after twice": "`remember` gets the memory after the step twice, but should get the one before "
    "as `before`.",
    "before twice": "`remember` gets the memory before the step twice, but should get the one "
    "after it as `after`.",
    "begun": "`remember` gets the memory at the beginning of the episode as `before` in each step, "
    "not that before this step.",
    "earlier": "`remember` gets as `before` the memory before the previous step, not that before "
    "this one.",
    "made": "`remember` gets as `before` what `think` returned in the previous step, but should "
    "get what `remember` returned there.",
    "not asked": "What `remember` returns is not used, but should be the memory of the next step.",
    "found": "The episode ends with the first reward, but should go on to maxsteps or a collision.",
    "lost": "The episode ends with a step without a reward, but should go on to maxsteps or a "
    "collision.",
    "500": "The episode lasts up to 500 steps, whatever maxsteps is.",
    "seed + 1": "The arena is reset with `seed + 1`, but should be reset with `seed`.",
    "ones": "The memory begins with ones, but should begin with zeros.",
    "heading 0": "The robot starts with the heading 0, not with that of the start.",
    "degrees": "The heading of the start is turned into degrees, but the arena's headings are in "
    "radians, too.",
    "radians": "The heading of the start is taken for degrees, but it is in radians, as are the "
    "arena's.",
    "x and y": "x and y of the start are exchanged.",
    "cylinder y, x": "x and y of the cylinder are exchanged.",
    "cylinder": "The cylinder stays where the seed has put it, but should be at the given place.",
    "reset last": "Robot and cylinder are where the seed has put them, but should be at the given "
    "places.",
    "sense": "The first observation is that of the places before robot and cylinder were moved, "
    "but should be renewed afterwards.",
}
"""What mistakes make of an episode: slip of `lived` -> sentence."""


def wrong_recordings(brain: dict, *case) -> dict[str, dict]:
    """The episodes that mistakes make."""
    return {text: lived(brain, *case, slip=slip) for slip, text in SLIPS.items()}


def proved_recordings(answer: dict, right: dict, *case) -> dict[str, dict]:
    """The episodes that mistakes make, if two parts of an answer show it, or all that differ."""

    def alike(one, other) -> bool:
        try:
            return np.shape(one) == np.shape(other) and np.allclose(one, other, 1e-3, 1e-3)
        except (TypeError, ValueError):
            return False

    found = {}
    for text, episode in wrong_recordings(*case).items():
        changed = [name for name in right if not alike(episode[name], right[name])]
        shown = sum(alike(answer[name], episode[name]) for name in changed)
        if shown >= min(2, len(changed)):
            found[text] = episode
    return found


def wrong_parts(made: Callable, right: dict, name: str, many: int | None) -> dict:
    """What mistakes make of a part of a recording, up to a number of steps."""
    found = {text: episode[name] for text, episode in made().items()}
    memories, last = right["memories"], len(right["rewards"])
    more = {
        "poses": {
            "The pose after the last step is missing.": right["poses"][:-1],
            "The places are recorded, but not the headings.": right["poses"][:, :2],
        },
        "memories": {
            "The cells are recorded, but not the outputs.": memories[:, 0],
            "The memories come one step too late, the first one twice.": np.concatenate(
                [memories[:1], memories[:-1]]
            ),
        },
        "actions": {
            "The action of the step before is recorded, not that of the step.": np.concatenate(
                [np.zeros((1, 2)), right["actions"][:-1]]
            ),
        },
        "rewards": {
            "The sum of the rewards so far is recorded, not the reward of each step.": np.cumsum(
                right["rewards"]
            ),
            "The rewards are added up, but the reward of each step is asked for.": right[
                "rewards"
            ].sum(),
            "The mean reward so far is recorded, not the reward of each step.": np.cumsum(
                right["rewards"]
            )
            / np.arange(1, last + 1),
            "The rewards come one step too late, a 0 first, without the last one.": np.append(
                0, right["rewards"][:-1]
            ),
            "A 0 too much stands before the rewards.": np.append(0, right["rewards"]),
        },
    }.get(name, {})
    return {text: values[:many] if np.ndim(values) else values
            for text, values in (found | more).items()}  # fmt: skip


def place(rng: np.random.Generator) -> tuple:
    """A start and a cylinder."""
    start = rng.uniform((160, 280, 0), (240, 340, 6.28))
    return start, rng.uniform((110, 110), (290, 190))


# ------------------------------------------------------------------- 6.1
network = exercise.task("6.1", "One step of an LSTM")


def random_memory(rng: np.random.Generator) -> np.ndarray:
    return np.array([rng.normal(size=UNITS), rng.uniform(-1, 1, UNITS)])


def thought(module, brain, observations, memory):
    """The network step by step: each memory is what the student made of the one before."""
    actions, memories = [], [memory]
    for observation in observations:
        action, memory = module.think(brain, observation, memories[-1])
        actions.append(action)
        memories.append(memory)
    return actions, memories


def brains(rng: np.random.Generator):
    """Brains and what they are: first those in which few weights are not 0."""
    full = weights(evolved(rng, 0))
    empty = {name: np.zeros_like(values) for name, values in full.items()}
    yield "all weights are 0", empty
    for k, gate in enumerate(GATES):
        gates = np.zeros_like(full["gates"])
        gates[k] = rng.normal(size=gates[k].shape)
        yield f"of the four gates, only {gate} has weights other than 0", {**full, "gates": gates}
    for which in range(3):
        yield f"variation {which + 1} of an evolved robot", weights(evolved(rng, which))


@network.check(10)
def one_step(student: Student):
    rng = rng_of(1)
    for what, brain in brains(rng):
        memory, observation = random_memory(rng), rng.uniform(0, 1, INPUTS)
        if not brain["gates"].any():
            memory[0], memory[1] = 1, 0.5
            what += "; cells 1, outputs 0.5"
        kept = memory.copy()
        answer = student.call("think", brain, observation, memory)
        said = f"think(brain, observation, memory) ({what})"
        expect(
            isinstance(answer, (list, tuple)) and len(answer) == 2,
            f"{said} should return two things, the action and the new memory.",
        )
        shapes = [np.shape(each) if isinstance(each, np.ndarray) else () for each in answer]
        expect(
            shapes != [(2, UNITS), (2,)],
            f"{said} returned an array of shape (2, 10) first, but the action should come first, "
            "then the new memory.",
        )
        expect(
            shapes[1] != (UNITS,),
            f"{said} returned one row as the new memory, but it should have two: cells, outputs.",
        )
        action, after = answer_of(brain, observation, kept)
        new = expect_array(f"{said}: new memory", answer[1], (2, UNITS))
        wrong = cache(partial(mistaken_parts, brain, observation, kept))
        why = partial(inside, brain, observation, kept)
        for row, name in enumerate(("cells", "outputs")):
            made = partial(wrong, row)
            reason = partial(why, name)
            expect_close(f"{said}: new memory, {name}", new[row], after[row], 1e-5, made, reason)
        reason = partial(why, "action")
        expect_close(f"{said}: action", answer[0], action, 1e-5, partial(wrong, 2), reason)


@network.check(8)
def like_the_tools_network(student: Student):
    rng = rng_of(2)
    genotype = evolved(rng, 0) + 0.3 * rng.normal(size=752)
    brain, observations = weights(genotype), rng.uniform(0, 1, (40, INPUTS))
    said = "think, 40 steps one after another"
    answer = student.run(thought, brain, observations, np.zeros((2, UNITS)), said=said)
    expect(isinstance(answer, (list, tuple)) and len(answer) == 2, f"{said} gave no answers.")
    net = Network(NetworkSpec(inputs=INPUTS, outputs=2, nhiddens=UNITS, bias=1, architecture=3))
    net.parameters, expected, memories = genotype, [], [np.zeros((2, UNITS))]
    for observation in observations:
        net.observation = observation
        expected.append(net.step().copy())
        memories.append(answer_of(brain, observation, memories[-1])[1])
    expect_close(f"{said}: actions", answer[0], expected, 1e-4)
    expect_close(
        f"{said}: memories (the first is the given one, which should stay 0)",
        answer[1],
        memories,
        1e-4,
    )


# ------------------------------------------------------------------- 6.2
recording = exercise.task("6.2", "An episode, recorded", seconds=60, needs=("6.1",))


def recorded(module, brain, start, cylinder, seed, way, maxsteps):
    import numpy

    def mixed(step, before, after):
        after, before = numpy.asarray(after), numpy.asarray(before)
        return 0.6 * after + 0.3 * before + 0.01 * numpy.sin(step)

    def forgetful(step, before, after):
        return 0 * numpy.asarray(after)

    remember = {"keep": module.keep, "forget": forgetful, "mixed": mixed}[way]
    return module.episode(brain, start, cylinder, seed, remember, maxsteps)


CAUSES = {
    "poses": "the robot's pose before step {t}, to which the actions of the steps before lead",
    "observations": "what the robot senses before step {t}, with cylinder, start and seed as they "
    "are given",
    "memories": "0 at the beginning, and later what remember(k, before, after) returns with the "
    "number k of the step before, counted from 0",
    "actions": "the action that think returns for the observation and the memory of step {t}",
    "rewards": "what arena.step() returns if the wheels do the action of step {t}",
}
"""What an episode records, in the order in which one thing follows from the other."""


def first_apart(got: np.ndarray, wanted: np.ndarray) -> int:
    """The first step in which two recordings differ, as far as both reach."""
    many = min(len(got), len(wanted))
    apart = ~(np.abs(got[:many] - wanted[:many]) <= 1e-3 * (1 + np.abs(wanted[:many])))
    return int(np.append(apart.reshape(many, -1).any(axis=1), True).argmax())


def compare(student: Student, genotype: np.ndarray, where: tuple, seed: int, way, maxsteps: int):
    """The student's recording is the grader's; the difference that comes first is reported."""
    start, cylinder = where
    begin, end = (np.round(each, 1).tolist() for each in where)
    said = f"episode(brain, {begin}, {end}, {seed}, {way}, maxsteps={maxsteps})"
    brain = weights(genotype)
    answer = student.run(recorded, brain, start, cylinder, seed, way, maxsteps, said=said)
    expected = lived(brain, start, cylinder, seed, way, maxsteps)
    case = brain, start, cylinder, seed, way, maxsteps
    wrong = cache(partial(proved_recordings, answer, expected, *case))
    apart = []
    for name, value in zip(CAUSES, expect_fields(said, answer, *CAUSES), strict=True):
        wanted = expected[name]
        many = len(value) if isinstance(value, list) or np.ndim(value) else 0
        got = expect_array(f"{said}: {name}", value, (many or len(wanted), *wanted.shape[1:]))
        apart.append((first_apart(got, wanted), name, got))
    for step, name, got in sorted(apart, key=lambda each: each[0]):
        what = CAUSES[name].format(t=step)
        if step < (many := min(len(got), len(expected[name]))):
            what = f" (all that comes before is right; the first wrong entry should be {what})"
            made = partial(wrong_parts, wrong, expected, name, many)
            expect_close(f"{said}: {name}{what}", got[:many], expected[name][:many], 1e-3, made)
        steps = len(expected["rewards"])
        ends = "with maxsteps" if steps == maxsteps else "with a collision"
        what = f" (only its length is wrong; the episode should end {ends}, after {steps} steps"
        if (own := len(answer["rewards"])) not in (steps, maxsteps):
            what += f"; the number of your rewards is {own}"
        what += ")"
        made = partial(wrong_parts, wrong, expected, name, None)
        expect_close(f"{said}: {name}{what}", got, expected[name], 1e-3, made)


@recording.check(7)
def starts_where_it_should(student: Student):
    for index in (3, 4):
        rng = rng_of(index)
        compare(student, evolved(rng, index % 3), place(rng), exercise.seed(index), "keep", 25)
    for index in (22, 25):  # the cylinder stands before the robot, where its sensors see it
        start, _ = place(rng)
        ahead = start[:2] + 55 * np.array([np.cos(start[2]), np.sin(start[2])])
        compare(student, evolved(rng, 0), (start, ahead), exercise.seed(index), "keep", 5)


@recording.check(6)
def remembers_as_told(student: Student):
    for index, way in enumerate(WAYS, 5):
        rng = rng_of(index)
        compare(student, evolved(rng, index % 3), place(rng), exercise.seed(index), way, 60)


@recording.check(4)
def ends_with_a_collision(student: Student):
    rng = rng_of(9)
    for _ in range(2):
        genotype, where = bold(rng), place(rng)
        compare(student, genotype, where, int(rng.integers(1 << 31)), "keep", 200)


@recording.check(1)
def lasts_longer_than_500_steps(student: Student):
    """By rounding, long episodes may differ; only an end with the arena's usual limit is wrong."""
    rng, seed = rng_of(24), exercise.seed(24)
    for which in range(12):
        brain, (start, cylinder) = weights(evolved(rng, which % 3)), place(rng)
        if len(lived(brain, start, cylinder, seed, "keep", 520)["rewards"]) == 520:
            break
    said = f"episode(brain, start, cylinder, {seed}, keep, maxsteps=520)"
    answer = student.run(recorded, brain, start, cylinder, seed, "keep", 520, said=said)
    (rewards,) = expect_fields(said, answer, "rewards")
    steps = len(rewards) if isinstance(rewards, (list, np.ndarray)) else 0
    expect(steps != 500, f"{said} ended after 500 steps, but maxsteps allows 520.")


# ------------------------------------------------------------------- 6.3
starts = exercise.task("6.3", "A grid of starts")


GRID = (
    "x should take {places} evenly spaced values from 150 to 250, both ends included, and should "
    "change faster than y.",
    "y should take {places} evenly spaced values from 270 to 350, both ends included, and should "
    "change slowest.",
    "The headings should be the multiples of 2 pi / {headings} from 0 on, without 2 pi, and should "
    "change fastest.",
)
"""What the text says about the columns of a grid."""


@starts.check(8)
def starts_of_a_grid(student: Student):
    rng = rng_of(9)
    for places, headings in ((2, 1), (3, 4), (4, int(rng.integers(5, 9))), (7, 2)):
        wanted = grid_of(places, headings)
        answer = student.call("grid", places, headings)
        answer = expect_array(student.said, answer, wanted.shape)
        for column, name in enumerate(("x", "y", "headings")):
            said = f"{student.said}: column {column}, {name}"
            made = partial(wrong_grids, places, headings, column)
            why = GRID[column].format(places=places, headings=headings)
            expect_close(
                said, answer[:, column], wanted[:, column], 1e-6, made, lambda _, why=why: why
            )


# ------------------------------------------------------------------- 6.4
behaviour = exercise.task("6.4", "A behaviour in six numbers")


EDGES = np.array(
    [
        [(40, 200), (72.4, 200), (360, 190), (327.6, 210), (190, 40), (210, 72.4), (200, 360)],
        [(200, 327.6), (72.5, 200), (327.5, 190), (210, 72.5), (200, 327.5), (150, 90), (180, 300)],
        [(45, 50), (350, 345), (50, 340), (340, 60), (42, 357), (60, 66), (333, 40)],
    ]
).reshape(-1, 2)
"""Places: eight nearer to each of the walls than sensors see, four exactly as near, two farther,
and seven in the corners, near two walls.
"""


def wandering(rng: np.random.Generator, steps: int, first: int, last: int) -> tuple:
    """Poses, rewards and a cylinder: a made-up walk that is near from step first to last.

    The search begins near a wall and ends far from all; the heading goes beyond the whole turn,
    back, and beyond it again; the robot loses the cylinder once, if there is time.
    """
    heading = 6.6 + np.cumsum(rng.normal(0.3, 0.4, steps + 1))
    heading[:3] = rng.uniform((6, 6.4, 5.5), (6.2, 6.6, 6))
    stride = rng.uniform(-8, 12, steps)
    x, y = rng.uniform(60, 340, (2, 1))
    x = np.append(x, x + np.cumsum(stride * np.cos(heading[:-1])))
    y = np.append(y, y + np.cumsum(stride * np.sin(heading[:-1])))
    x, y = (30 + np.abs((z - 30 + 340) % 680 - 340) for z in (x, y))
    rewards = np.zeros(steps)
    rewards[first:last] = rng.uniform(size=max(last - first, 0)) < 0.7
    if first < last:
        rewards[[first, last - 1]] = 1
        rewards[first + 1 : last - 1][:1] = 0
    poses = np.stack([x, y, heading % (2 * np.pi)], axis=1)
    search = first if first < last else steps
    poses[:search, :2][: len(EDGES)] = rng.permutation(EDGES)[:search]
    poses[:search, :2][:1] = (40, rng.integers(180, 220))
    poses[search, :2] = rng.integers(180, 220, 2)
    return poses.round(2), rewards, rng.integers((110, 110), (290, 190)).tolist()


FEW_STEPS = 6
"""The values of so many steps, at most, are shown one by one."""


def spoiled_described(walk: tuple, name: str, right: float) -> dict:
    return spoiled(wrong_described(*walk, name), right, changed_described(*walk, name))


def compare_described(student: Student, walk: tuple, names: tuple) -> None:
    answer = student.call("describe", *walk)
    expected = described(*walk)
    steps, near = len(walk[1]), np.flatnonzero(walk[1]).tolist()
    which = f"steps {near}" if near else "no step"
    said = f"describe(poses, rewards, cylinder) ({steps} steps; {which} near the cylinder): "
    for name, value in zip(names, expect_fields(student.said, answer, *names), strict=True):
        made = partial(spoiled_described, walk, name, expected[name])
        why = f"{name} should be {MEANT[name][0].lower()}{MEANT[name][1:]}"
        if name in expected["steps"] and steps <= FEW_STEPS:
            each = np.round(np.array(expected["steps"][name], dtype=float), 3).tolist()
            why += f" The values of these steps should be {each}."
        expect_close(said + name, value, expected[name], 1e-4, made, lambda why=why: why)


SEARCHES = ((6, 3, 6), (4, 0, 0), (30, 20, 28), (60, 41, 60), (40, 0, 0))
"""Steps of a walk, the first one near the cylinder, and the last."""


@behaviour.check(3)
def length_of_the_search(student: Student):
    rng = rng_of(10)
    for case in SEARCHES:
        compare_described(student, wandering(rng, *case), ("search",))


@behaviour.check(7)
def of_the_search(student: Student):
    rng = rng_of(10)
    for case in SEARCHES:
        compare_described(student, wandering(rng, *case), ("speed", "turning", "wall"))


@behaviour.check(7)
def near_the_cylinder(student: Student):
    rng = rng_of(11)
    for steps, first, last in ((6, 2, 6), (30, 10, 30), (50, 5, 45), (80, 40, 70)):
        compare_described(student, wandering(rng, steps, first, last), ("pace", "side"))


@behaviour.check(3)
def of_nothing(student: Student):
    rng = rng_of(12)
    names = ("search", "speed", "turning", "wall", "pace", "side")
    for steps, first, last in ((20, 0, 0), (25, 0, 20)):
        compare_described(student, wandering(rng, steps, first, last), names)


# ------------------------------------------------------------------- 6.5
groups = exercise.task("6.5", "Families")


def spoiled_scales(table: np.ndarray, right: np.ndarray) -> dict:
    return spoiled(wrong_scales(table), right)


@groups.check(4)
def one_scale(student: Student):
    rng = rng_of(13)
    for robots, columns in ((3, 2), (7, 6)):
        table = rng.normal(
            rng.uniform(-50, 50, columns), rng.uniform(0.1, 90, columns), (robots, columns)
        )
        expected = (table - table.mean(axis=0)) / table.std(axis=0)
        answer = student.call("standardise", table)
        made, why = partial(spoiled_scales, table, expected), partial(scaled, answer, table)
        expect_close("standardise(table)", answer, expected, 1e-5, made, why)
    table[:, 2], expected[:, 2] = 3.5, 0.0
    said = "standardise(table), one column all 3.5 (it should become 0)"
    expect_close(said, student.call("standardise", table), expected, 1e-5)


@groups.check(1)
def equal_but_for_rounding(student: Student):
    table = rng_of(20).normal(size=(7, 3))
    table[:, 1] = 3.7
    answer = student.call("standardise", table)
    expected = table - table.mean(axis=0)
    expected[:, [0, 2]] /= table.std(axis=0)[[0, 2]]
    expected[:, 1] = 0
    said = (
        "standardise(table), one column all 3.7 (it should become 0; NumPy's standard deviation "
        f"of it is not exactly 0, but {table.std(axis=0)[1]:.1g}, by rounding)"
    )
    expect_close(said, answer, expected, 1e-5)


def compare_grouped(student: Student, table: np.ndarray, threshold: float, which: str = "") -> None:
    answer = student.call("families", table, threshold)
    expected = grouped(table, threshold)
    said = f"families(<{len(table)} robots>, threshold={threshold:.3g}{which})"
    if isinstance(answer, (list, tuple)) and any(
        isinstance(each, (list, tuple)) for each in answer
    ):
        expect(
            False,
            f"{said} returned lists inside a list, but one number for each robot is asked for, "
            "that of its family, in the order of the robots.",
        )
    many = np.size(answer) if isinstance(answer, (list, tuple, np.ndarray)) else len(table)
    expect(
        many == len(table),
        f"{said} returned an answer of size {many}, but the family of each of the {len(table)} "
        "robots is asked for.",
    )
    got = expect_array(said, answer, (len(table),))
    order = "The families are right, but not numbered from 0 in the order of their first robots."
    same = numbered(got.tolist()) == expected
    made = (
        {order: got} if same else {"All robots are in one family, but they should not be.": 0 * got}
    )
    if not (which or same):  # what differs at the very threshold shows little about the cause
        made = partial(wrong_families, table, threshold)

    def why(robot: int) -> str:
        told: list[str] = []
        grouped(table, threshold, told)
        ends = f"Merging should end when no two are nearer than {threshold:.3g}."
        return f"In the right order: {'; then '.join(told)}. {ends}" if len(table) <= 6 else ""

    expect_close(said, answer, expected, mistakes=made, why=why)


@groups.check(5)
def clear_families(student: Student):
    """Three clouds far apart, whatever the linkage, with columns of very different scales."""
    rng = rng_of(14)
    kinds = np.append([0, 1, 2], rng.integers(0, 3, 5))
    rng.shuffle(kinds)
    centres = np.array([[0, 0, 0], [0, 6, 6], [6, 0, 6]])
    table = (centres[kinds] + 0.2 * rng.normal(size=(8, 3))) * (1000, 1, 0.01)
    compare_grouped(student, table, 1.2)
    compare_grouped(student, table, 100.0)
    compare_grouped(student, table, 1e-6)
    exactly = ", which is exactly the distance of two families, so they are not nearer than it"
    for low, high, many in ((3.0, 7.0, 1), (-6.0, 6.0, 1), (1.0, 5.0, 2), (-2.0, 4.0, 3)):
        table = np.repeat([[low], [high]], many, axis=0)
        for threshold in (1.9, 2.1):  # who is wrong here is not wrong about equality
            compare_grouped(student, table, threshold)
        compare_grouped(student, table, 2.0, exactly)


@groups.check(6)
def by_mean_distance(student: Student):
    rng = rng_of(15)
    for robots, columns in ((4, 2), (5, 2), (6, 2), (6, 4), (10, 4), *[(14, 4)] * 6):
        table = rng.normal(size=(robots, columns)) * (1, 20, 300, 0.1)[:columns]
        lowest, highest = (0.8, 2.5) if columns == 2 else (2.0, 3.0)
        for threshold in rng.uniform(lowest, highest, 2):
            compare_grouped(student, table.round(3), float(threshold.round(2)))


# ------------------------------------------------------------------- 6.6
without = exercise.task("6.6", "Without memory", seconds=90, needs=("6.2",))


def remembering(module, since, first, afters):
    """The memory step by step, each the one before of the next, in two episodes; then forgotten."""
    import numpy

    def memories(way, afters):
        memory, kept = first.copy(), []
        for step, after in enumerate(afters):
            memory = way(step, memory, after.copy())
            if memory is None:
                raise TypeError("None came back, but the memory should be returned")
            kept.append(numpy.array(memory))
        return kept

    frozen, later = module.freeze(since), module.freeze(since + 1)
    return [memories(way, -k * afters) for k in (1, 2) for way in (frozen, later, module.forget)]


def filled(number: float) -> np.ndarray:
    """A memory that is easy to recognise, and no multiple of another one."""
    return np.array([[number] * UNITS, [0.5 + number / 100] * UNITS])


@without.check(5)
def ways_to_remember(student: Student):
    rng = rng_of(16)
    for since in (0, 1, int(rng.integers(2, 7))):
        first, afters = filled(0.5), np.array([filled(k + 1.0) for k in range(9)])
        said = f"freeze({since}) and forget"
        answer = student.run(remembering, since, first, afters, said=said)
        expect(isinstance(answer, (list, tuple)) and len(answer) == 6, f"{said} gave no answers.")
        for run, found in enumerate(answer):
            episode, which = divmod(run, 3)
            way = (f"freeze({since})", f"freeze({since + 1})", "forget")[which]
            before = first
            for step, (after, got) in enumerate(zip(-(episode + 1) * afters, found, strict=True)):
                what = f"in episode {episode + 1} of 2 (where all cells of `after` in step k are "
                what += f"-{'2 (k + 1)' if episode else '(k + 1)'})"
                before = after if which < 2 and step < since + which else before
                wanted = 0 * first if which == 2 else before
                said = f"{way}(step={step}, before, after) {what}"
                made = wrong_memories(first, afters, episode)
                expect_close(said, got, wanted, 1e-6, made, lambda *_, way=way: REMEMBERED[way[:6]])


@lru_cache
def trial(many: int, drawn: int, which: int) -> tuple:
    """A brain, starts, a cylinder and a seed; drawn: the seed of all of them."""
    rng = np.random.default_rng(drawn)
    brain = weights(evolved(rng, which))
    cylinder = rng.uniform((180, 170), (220, 190)).round()
    places = [(x, 282, 4.2 + rng.uniform(0, 1)) for x in (175, 200, 225)[:many]]
    return brain, np.array(places).round(2), cylinder, int(rng.integers(100_000))


@lru_cache(maxsize=4096)
def outcome(case: tuple, place: int, seed: int, way, maxsteps: int) -> tuple[float, int]:
    """The return and the steps of an episode."""
    brain, places, cylinder, _ = trial(*case)
    rewards = lived(brain, places[place], cylinder, seed, way, maxsteps)["rewards"]
    return float(rewards.sum()), len(rewards)


def returns_of(case: tuple, way, maxsteps: int, seeds=None) -> list[float]:
    """The return of each episode; seeds: others than seed + i."""
    seed, many = trial(*case)[-1], case[0]
    seeds = range(seed, seed + many) if seeds is None else seeds
    return [outcome(case, i, other, way, maxsteps)[0] for i, other in enumerate(seeds)]


def wrong_means(case: tuple, ways: dict, name: str, maxsteps: int) -> dict:
    """What slips make of a mean of returns."""
    many, seed, way, since = case[0], trial(*case)[-1], ways[name], ways["freeze"]
    each = returns_of(case, way, maxsteps)
    all_ways = {key: returns_of(case, other, maxsteps) for key, other in ways.items()}
    steps = [outcome(case, i, seed + i, way, maxsteps)[1] for i in range(many)]
    other_seeds = {
        "All episodes have the same seed, but that from starts[i] should have `seed + i`.":
        [seed] * many,
        "The seeds count from `seed + 1` on, but the first episode should have `seed`.":
        range(seed + 1, seed + 1 + many),
        "The episode from starts[i] has the seed i, but should have `seed + i`.": range(many),
        "The seeds are in the opposite order, but should grow from `seed` on.":
        range(seed + many - 1, seed - 1, -1),
        "The seeds go on from one kind of memory to the next, but all three should have the same.":
        range(seed + many * list(ways).index(name), seed + many * (1 + list(ways).index(name))),
    }  # fmt: skip
    found = {
        "This is the sum of the returns, but their mean is asked for.": np.sum(each),
        "This is the return from the first start, not the mean over all starts.": each[0],
        "This is the return from the last start, not the mean over all starts.": each[-1],
        "The best return is taken, not the mean.": np.max(each),
        "The worst return is taken, not the mean.": np.min(each),
        "The median of the returns is taken, not the mean.": np.median(each),
        "This is the mean number of steps of the episodes, not the mean of their returns.":
        np.mean(steps),
        "This is the mean reward of a step, not the return.": np.mean(np.divide(each, steps)),
        "This is the reward of all steps divided by all steps, not the return.":
        np.sum(each) / np.sum(steps),
        "The mean is divided by maxsteps, but should be the mean return itself.":
        np.mean(each) / maxsteps,
        "The mean is divided by that of keep, but should be the mean return itself.":
        np.mean(each) / max(np.mean(all_ways["keep"]), 1e-9),
        "The mean is subtracted from that of keep, but should be the mean return itself.":
        np.mean(all_ways["keep"]) - np.mean(each),
        "The mean of keep is subtracted from this mean, but should not be.":
        np.mean(each) - np.mean(all_ways["keep"]),
        "The sum is divided by one more than the number of starts.": np.sum(each) / (many + 1),
        "The returns of all starts are given, but their mean is asked for.": np.array(each),
        "This is the standard deviation of the returns, not the mean.": np.std(each),
    } | {
        text: np.mean(returns_of(case, way, maxsteps, seeds)) for text, seeds in other_seeds.items()
    } | {
        f"This is the mean with {key}, not that with {name}.": np.mean(values)
        for key, values in all_ways.items() if key != name
    } | {
        "The last start is left out.": np.mean(each[:-1] or [0.0]),
        "The first start is left out.": np.mean(each[1:] or [0.0]),
    }  # fmt: skip
    shorter = returns_of(case, way, since)
    found["The episodes end after `since` steps, but should last up to maxsteps."] = np.mean(
        shorter
    )
    if many == 1:
        found["The episodes last up to 500 steps, but should last up to maxsteps."] = np.mean(
            returns_of(case, way, 500)
        )
    if name == "forget":
        later = [outcome(case, i, seed + i, f"forget {since}", maxsteps)[0] for i in range(many)]
        found[
            "The memory is emptied from step `since` on only, but should be emptied in each step."
        ] = np.mean(later)
    return found


@without.check(9)
def what_memory_is_worth(student: Student):
    for index, since, maxsteps, many in ((21, 30, 80, 1), (17, 40, 130, 3), (18, 25, 90, 3)):
        case = many, exercise.seed(index), index % 3
        brain, places, cylinder, seed = trial(*case)
        answer = student.call("memory_test", brain, places, cylinder, seed, since, maxsteps)
        ways = {"keep": "keep", "forget": "forget", "freeze": since}
        for name, value in zip(ways, expect_fields(student.said, answer, *ways), strict=True):
            each = returns_of(case, ways[name], maxsteps)
            why = f"The list of returns should be {each}, and its mean is asked for."
            mistakes = partial(wrong_means, case, ways, name, maxsteps)
            said = f"memory_test(brain, {many} starts, {cylinder.tolist()}, {seed}, since={since}, "
            said += f"maxsteps={maxsteps}): {name}"
            expect_close(said, value, np.mean(each), 1e-9, mistakes, lambda why=why: why)


# ------------------------------------------------------------------- 6.7
same = exercise.task("6.7", "The same sight, another mind", needs=("6.1",))


def spoiled_reactions(brain: dict, seen: np.ndarray, memories: np.ndarray, right: list) -> dict:
    changed = {
        "The observation is divided by the number of memories.": seen / len(memories),
        "The observation is taken in the opposite order.": seen[::-1],
        "The observation is put through tanh first.": np.tanh(seen),
        "The observation is rounded first.": seen.round(),
        "The mean of the observation stands in each place.": 0 * seen + seen.mean(),
    }
    made = {
        text: [answer_of(brain, other, memory)[0] for memory in memories]
        for text, other in changed.items()
    }
    return spoiled(wrong_reactions(brain, seen, memories), right, made)


@same.check(6)
def reactions_to_one_sight(student: Student):
    rng = rng_of(19)
    for which, n in ((0, 1), (1, 5), (2, 60)):
        brain, seen = weights(evolved(rng, which)), rng.uniform(0, 1, INPUTS)
        memories = np.array([random_memory(rng) for _ in range(n)])
        answer = student.call("reactions", brain, seen, memories)
        expected = [answer_of(brain, seen, memory)[0] for memory in memories]
        made = partial(spoiled_reactions, brain, seen, memories, expected)
        expect_close(student.said, answer, expected, 1e-5, made)
