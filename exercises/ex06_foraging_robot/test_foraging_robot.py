"""Grader of exercise 6; run it with `make test-ex6`.

Nothing here is a matter of luck, and no check needs a margin: the arena and its noise follow from a
seed, and the grader steps each episode again with a network of its own. Brains are variations of
the pre-evolved robots of data/genotypes, and of robots that drive into a wall, drawn from the
grading seed like starts, cylinders, seeds and ways to remember.
"""

import numpy as np

from botschool import arena as arenas
from botschool.course import genotype_file
from botschool.grading import Exercise, Student, expect, expect_array, expect_close, expect_fields
from botschool.net import Network, NetworkSpec

exercise = Exercise(6, "A foraging robot", file="foraging_robot.py")
UNITS, INPUTS = 10, 8
WAYS = ("keep", "forget", "mixed")


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
def squash(x: np.ndarray) -> np.ndarray:
    return 0.5 + 0.5 * np.tanh(0.5 * x)


def answer_of(brain: dict, observation: np.ndarray, memory: np.ndarray) -> tuple:
    known = np.append(observation, memory[1])
    net = np.einsum("gui,i->gu", brain["gates"], known)
    cells = squash(net[0] + 1) * memory[0] + squash(net[1]) * np.tanh(net[3])
    outputs = squash(net[2]) * np.tanh(cells)
    wheels = np.tanh(brain["bias"] + brain["readout"] @ outputs)
    return wheels, np.array([cells, outputs])


def mistaken(brain: dict, observation: np.ndarray, memory: np.ndarray) -> dict[str, tuple]:
    """What mistakes make of a step: a sentence -> (action, new memory)."""
    readout, bias = brain["readout"], brain["bias"]

    def of(
        known=None,
        gates=(0, 1, 2, 3),
        one=1.0,
        gate=squash,
        forget=None,
        enter=None,
        leave=None,
        candidate=np.tanh,
        shown=None,
    ) -> tuple:
        seen = np.append(observation, memory[1]) if known is None else known
        net = np.einsum("gui,i->gu", brain["gates"], seen)[list(gates)]
        kept = gate(net[0] + one)
        taken = gate(net[1]) if enter is None else enter(kept)
        kept = kept if forget is None else forget
        cells = kept * memory[0] + taken * candidate(net[3])
        outputs = (gate(net[2]) if leave is None else leave) * (shown or np.tanh)(cells)
        return np.tanh(bias + readout @ outputs), np.array([cells, outputs])

    _, (cells, outputs) = right = answer_of(brain, observation, memory)
    return {
        "The 1 that is added for the forget gate is left out.": of(one=0.0),
        "The gates are taken in another order: the first is the forget gate, the second the "
        "input gate.": of(gates=(1, 0, 2, 3)),
        "The gates are taken in another order: the second is the input gate, the third the "
        "output gate.": of(gates=(0, 2, 1, 3)),
        "The gates are taken in another order: the third is the output gate, the fourth the "
        "candidate.": of(gates=(0, 1, 3, 2)),
        "The candidate goes through tanh, not through the logistic function.": of(
            candidate=squash
        ),
        "tanh of the candidate is left out.": of(candidate=lambda x: x),
        "The new cells go through tanh before the output gate.": of(shown=lambda x: x),
        "The outputs show the cells of the step before: the new ones are asked for.": of(
            shown=lambda _: np.tanh(memory[0])
        ),
        "The gates use the logistic function, not tanh.": of(gate=np.tanh),
        "The input gate is a gate of its own, not 1 minus the forget gate.": of(
            enter=lambda kept: 1 - kept
        ),
        "The forget gate is not applied: the old cells are kept whole.": of(forget=1.0),
        "The old cells are forgotten whole: the forget gate decides how much of them stays.": of(
            forget=0.0
        ),
        "The input gate is not applied to the candidate.": of(enter=lambda _: 1.0),
        "The output gate is not applied.": of(leave=1.0),
        "The network sees its cells (row 0 of the memory) instead of its outputs (row 1).": of(
            known=np.append(observation, memory[0])
        ),
        "The outputs of the step before stand in front of the observation, but belong behind "
        "it.": of(known=np.append(memory[1], observation)),
        "The outputs of the step before are left out: 0 stands in their place.": of(
            known=np.append(observation, np.zeros(UNITS))
        ),
        "The rows of the new memory are exchanged: the cells come first.": (
            right[0], np.array([outputs, cells])
        ),
        "The action is not put through tanh.": (bias + readout @ outputs, right[1]),
        "The bias of the two wheels is left out.": (np.tanh(readout @ outputs), right[1]),
        "The action is read from the cells instead of the outputs.": (
            np.tanh(bias + readout @ cells), right[1]
        ),
        "The action is read from the outputs of the step before.": (
            np.tanh(bias + readout @ memory[1]), right[1]
        ),
        "The action goes through the logistic function instead of tanh.": (
            squash(bias + readout @ outputs), right[1]
        ),
    }  # fmt: skip


def remembered(way, step: int, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    if way == "mixed":
        return 0.6 * after + 0.3 * before + 0.01 * np.sin(step)
    if way == "forget":
        return 0 * after
    return after if way == "keep" or step < way else before


def lived(brain: dict, start, cylinder, seed: int, way, maxsteps: int) -> dict:
    """An episode; way: keep, forget, mixed, or the step from which memory is frozen."""
    arena = arenas.make("discrim", max_steps=maxsteps)
    arena.reset(seed)
    arena.robots[0], arena.objects[0, :2] = start, cylinder
    arena.sense()
    memory, rows = np.zeros((2, UNITS)), []
    poses = [arena.robots[0].copy()]
    while not arena.done:
        seen = arena.observation.copy()
        arena.action, after = answer_of(brain, seen, memory)
        reward = arena.step()
        rows.append((seen, memory, arena.action.copy(), reward))
        poses.append(arena.robots[0].copy())
        memory = remembered(way, len(rows) - 1, memory, after)
    seen, memories, actions, rewards = map(np.array, zip(*rows, strict=True))
    return {"poses": np.array(poses), "observations": seen, "memories": memories,
            "actions": actions, "rewards": rewards}  # fmt: skip


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


@network.check(10)
def one_step(student: Student):
    rng = rng_of(1)
    for which in range(3):
        brain, memory = weights(evolved(rng, which)), random_memory(rng)
        observation = rng.uniform(0, 1, INPUTS)
        kept = memory.copy()
        answer = student.call("think", brain, observation, memory)
        said = "think(brain, observation, memory)"
        expect(
            isinstance(answer, (list, tuple)) and len(answer) == 2,
            f"{said} must return two things: the action, and the new memory.",
        )
        action, after = answer_of(brain, observation, kept)
        new = expect_array(f"{said}: new memory", answer[1], (2, UNITS))
        wrong = mistaken(brain, observation, kept)
        for row, name in enumerate(("cells", "outputs")):
            made = {text: memory[row] for text, (_, memory) in wrong.items()}
            expect_close(f"{said}: new memory, {name}", new[row], after[row], 1e-5, made)
        made = {text: wheels for text, (wheels, _) in wrong.items()}
        expect_close(f"{said}: action", answer[0], action, 1e-5, made)


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
    expect_close(f"{said}: memories (the given ones stay as they are)", answer[1], memories, 1e-4)


# ------------------------------------------------------------------- 6.2
recording = exercise.task("6.2", "An episode, recorded", seconds=60, needs=("6.1",))


def recorded(module, brain, start, cylinder, seed, way, maxsteps):
    import numpy

    def mixed(step, before, after):
        return 0.6 * after + 0.3 * before + 0.01 * numpy.sin(step)

    def forgetful(step, before, after):
        return 0 * after

    remember = {"keep": module.keep, "forget": forgetful, "mixed": mixed}[way]
    return module.episode(brain, start, cylinder, seed, remember, maxsteps)


def compare(student: Student, genotype: np.ndarray, where: tuple, seed: int, way, maxsteps: int):
    """The student's recording of an episode is what the grader finds."""
    start, cylinder = where
    said = f"episode(brain, start, cylinder, seed={seed}, remember={way}, maxsteps={maxsteps})"
    brain = weights(genotype)
    answer = student.run(recorded, brain, start, cylinder, seed, way, maxsteps, said=said)
    expected = lived(brain, start, cylinder, seed, way, maxsteps)
    for name, value in zip(expected, expect_fields(said, answer, *expected), strict=True):
        expect_close(f"{said}: {name}", value, expected[name], 1e-3)


@recording.check(7)
def starts_where_it_should(student: Student):
    for index in (3, 4):
        rng = rng_of(index)
        compare(student, evolved(rng, index % 3), place(rng), exercise.seed(index), "keep", 25)


@recording.check(6)
def remembers_as_told(student: Student):
    for index, way in enumerate(WAYS, 5):
        rng = rng_of(index)
        compare(student, evolved(rng, index % 3), place(rng), exercise.seed(index), way, 60)


@recording.check(5)
def ends_with_a_collision(student: Student):
    rng = rng_of(8)
    for _ in range(2):
        genotype, where = bold(rng), place(rng)
        compare(student, genotype, where, int(rng.integers(1 << 31)), "keep", 200)


# ------------------------------------------------------------------- 6.3
starts = exercise.task("6.3", "A grid of starts")


def grid_of(places: int, headings: int) -> np.ndarray:
    ys, xs = np.linspace(270, 350, places), np.linspace(150, 250, places)
    return np.array(
        [(x, y, 2 * np.pi * k / headings) for y in ys for x in xs for k in range(headings)]
    )


@starts.check(8)
def starts_of_a_grid(student: Student):
    rng = rng_of(9)
    for places, headings in ((2, 1), (3, 4), (int(rng.integers(4, 7)), int(rng.integers(5, 9)))):
        answer = student.call("grid", places, headings)
        expect_close(student.said, answer, grid_of(places, headings), 1e-6)


# ------------------------------------------------------------------- 6.4
behaviour = exercise.task("6.4", "A behaviour in six numbers")
NEAR = 100.0


def wandering(rng: np.random.Generator, steps: int, first: int, last: int) -> tuple:
    """Poses, rewards and a cylinder: a made-up walk that is near from step first to last."""
    heading = rng.uniform(0, 6.28) + np.cumsum(rng.normal(0, 0.5, steps + 1))
    stride = rng.uniform(-8, 12, steps)
    x, y = rng.uniform(60, 340, (2, 1))
    x = np.append(x, x + np.cumsum(stride * np.cos(heading[:-1])))
    y = np.append(y, y + np.cumsum(stride * np.sin(heading[:-1])))
    x, y = (30 + np.abs((z - 30 + 340) % 680 - 340) for z in (x, y))
    rewards = np.zeros(steps)
    rewards[first:last] = rng.uniform(size=max(last - first, 0)) < 0.7
    if first < last:
        rewards[first] = 1
    poses = np.stack([x, y, heading % (2 * np.pi)], axis=1)
    poses[1:4, :2] = (
        (72.5, 200),
        (200, 327.5),
        (72.4, 200),
    )  # just as near as sensors see, or nearer
    return poses, rewards, rng.uniform((110, 110), (290, 190))


def described(poses: np.ndarray, rewards: np.ndarray, cylinder) -> dict:
    found = np.flatnonzero(rewards)
    search = int(found[0]) if len(found) else len(rewards)
    told = {key: [] for key in ("speed", "turning", "wall", "pace", "side")}
    for t in range(len(rewards)):
        (x, y, heading), (x2, y2, heading2) = poses[t], poses[t + 1]
        if t < search:
            told["speed"].append((x2 - x) * np.cos(heading) + (y2 - y) * np.sin(heading))
            turned = heading2 - heading
            told["turning"].append(np.arctan2(np.sin(turned), np.cos(turned)))
            told["wall"].append(min(x, y, 400 - x, 400 - y) < 72.5)
        if rewards[t] > 0:
            told["pace"].append(np.hypot(x2 - x, y2 - y))
            dx, dy = cylinder[0] - x2, cylinder[1] - y2
            left = np.cos(heading2) * dy - np.sin(heading2) * dx
            told["side"].append(left / np.hypot(dx, dy))
    return {"search": search, **{k: float(np.mean(v)) if v else 0.0 for k, v in told.items()}}


def compare_described(student: Student, walk: tuple, names: tuple) -> None:
    answer = student.call("describe", *walk)
    expected = described(*walk)
    for name, value in zip(names, expect_fields(student.said, answer, *names), strict=True):
        near = int(np.sum(np.asarray(walk[1]) > 0))
        said = f"describe(<{len(walk[1])} steps, near the cylinder in {near}>): {name}"
        expect_close(said, value, expected[name], 1e-4)


@behaviour.check(10)
def of_the_search(student: Student):
    rng = rng_of(10)
    for steps, first, last in ((30, 20, 28), (60, 41, 60), (40, 0, 0)):
        walk = wandering(rng, steps, first, last)
        compare_described(student, walk, ("search", "speed", "turning", "wall"))


@behaviour.check(7)
def near_the_cylinder(student: Student):
    rng = rng_of(11)
    for steps, first, last in ((30, 10, 30), (50, 5, 45), (80, 40, 70)):
        compare_described(student, wandering(rng, steps, first, last), ("pace", "side"))


@behaviour.check(3)
def of_nothing(student: Student):
    rng = rng_of(12)
    names = ("search", "speed", "turning", "wall", "pace", "side")
    for steps, first, last in ((20, 0, 0), (25, 0, 20)):
        compare_described(student, wandering(rng, steps, first, last), names)


# ------------------------------------------------------------------- 6.5
groups = exercise.task("6.5", "Families")


@groups.check(4)
def one_scale(student: Student):
    rng = rng_of(13)
    for robots, columns in ((3, 2), (7, 6)):
        table = rng.normal(
            rng.uniform(-50, 50, columns), rng.uniform(0.1, 90, columns), (robots, columns)
        )
        expected = (table - table.mean(axis=0)) / table.std(axis=0)
        expect_close("standardise(table)", student.call("standardise", table), expected, 1e-5)
    table[:, 2], expected[:, 2] = 3.5, 0.0
    said = "standardise(table), one column all alike"
    expect_close(said, student.call("standardise", table), expected, 1e-5)


@groups.check(1)
def equal_but_for_rounding(student: Student):
    table = rng_of(20).normal(size=(7, 3))
    table[:, 1] = 3.7
    answer = student.call("standardise", table)
    expected = table - table.mean(axis=0)
    expected[:, [0, 2]] /= table.std(axis=0)[[0, 2]]
    said = (
        "standardise(table), one column all 3.7 (of which NumPy's standard deviation is "
        f"{table.std(axis=0)[1]:.1g}, by rounding)"
    )
    expect_close(said, answer, expected, 1e-5)


def grouped(table: np.ndarray, threshold: float) -> list[int]:
    rows = (table - table.mean(axis=0)) / table.std(axis=0)
    labels = np.arange(len(rows))
    while len(set(labels)) > 1:
        nearest = min(
            (
                np.mean(
                    [np.linalg.norm(a - b) for a in rows[labels == i] for b in rows[labels == j]]
                ),
                i,
                j,
            )
            for i in set(labels)
            for j in set(labels)
            if i < j
        )
        if nearest[0] >= threshold:
            break
        labels[labels == nearest[2]] = nearest[1]
    names = list(dict.fromkeys(labels.tolist()))
    return [names.index(label) for label in labels]


def compare_grouped(student: Student, table: np.ndarray, threshold: float, which: str = "") -> None:
    answer = student.call("families", table, threshold)
    expected = grouped(table, threshold)
    said = f"families(<{len(table)} robots{which}>, threshold={threshold:.3g})"
    expect_close(said, answer, expected)


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
    apart = np.array([[3.0], [7.0]])
    compare_grouped(
        student, apart, 2.0, ", whose distance is exactly the threshold, so not nearer than it"
    )


@groups.check(6)
def by_mean_distance(student: Student):
    rng = rng_of(15)
    for robots in (6, 10, 14):
        table = rng.normal(size=(robots, 4)) * (1, 20, 300, 0.1)
        for threshold in rng.uniform(1.5, 3.2, 3):
            compare_grouped(student, table, float(threshold))


# ------------------------------------------------------------------- 6.6
without = exercise.task("6.6", "Without memory", seconds=90, needs=("6.2",))


def remembering(module, since, first, afters):
    """The memory step by step, each the one before of the next."""
    import numpy

    def memories(way):
        memory, kept = first, []
        for step, after in enumerate(afters):
            memory = way(step, memory, after.copy())
            kept.append(numpy.array(memory))
        return kept

    return memories(module.freeze(since)), memories(module.forget)


@without.check(5)
def ways_to_remember(student: Student):
    rng = rng_of(16)
    for since in (0, int(rng.integers(2, 7))):
        before, afters = random_memory(rng), [random_memory(rng) for _ in range(9)]
        said = f"freeze({since}) and forget"
        answer = student.run(remembering, since, before, afters, said=said)
        expect(isinstance(answer, (list, tuple)) and len(answer) == 2, f"{said} gave no answers.")
        for step, (after, frozen, gone) in enumerate(zip(afters, *answer, strict=True)):
            shown = f"(step={step}, before, after)"
            before = after if step < since else before
            expect_close(f"freeze({since}){shown}", frozen, before, 1e-6)
            expect_close(f"forget{shown}", gone, np.zeros((2, UNITS)))


@without.check(9)
def what_memory_is_worth(student: Student):
    for index, since, maxsteps in ((17, 40, 130), (18, 25, 90)):
        rng = rng_of(index)
        brain = weights(evolved(rng, index % 3))
        cylinder = rng.uniform((180, 170), (220, 190))
        places = np.array([(x, 282, 4.2 + rng.uniform(0, 1)) for x in (175, 200, 225)])
        seed = int(rng.integers(100_000))
        answer = student.call("memory_test", brain, places, cylinder, seed, since, maxsteps)
        ways = {"keep": "keep", "forget": "forget", "freeze": since}
        values = expect_fields(student.said, answer, *ways)
        for (name, way), value in zip(ways.items(), values, strict=True):
            expected = np.mean(
                [
                    lived(brain, start, cylinder, seed + i, way, maxsteps)["rewards"].sum()
                    for i, start in enumerate(places)
                ]
            )
            expect_close(f"memory_test(..., since={since}): {name}", value, expected, 1e-9)


# ------------------------------------------------------------------- 6.7
same = exercise.task("6.7", "The same sight, another mind", needs=("6.1",))


@same.check(6)
def reactions_to_one_sight(student: Student):
    rng = rng_of(19)
    for which, n in ((0, 1), (1, 5), (2, 60)):
        brain, seen = weights(evolved(rng, which)), rng.uniform(0, 1, INPUTS)
        memories = np.array([random_memory(rng) for _ in range(n)])
        answer = student.call("reactions", brain, seen, memories)
        expected = [answer_of(brain, seen, memory)[0] for memory in memories]
        expect_close(student.said, answer, expected, 1e-5)
