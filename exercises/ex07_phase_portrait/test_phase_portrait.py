"""Grader of exercise 7; run it with `make test-ex7`.

Stochastic check (task 7.6; the mean return over 100 episodes that the submission has not seen):
the first stage below -900, the last at least -400, the middle one 100 or more away from both. The
margin over 20 seeds: the solution's first stages reach -1254 to -1120, the middle ones -729 to -615
(at least 448 away from the others), the last ones -247 to -139.
"""

import gymnasium
import numpy as np

from botschool.course import Robot
from botschool.grading import (
    Exercise,
    Student,
    Wrong,
    expect,
    expect_array,
    expect_close,
    expect_fields,
    show,
)

exercise = Exercise(7, "Phase portrait", file="phase_portrait.py")


def random_states(index: int, n: int, largest: float = np.pi) -> np.ndarray:
    """Angles and velocities from all over the state space."""
    rng = np.random.default_rng(exercise.seed(index))
    return np.stack([rng.uniform(-largest, largest, n), rng.uniform(-8, 8, n)], axis=1)


def expect_states(said: str, value, expected: np.ndarray) -> None:
    """States as expected; the angles are in [-pi, pi], of which both ends are the same."""
    states = expect_array(said, value, expected.shape)
    angles, velocities = states.T
    expect(
        bool(np.all(np.abs(angles) < np.pi + 1e-6)),
        f"{said}: the angles must be in [-pi, pi], but one is "
        f"{angles[np.abs(angles).argmax()]:.3f}.",
    )
    off = np.abs(np.sin((angles - expected[:, 0]) / 2)) > 1e-5
    if np.any(off):
        i = int(off.argmax())
        raise Wrong(f"{said}: angle {i} is {angles[i]:.5g}, but should be {expected[i, 0]:.5g}.")
    expect_close(f"{said}: velocities", velocities, expected[:, 1], 1e-5)


# ------------------------------------------------------------------- 7.1
state = exercise.task("7.1", "From observation to state")


def observed(states: np.ndarray) -> np.ndarray:
    return np.stack([np.cos(states[:, 0]), np.sin(states[:, 0]), states[:, 1]], axis=1)


@state.check(6)
def one_observation(student: Student):
    for angle, velocity in [(0.5, 1.0), (-2.5, -3.0), *random_states(1, 4)]:
        observation = observed(np.array([[angle, velocity]]))[0]
        answer = student.call("to_state", observation)
        shown = ", ".join(f"{x:.3f}" for x in observation)
        expect_close(f"to_state([{shown}])", answer, [angle, velocity], 1e-5)


@state.check(4)
def many_observations(student: Student):
    for n in (1, 3, 50):
        states = random_states(2, n)
        answer = student.call("to_state", observed(states))
        expect_close(student.said, answer, states, 1e-5)


# ------------------------------------------------------------------- 7.2
recording = exercise.task("7.2", "Recording an episode", needs=("7.1",))


def recorded(module, gains, seed, steps):
    """Records with a controller that the grader can compute again."""
    import numpy

    gains = numpy.asarray(gains)
    return module.record(lambda seen: numpy.clip([gains @ seen], -2, 2), seed, steps)


def episode(gains: np.ndarray, seed: int, steps: int) -> np.ndarray:
    env = gymnasium.make("Pendulum-v1")
    observations = [env.reset(seed=seed)[0]]
    for _ in range(steps):
        seen, _, terminated, truncated, _ = env.step(np.clip([gains @ observations[-1]], -2, 2))
        observations.append(seen)
        if terminated or truncated:
            break
    seen = np.array(observations, dtype=float)
    return np.stack([np.arctan2(seen[:, 1], seen[:, 0]), seen[:, 2]], axis=1)


def compare_recording(student: Student, index: int, steps: int) -> None:
    seed = exercise.seed(index)
    gains = np.random.default_rng(seed).uniform(-1.5, 1.5, 3)
    answer = student.run(
        recorded, gains, seed, steps, said=f"record(controller, seed={seed}, steps={steps})"
    )
    expect_states(student.said, answer, episode(gains, seed, steps))


@recording.check(11)
def states_of_an_episode(student: Student):
    for index, steps in ((3, 1), (4, 12), (5, 60)):
        compare_recording(student, index, steps)


@recording.check(4)
def ends_with_the_episode(student: Student):
    compare_recording(student, 6, 200)
    compare_recording(student, 7, 230)


# ------------------------------------------------------------------- 7.3
changes = exercise.task("7.3", "Arrows")


def compare_arrows(student: Student, before: np.ndarray, change: np.ndarray) -> None:
    after = before + change
    after[:, 0] = np.arctan2(np.sin(after[:, 0]), np.cos(after[:, 0]))
    answer = expect_array(
        "arrows(before, after)", student.call("arrows", before, after), (len(before), 4)
    )
    expected = np.hstack([before, change])
    off = np.abs(answer - expected).max(axis=1) > 1e-6
    if np.any(off):
        i = int(off.argmax())
        raise Wrong(
            f"arrows(before, after): from state {show(before[i])} to {show(after[i])} the arrow is "
            f"{show(answer[i])}, but should be {show(expected[i])}."
        )


@changes.check(6)
def starts_and_changes(student: Student):
    rng = np.random.default_rng(exercise.seed(8))
    for n in (1, 5, 40):
        compare_arrows(student, random_states(9, n, 2.5), rng.uniform(-0.5, 0.5, (n, 2)))


@changes.check(7)
def short_way_around(student: Student):
    rng = np.random.default_rng(exercise.seed(10))
    before = random_states(11, 60)
    change = np.stack([rng.uniform(-3.0, 3.0, 60), rng.uniform(-1, 1, 60)], axis=1)
    compare_arrows(student, before, change)
    before[:2, 0], change[:2, 0] = (3.1, -3.1), (0.1, -0.1)
    compare_arrows(student, before[:2], change[:2])


# ------------------------------------------------------------------- 7.4
everywhere = exercise.task("7.4", "The whole state space", needs=("7.1",))


@everywhere.check(5)
def grid_of_states(student: Student):
    for nangles, nvelocities in ((3, 2), (7, 12), (20, 5)):
        angles, velocities = np.linspace(-np.pi, np.pi, nangles), np.linspace(-8, 8, nvelocities)
        expected = [[angle, velocity] for velocity in velocities for angle in angles]
        answer = student.call("grid", nangles, nvelocities)
        expect_close(student.said, answer, expected, 1e-6)


def stepped(module, gains, states):
    import numpy

    gains = numpy.asarray(gains)
    return module.next_states(lambda seen: numpy.clip([gains @ seen], -2, 2), states)


def one_step(gains: np.ndarray, states: np.ndarray) -> np.ndarray:
    env = gymnasium.make("Pendulum-v1")
    env.reset(seed=0)
    following = []
    for seen, state in zip(observed(states), states, strict=True):
        env.unwrapped.state = state.copy()
        after, *_ = env.step(np.clip([gains @ seen], -2, 2))
        following.append([np.arctan2(after[1], after[0]), after[2]])
    return np.array(following)


@everywhere.check(5)
def pendulum_without_motor(student: Student):
    states = random_states(12, 30)
    answer = student.run(
        stepped, np.zeros(3), states, said="next_states(lambda observation: np.zeros(1), states)"
    )
    expect_states(student.said, answer, one_step(np.zeros(3), states))


@everywhere.check(8)
def pendulum_with_controller(student: Student):
    for index, n in ((13, 4), (14, 300)):
        gains = np.random.default_rng(exercise.seed(index)).uniform(-1, 1, 3)
        states = random_states(index + 2, n)
        answer = student.run(
            stepped, gains, states, said=f"next_states(controller, states), {n} states"
        )
        expect_states(student.said, answer, one_step(gains, states))


# ------------------------------------------------------------------- 7.5
stages = exercise.task("7.5", "Keeping stages of evolution")


def staged(module, prepared, target, generations, every):
    """Runs the student's loop on an algorithm whose candidates follow from what it is told."""
    import numpy

    class Algorithm:
        told = 0.0

        def __init__(self):
            self.asked = 0
            self.candidates = prepared[0].copy()

        def ask(self):
            self.candidates[:] = prepared[self.asked] + self.told  # the same array each time
            self.asked += 1
            return self.candidates, numpy.arange(len(self.candidates))

        def tell(self, fitness):
            self.told = self.told / 2 + 0.1 * float(numpy.dot(fitness, numpy.arange(len(fitness))))

    def evaluate(candidates, generation):
        return numpy.sin(3 * candidates - target).sum(axis=1) + 0.01 * generation

    return module.evolve(Algorithm(), evaluate, generations, every)


def stages_of(student: Student, index: int, generations: int, every: int):
    """What the student's loop returns, and what it should."""
    rng = np.random.default_rng(exercise.seed(index))
    prepared, target = rng.normal(size=(generations + 2, 6, 4)), rng.normal(size=4)
    answer = student.run(
        staged, prepared, target, generations, every,
        said=f"evolve(algorithm, evaluate, generations={generations}, every={every})",
    )  # fmt: skip
    expect_fields(student.said, answer, "generations", "parameters", "history")
    told, best, history = 0.0, [], []
    for generation in range(generations):
        candidates = prepared[generation] + told
        fitness = np.sin(3 * candidates - target).sum(axis=1) + 0.01 * generation
        best.append(candidates[fitness.argmax()])
        history.append(fitness.max())
        told = told / 2 + 0.1 * float(np.dot(fitness, np.arange(6)))
    return answer, np.array(best), history


@stages.check(7)
def asks_evaluates_and_tells(student: Student):
    for index, generations in ((17, 1), (18, 15)):
        answer, _, history = stages_of(student, index, generations, 5)
        expect_close(f"{student.said}: history", answer["history"], history, 1e-6)


@stages.check(6)
def keeps_every_nth_and_the_last(student: Student):
    for index, generations, every in ((19, 15, 4), (20, 9, 4), (21, 6, 1), (22, 5, 10)):
        answer, *_ = stages_of(student, index, generations, every)
        expected = sorted({*range(0, generations, every), generations - 1})
        expect_close(f"{student.said}: generations", answer["generations"], expected)


@stages.check(6)
def keeps_the_best_as_they_were(student: Student):
    for index, generations, every in ((23, 13, 3), (24, 16, 5)):
        answer, best, _ = stages_of(student, index, generations, every)
        expected = best[sorted({*range(0, generations, every), generations - 1})]
        expect_close(f"{student.said}: parameters", answer["parameters"], expected, 1e-6)


# ------------------------------------------------------------------- 7.6
three = exercise.task("7.6", "Three stages", seconds=45, needs=("7.5",))


@three.check(6)
def last_stage_holds_the_pendulum(student: Student):
    *_, last = returns_of(student)
    expect(
        last >= -400,
        f"{student.said}: the last stage reaches {last:.0f} on average over 100 new episodes, "
        "but -400 is asked for.",
    )


@three.check(7)
def stages_rise(student: Student):
    first, middle, last = returns_of(student)
    expect(
        first < -900,
        f"{student.said}: the first stage reaches {first:.0f} on average over 100 new episodes; "
        "the best of generation 0 cannot be that good.",
    )
    expect(
        first + 100 <= middle <= last - 100,
        f"{student.said}: on average over 100 new episodes the stages reach {first:.0f}, "
        f"{middle:.0f} and {last:.0f}, but the middle one must be 100 away from both others.",
    )


def returns_of(student: Student) -> np.ndarray:
    robot = Robot("Pendulum-v1")
    answer = student.call("three_stages", seed=exercise.seed(25) % 100_000)
    parameters = expect_array(student.said, answer, (3, robot.nbiases + robot.nweights))
    return robot.evaluate(parameters, exercise.seed(26), episodes=100)


# ------------------------------------------------------------------- 7.7
picture = exercise.task("7.7", "The picture", seconds=45)

LARGEST = 6000
CENTRE = np.array([[0.0, 0.0, 0.3, 0.8]])
STATES = ((-2.5, -6.0), (-1.0, -2.0), (2.0, 5.0))


def around(angle: float, velocity: float) -> np.ndarray:
    """A few arrows around a state."""
    offsets = np.array([(x, y) for x in (-0.3, 0.0, 0.3) for y in (-0.8, 0.0, 0.8)])
    starts = offsets + np.array([angle, velocity])
    return np.hstack([starts, np.tile([0.2, 0.5], (9, 1))])


def drawn(module, file, titles, fields, paths):
    module.draw_portraits(file, titles, fields, paths)


def pixels_of(student: Student, fields: list, paths: list) -> np.ndarray:
    """Draws and reads the picture: its pixels as numbers from 0 to 1, (height, width, 3)."""
    from matplotlib.image import imread

    n = len(fields)
    said = f"draw_portraits('portraits.png', ...), {n} panel{'s' if n > 1 else ''}"
    titles = ["early", "middle", "late"][:n]
    student.run(drawn, "portraits.png", titles, fields, paths, said=said)
    file = student.scratch("portraits.png")
    head = file.read_bytes()[:24]
    width, height = (int.from_bytes(head[at : at + 4], "big") for at in (16, 20))
    expect(head[:8] == b"\x89PNG\r\n\x1a\n", f"{said} wrote a file that is no PNG picture.")
    expect(
        300 * n <= width <= LARGEST and 300 <= height <= LARGEST,
        f"{said} wrote a picture of {width} x {height} pixels, but at least {300 * n} x 300 "
        f"(and at most {LARGEST} x {LARGEST}) are asked for.",
    )
    try:
        pixels = imread(file)
    except Exception:
        raise Wrong(f"{said} wrote a damaged picture.") from None
    return np.repeat(pixels[..., None], 3, axis=2) if pixels.ndim == 2 else pixels[..., :3]


def places(student: Student, drawings: list[tuple[list, list]]) -> list[tuple[float, float]]:
    """Where the three pictures differ from what they share: (from left, from below), in 0..1."""
    pictures = [pixels_of(student, *drawing) for drawing in drawings]
    height, width = np.min([each.shape[:2] for each in pictures], axis=0)
    pictures = np.array([each[:height, :width] for each in pictures])
    shared = np.median(pictures, axis=0)
    found = []
    for each in pictures:
        rows, columns = np.nonzero(np.abs(each - shared).max(axis=2) > 0.1)
        expect(
            len(rows) > 20,
            f"{student.said}: other arrows give the same picture, so they are not drawn.",
        )
        expect(
            len(rows) < 0.2 * height * width,
            f"{student.said}: other arrows change the whole picture, though the axes and panels "
            "should stay what they are.",
        )
        found.append((float(np.median(columns)) / width, 1 - float(np.median(rows)) / height))
    return found


@picture.check(4)
def field_where_it_belongs(student: Student):
    drawings = [([around(*at)], [CENTRE]) for at in STATES]
    expect_fixed_axes(student, places(student, drawings))


@picture.check(4)
def path_where_it_belongs(student: Student):
    drawings = [([CENTRE], [around(*at)]) for at in STATES]
    expect_fixed_axes(student, places(student, drawings))


def expect_fixed_axes(student: Student, found: list[tuple[float, float]]) -> None:
    """Arrows around STATES were found where axes from -pi to pi and -8 to 8 put them."""
    states, places = np.array(STATES), np.array(found)
    for name, values, spots in zip(("angles", "velocities"), states.T, places.T, strict=True):
        middle, span = spots[1] - spots[0], spots[2] - spots[0]
        share = (values[1] - values[0]) / (values[2] - values[0])
        expect(
            bool(span > 0.3 and abs(middle / span - share) < 0.06),
            f"{student.said}: arrows at the {name} {', '.join(map(str, values))} were found at "
            f"{', '.join(f'{100 * x:.0f} %' for x in spots)} of the picture. Does each panel "
            "show -pi to pi and -8 to 8, whatever is drawn?",
        )


@picture.check(4)
def one_panel_for_each(student: Student):
    here, three = around(1, 2), [CENTRE] * 3
    drawings = [(three, [here if i == k else CENTRE for i in range(3)]) for k in range(3)]
    found = [left for left, _ in places(student, drawings)]
    expect(
        all(k / 3 < left < (k + 1) / 3 for k, left in enumerate(found)),
        f"{student.said}: the arrows of panel 0, 1 and 2 should be in the left, the middle and "
        f"the right third of the picture, but are {', '.join(f'{100 * x:.0f} %' for x in found)} "
        "from the left.",
    )
