"""Grader of exercise 7; run it with `make test-ex7`.

Stochastic check (task 7.6; the mean return over 100 episodes that the submission has not seen, on
a robot whose parameters count with gains drawn in secret): the first stage below -900, the last at
least -400, the middle one 100 or more away from both. The margin over 20 seeds, each with gains of
its own: the solution's first stages reach -1273 to -1138, the middle ones -739 to -638 (at least
421 away from the others), the last ones -191 to -139. Of 300 others, 3 ended below -400: so it is
enough if the last stage of one of two seeds holds the pendulum.
"""

from pathlib import Path
from weakref import WeakKeyDictionary

import gymnasium
import numpy as np

from botschool.course import Robot
from botschool.grading import (
    Exercise,
    Mismatch,
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


def expect_states(said: str, value, expected: np.ndarray, tolerance: float = 1e-5) -> None:
    """States as expected; the angles are in [-pi, pi], of which both ends are the same."""
    states = expect_array(said, value, expected.shape)
    angles, velocities = states.T
    expect(
        bool(np.all(np.abs(angles) < np.pi + 1e-6)),
        f"{said}: the angles should be in [-pi, pi], but one is "
        f"{angles[np.abs(angles).argmax()]:.3f}.",
    )
    off = np.abs(np.sin((angles - expected[:, 0]) / 2)) > tolerance
    if np.any(off):
        i = int(off.argmax())
        raise Wrong(
            f"{said}: the angle in row {i} is {angles[i]:.5g}, but should be {expected[i, 0]:.5g}."
        )
    expect_close(f"{said}: velocities", velocities, expected[:, 1], tolerance)


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
        cosine, sine = observation[:2]
        mistakes = {
            "Cosine and sine are exchanged: np.arctan2 takes the sine first.": [
                np.arctan2(cosine, sine), velocity
            ],
            "The angle is arcsin(sine), always in [-pi / 2, pi / 2]: see np.arctan2.": [
                np.arcsin(sine), velocity
            ],
            "The angle is arctan(sine / cosine), always in [-pi / 2, pi / 2]: see np.arctan2.": [
                np.arctan(sine / cosine), velocity
            ],
        }  # fmt: skip
        expect_close(f"to_state([{shown}])", answer, [angle, velocity], 1e-5, mistakes)
    down = ([-1.0, 0.0, speed] for speed in (2.0, -3.5))
    for seen, angle in (*((each, np.pi) for each in down), ([0.0, -1.0, 2.0], -np.pi / 2)):
        answer = expect_array(f"to_state({seen})", student.call("to_state", np.array(seen)), (2,))
        answer[0] = np.pi if abs(answer[0] + np.pi) < 1e-6 else answer[0]  # both ends are pi
        mistakes = {}
        if angle == np.pi:
            text = (
                "Straight down the angle is 0, but should be pi or -pi (note that np.sign(0) is 0)."
            )
            mistakes[text] = [0.0, seen[2]]
        expect_close(f"to_state({seen})", answer, [angle, seen[2]], 1e-5, mistakes)


@state.check(4)
def many_observations(student: Student):
    for n, index in ((1, 2), (3, 2), (3, 29), (50, 2)):
        states = random_states(index, n)
        answer = student.call("to_state", observed(states))
        expect_close(student.said, answer, states, 1e-5)


# ------------------------------------------------------------------- 7.2
recording = exercise.task("7.2", "Recording an episode", needs=("7.1",))


def recorded(module, gains, seed, steps):
    """Records with a controller that the grader can compute again, and counts its actions."""
    import numpy

    gains, asked = numpy.asarray(gains), []

    def controller(seen):
        if numpy.shape(seen) != (3,):
            text = f"the controller was given {seen}, but should be given an array of shape (3,)"
            raise ValueError(text)
        asked.append(1)
        return numpy.clip([gains @ seen], -2, 2)

    return [module.record(controller, seed, steps), len(asked)]


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


def compare_recording(student: Student, index: int, steps: int, seed: int | None = None) -> None:
    seed = exercise.seed(index) if seed is None else seed
    gains = np.random.default_rng(exercise.seed(index)).uniform(-1.5, 1.5, 3)
    answer, asked = student.run(
        recorded, gains, seed, steps, said=f"record(controller, seed={seed}, steps={steps})"
    )
    wanted = episode(gains, seed, steps)
    many = len(answer) if np.ndim(answer) == 2 else 0
    expect(
        many <= len(wanted) or len(wanted) > steps,
        f"{student.said} returned {many} states, but the environment ends the episode after "
        f"{len(wanted) - 1} steps (truncated), so there should be {len(wanted)} states.",
    )
    expect_states(student.said, answer, wanted, 1e-3)  # torques in float32 too
    expect(
        len(wanted) - 1 <= asked <= len(wanted),  # a generator may ask once more at the end
        f"{student.said} asked the controller {asked} time{'s' * (asked != 1)} for "
        f"{len(wanted) - 1} step{'s' * (len(wanted) > 2)}, but it should be asked once in each "
        "step (a controller may remember what it has seen).",
    )


@recording.check(11)
def states_of_an_episode(student: Student):
    for index, steps in ((3, 1), (4, 12), (5, 60)):
        compare_recording(student, index, steps)
    compare_recording(student, 6, 5, seed=0)


@recording.check(4)
def ends_with_the_episode(student: Student):
    compare_recording(student, 6, 200)
    compare_recording(student, 7, 230)
    compare_recording(student, 8, 203)


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
        mistakes = {
            "The last columns hold where the arrows end, but should hold the changes.": np.hstack(
                [before, after]
            ),
            "The arrows go backwards: the changes should be after minus before.": np.hstack(
                [before, -change]
            ),
        }
        gap = (after - before)[:, 0]
        turns = {
            "A change of the angle beyond -pi or pi becomes 2 pi minus its amount, but for one "
            "above pi the short way around is negative.": (
                np.where(np.abs(gap) > np.pi, 2 * np.pi - np.abs(gap), gap)
            ),
            "A change of the angle beyond -pi or pi becomes its amount minus 2 pi, but for one "
            "below -pi the short way around is positive.": (
                np.where(np.abs(gap) > np.pi, np.abs(gap) - 2 * np.pi, gap)
            ),
            "The changes of the angle lie between 0 and 2 pi, but should lie between -pi and "
            "pi.": gap % (2 * np.pi),
            "Some changes of the angle are off by whole turns of 2 pi: take the short way.": gap,
            "The changes of the angle lie between -pi / 2 and pi / 2, as if a whole turn were pi, "
            "but a whole turn is 2 pi.": ((gap + np.pi / 2) % np.pi - np.pi / 2),
            "Changes of the angle beyond -pi and pi are cut off there, but the short way around is "
            "asked for.": (gap.clip(-np.pi, np.pi)),
            "The changes of the angle are never negative, but some should be.": np.abs(
                change[:, 0]
            ),
            "Changes of the angle below -pi stay as they are (as with np.fmod, unlike %), but "
            "should take the short way around, as those above pi do.": np.where(
                gap > np.pi, change[:, 0], gap
            ),
            "Changes of the angle above pi stay as they are, but should take the short way around, "
            "as those below -pi do.": np.where(gap < -np.pi, change[:, 0], gap),
        }
        mistakes |= {
            text: np.hstack([before, made[:, None], change[:, 1:]]) for text, made in turns.items()
        }
        raise Mismatch(
            f"arrows(before, after): from state {show(before[i])} to {show(after[i])} the arrow is "
            f"{show(answer[i])}, but should be {show(expected[i])}.", answer, expected, mistakes,
        )  # fmt: skip


@changes.check(6)
def starts_and_changes(student: Student):
    rng = np.random.default_rng(exercise.seed(8))
    for n in (1, 5, 40):
        compare_arrows(student, random_states(9, n, 2.5), rng.uniform(-0.5, 0.5, (n, 2)))


@changes.check(6)
def short_way_around(student: Student):
    rng = np.random.default_rng(exercise.seed(10))
    before = random_states(11, 60)
    change = np.stack([rng.uniform(-3.0, 3.0, 60), rng.uniform(-1, 1, 60)], axis=1)
    compare_arrows(student, before, change)
    before[:2, 0], change[:2, 0] = (3.1, -3.1), (0.1, -0.1)
    compare_arrows(student, before[:2], change[:2])
    change = np.stack([rng.uniform(-3.0, 3.0, 60), rng.uniform(-16, 16, 60)], axis=1)
    compare_arrows(student, random_states(29, 60), change)  # velocities do not wrap


def arrows_of(module, states):
    """The arrows of an episode, and whether its states are still as they were."""
    before = states.copy()
    arrows = module.arrows(states[:-1], states[1:])
    return [arrows, bool((states == before).all())]


@changes.check(1)
def states_stay_as_they_are(student: Student):
    states = random_states(27, 20, 2.5)
    answer = student.run(arrows_of, states, said="arrows(states[:-1], states[1:])")
    expect_array(student.said, answer[0], (19, 4))
    expect(
        answer[1] is True,
        f"{student.said} changed the states that it was given, but they should stay as they are.",
    )


# ------------------------------------------------------------------- 7.4
everywhere = exercise.task("7.4", "The whole state space", needs=("7.1",))


@everywhere.check(5)
def grid_of_states(student: Student):
    for nangles, nvelocities in ((3, 2), (7, 12), (20, 5)):
        angles, velocities = np.linspace(-np.pi, np.pi, nangles), np.linspace(-8, 8, nvelocities)
        expected = [[angle, velocity] for velocity in velocities for angle in angles]
        answer = student.call("grid", nangles, nvelocities)
        short = np.linspace(-np.pi, np.pi, nangles, endpoint=False)
        low = np.linspace(-8, 8, nvelocities, endpoint=False)
        turned = np.linspace(0, 2 * np.pi, nangles)
        mistakes = {
            text: [[angle, velocity] for velocity in some for angle in others]
            for text, others, some in (
                ("The grid leaves out its upper ends, but pi and 8 should be in it.", short, low),
                (
                    "The angles leave out their upper end, but should end with pi.",
                    short,
                    velocities,
                ),
                ("The velocities leave out their upper end, but should end with 8.", angles, low),
                ("The angles go from 0 to 2 pi, but should go from -pi to pi.", turned, velocities),
                (
                    "The angles go from -180 to 180 (degrees), but should go from -pi to pi.",
                    np.degrees(angles),
                    velocities,
                ),
            )
        }
        expect_close(student.said, answer, expected, 1e-6, mistakes)


def stepped(module, gains, states, strongest=2):
    import numpy

    gains = numpy.asarray(gains)

    def controller(seen):
        if numpy.shape(seen) != (3,):
            text = f"the controller was given {seen}, but should be given an array of shape (3,)"
            raise ValueError(text)
        return numpy.clip([gains @ seen], -strongest, strongest)

    return module.next_states(controller, states)


def seen_by(module, states):
    """What a controller without effect is given in each state but the first."""
    import numpy

    seen = []

    def controller(observation):
        seen.append(numpy.array(observation, dtype=float))
        return numpy.zeros(1)

    answer = module.next_states(controller, states)
    return [numpy.array(seen[1:]), answer]


def wrongly_seen(student: Student, states: np.ndarray) -> str:
    """What the controller is given if it is not the observation of the state; "" if it is."""
    try:
        seen, after = student.run(seen_by, states, said="next_states(controller, states)")
        seen = expect_array("observations", seen, (len(states) - 1, 3))
        after = expect_array("states", after, states.shape)
    except (Wrong, ValueError, TypeError):  # it is asked more or less often
        return ""
    wanted = observed(states)[1:]
    wrong = ~np.isclose(seen, wanted, atol=1e-4).all(axis=1)
    if not wrong.any():
        return ""
    i = int(wrong.argmax())
    text = f"For states[{i + 1}] the controller was given {show(seen[i])}"
    if np.allclose(seen, observed(after)[:-1], atol=1e-4):
        return (
            f"{text}. This is what the step before led to, but the observation that belongs to "
            "this state is asked for: compute it from angle and velocity."
        )
    return f"{text}, but should be given {show(wanted[i])}, the observation of this state."


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
    for index, n in ((13, 4), (14, 300), (18, 230)):
        gains = np.random.default_rng(exercise.seed(index)).uniform(-1, 1, 3)
        states = random_states(index + 2, n)
        said = f"next_states(controller, states), {n} states"
        answer = student.run(stepped, gains, states, said=said)
        try:
            expect_states(said, answer, one_step(gains, states))
        except Wrong as error:
            if why := wrongly_seen(student, states):
                raise Wrong(f"{error}\n  {why}") from error
            student.run(stepped, gains, states, said=said)  # for a second look at this call
            raise
    strong, states = np.array([3.0, 8.0, 2.0]), random_states(19, 20)
    said = "next_states(controller, states), a controller that asks for torques up to 25"
    answer = student.run(stepped, strong, states, 25, said=said)
    expect_states(said, answer, one_step(strong, states))


# ------------------------------------------------------------------- 7.5
stages = exercise.task("7.5", "Keeping stages of evolution")


def staged(module, prepared, target, generations, every, least):
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

    asked = []

    def evaluate(candidates, generation):
        asked.append(int(generation))
        return numpy.sin(3 * candidates - target).sum(axis=1) + 0.01 * generation + least

    return [module.evolve(Algorithm(), evaluate, generations, every), asked]


def stages_of(student: Student, index: int, generations: int, every: int, least: float = 0.0):
    """What the student's loop returns, and what it should; least: is added to every fitness."""
    rng = np.random.default_rng(exercise.seed(index))
    prepared, target = rng.normal(size=(generations + 2, 6, 4)), rng.normal(size=4)
    answer, asked = student.run(
        staged, prepared, target, generations, every, least,
        said=f"evolve(algorithm, evaluate, generations={generations}, every={every})",
    )  # fmt: skip
    expect(
        asked == list(range(generations)),
        f"{student.said} called evaluate for the generations {show(asked)}, but should call it "
        f"once for each generation, in order (the last one is number {generations - 1}).",
    )
    expect_fields(student.said, answer, "generations", "parameters", "history")

    def run(heard=lambda fitness: fitness):
        """Best candidates, fitness, numbers, and the last candidates; heard: what tell is given."""
        told, best, history, numbers = 0.0, [], [], []
        for generation in range(generations):
            candidates = prepared[generation] + told
            fitness = np.sin(3 * candidates - target).sum(axis=1) + 0.01 * generation + least
            best.append(candidates[fitness.argmax()])
            numbers.append(int(fitness.argmax()))
            history.append(fitness.max())
            told = told / 2 + 0.1 * float(np.dot(heard(fitness), np.arange(6)))
        return best, history, numbers, candidates

    best, history, numbers, candidates = run()
    record = [int(np.argmax(history[: generation + 1])) for generation in range(generations)]
    made = {
        "These are candidates of the last generation: the algorithm uses the same array each time, "
        "so keep a copy of a candidate (.copy()).":
        candidates[numbers],
        "Kept is the best candidate so far, but the best one of the generation alone is asked for.":
        np.array(best)[record],
    }  # fmt: skip
    others = {
        "The algorithm is told minus the fitness, but the fitness itself is asked for.": run(
            np.negative
        ),
        "The algorithm is told nothing (or only zeros), but should be told the fitness.": run(
            np.zeros_like
        ),
        "The algorithm is told the fitness in rising order, but in the order of the candidates is "
        "asked for.": run(np.sort),
    }
    made |= {text: np.array(other[0]) for text, other in others.items()}
    told = {text: other[1] for text, other in others.items()}
    told["This is the highest fitness so far, but that of the generation alone is asked for."] = (
        np.maximum.accumulate(history)
    )
    return answer, np.array(best), history, made, told


@stages.check(7)
def asks_evaluates_and_tells(student: Student):
    for index, generations in ((17, 1), (18, 15)):
        answer, _, history, _, told = stages_of(student, index, generations, 5)
        expect_close(f"{student.said}: history", answer["history"], history, 1e-6, told)


@stages.check(6)
def keeps_every_nth_and_the_last(student: Student):
    for index, generations, every in ((19, 15, 4), (20, 9, 4), (21, 6, 1), (22, 5, 10)):
        answer, *_ = stages_of(student, index, generations, every)
        expected = sorted({*range(0, generations, every), generations - 1})
        last = generations - 1
        mistakes = {
            "The generations kept are every - 1, 2 * every - 1, ... (counted from 1), but should "
            "be 0, every, 2 * every, ...": sorted(
                {*range(every - 1, generations, every), last}
            ),
            "The numbers of the generations are counted from 1, but should be counted from 0.": [
                each + 1 for each in expected
            ],
            "The last generation is listed twice where its number is a multiple of every, but once "
            "is asked for.": [
                *range(0, generations, every), last
            ],
            "The last generation is left out unless its number is a multiple of every, but should "
            "always be kept.": [*range(0, generations, every)],
            "Generation 0 is left out, but should be kept.": sorted(
                {*range(every, generations, every), last}
            ),
        }  # fmt: skip
        said = f"{student.said}: generations"
        expect_close(said, answer["generations"], expected, mistakes=mistakes)


@stages.check(6)
def keeps_the_best_as_they_were(student: Student):
    for index, generations, every, least in (
        (23, 13, 3, 0.0),
        (24, 16, 5, -50.0),
        (30, 9, 4, -50.0),
    ):
        answer, best, _, made, _ = stages_of(student, index, generations, every, least)
        kept = sorted({*range(0, generations, every), generations - 1})
        mistakes = {text: values[kept] for text, values in made.items()}
        said = f"{student.said}: parameters"
        expect_close(said, answer["parameters"], best[kept], 1e-6, mistakes)


# ------------------------------------------------------------------- 7.6
three = exercise.task("7.6", "Three stages", seconds=60, needs=("7.5",))


def evolved(module, ask, seed, size):
    """Three stages of a robot of the grader, whose parameters count with gains."""
    from botschool.grading.run.rewiring import asking

    with asking("Pendulum-v1", size, ask):
        return module.three_stages(seed)


EVOLVED: WeakKeyDictionary[Student, dict[tuple, tuple[np.ndarray, np.ndarray]]] = (
    WeakKeyDictionary()
)
"""What each student's evolutions have given; they take longer than all else in this exercise."""


def stages_for(student: Student, seed: int, gains: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The student's three stages, and the candidates of the first evaluations.

    The stages must be candidates that were evaluated. Asked again, the same are returned.
    """
    found = EVOLVED.setdefault(student, {})
    key = (seed, *gains)
    if key not in found:
        found[key] = evolve(student, seed, gains)
    student.said = f"three_stages(seed={seed})"
    return found[key]


def evolve(student: Student, seed: int, gains: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """As stages_for, but the student evolves them now."""
    said, robot = f"three_stages(seed={seed})", {"environment": "Pendulum-v1", "gains": gains}
    answer = student.run(evolved, seed, len(gains), said=said, robot=robot)
    parameters = expect_array(student.said, answer, (3, len(gains)))
    for name, row in zip(("first", "middle", "last"), parameters, strict=True):
        near = student.rewired.nearest(row)
        expect(
            near is not None and np.allclose(near, row, rtol=1e-5, atol=1e-5),
            f"{student.said}: the {name} stage was never evaluated. Return candidates of your "
            "evolution exactly as they were evaluated.",
        )
    early = student.rewired.first(100)
    begins = [np.isclose(early, row, rtol=1e-5, atol=1e-5).all(axis=1).any() for row in parameters]
    expect(
        bool(begins[0] or not begins[2]),
        f"{student.said}: the last stage is among the candidates that were evaluated first, and "
        "the first stage is not, but all should be in the order of the evolution.",
    )
    expect(
        bool(begins[0]),
        f"{student.said}: the first stage is not among the candidates that were evaluated first, "
        "but should be the best of generation 0 of the evolution that leads to the other stages.",
    )
    return parameters, early


def returns_of(student: Student, gains: np.ndarray, other: bool = False) -> np.ndarray:
    """Mean returns of the three stages over 100 episodes that the student's process never met.

    other: with another seed.
    """
    seed = exercise.seed(25 + 5 * other) % 100_000
    parameters, _ = stages_for(student, seed, gains)
    return Robot("Pendulum-v1").evaluate(parameters * gains, exercise.seed(26), episodes=100)


def secret_gains() -> np.ndarray:
    """Either sign, 0.8 to 1.25 times as much."""
    robot, rng = Robot("Pendulum-v1"), np.random.default_rng(exercise.seed(28))
    size = robot.nbiases + robot.nweights
    return rng.choice([-1.0, 1.0], size=size) * 1.25 ** rng.uniform(-1, 1, size)


def expect_stages(student: Student, fault, other: bool = False) -> None:
    """fault(returns) says what is wrong with them, or ""; other: with another seed.

    The stages are those of a robot whose parameters count with gains drawn in secret, which makes
    no difference to an evolution; the ordinary robot only tells which message is the right one.
    """
    gains = secret_gains()
    found = fault(returns_of(student, gains, other))
    if not found:
        return
    plain = fault(returns_of(student, np.ones(len(gains)), other))
    expect(not plain, f"{student.said}: {plain}")
    raise Wrong(
        f"{student.said} is right in this point for the ordinary robot, but not for one whose "
        f"parameters count with other signs and sizes: {found} For an evolution both robots are "
        "the same task. A possible cause is a stage that is right by luck (chosen by its number, "
        "or by few episodes), or an evolution that begins with parameters known before."
    )


@three.check(5)
def last_stage_holds_the_pendulum(student: Student):
    def fault(returns):
        told = f"the last stage reaches {returns[2]:.0f} on average over 100 new episodes, but at "
        told += "least -400 is asked for."
        if returns[2] < returns[0] - 100:
            told += f" That is worse than the first one, which reaches {returns[0]:.0f}."
        return "" if returns[2] >= -400 else told

    try:
        expect_stages(student, fault)
    except Wrong:  # one evolution in a hundred never gets there
        if fault(returns_of(student, secret_gains(), other=True)):
            raise


@three.check(3)
def seed_decides(student: Student):
    """The same seed gives the same in a fresh process; another seed gives no relatives."""
    gains, seed = secret_gains(), exercise.seed(25) % 100_000
    one, early = stages_for(student, seed, gains)
    student.stop()
    again, _ = evolve(student, seed, gains)
    expect(
        np.array_equal(one, again),
        f"{student.said} gave other stages when it was called again, but everything that is random "
        "should follow from the seed.",
    )
    other, others = stages_for(student, exercise.seed(30) % 100_000, gains)
    shared = (early[:, None] == others[None]).all(axis=2).any(axis=1).mean()
    expect(
        bool(shared < 0.1),
        f"{student.said} begins with the same candidates as with another seed ({shared:.0%} of the "
        "first ones are equal), but what the algorithm draws should follow from the seed.",
    )
    likeness = np.sum(one * other, axis=1) / np.sqrt(np.sum(one**2, 1) * np.sum(other**2, 1))
    expect(
        bool(likeness.max() < 0.8),
        f"{student.said} gave at least one stage with nearly the same parameters as another seed "
        f"(correlation {likeness.max():.2f}), but all should be evolved anew from each seed.",
    )


@three.check(5)
def stages_rise(student: Student):
    def fault(returns):
        first, middle, last = returns
        if first >= -900:
            return (
                f"the first stage reaches {first:.0f} on average over 100 new episodes, but the "
                "best of generation 0 should be below -900."
            )
        if not first + 100 <= middle <= last - 100:
            told = (
                f"the stages reach {first:.0f}, {middle:.0f} and {last:.0f} on average over 100 "
                "new episodes, but the middle one should be at least 100 above the first one and "
                "at least 100 below the last one"
            )
            if last - first < 200:
                return f"{told}. For that, the last one should be at least 200 above the first one."
            return f"{told}. Look for the one whose return is nearest to halfway between theirs."
        return ""

    for other in (True, False):
        expect_stages(student, fault, other)


# ------------------------------------------------------------------- 7.7
picture = exercise.task("7.7", "The picture", seconds=45)

LARGEST = 6000
KEPT = 10_000_000
VISIBLE = 0.01
"""From 0 to 1: a field may be drawn in a very light grey."""
TITLES = ("early", "middle", "late")
PLACES = ("left", "middle", "right")
CENTRE = np.array([[0.0, 0.0, 0.3, 0.8]])
STATES = ((-2.5, -6.0), (-1.0, -2.0), (2.0, 5.0))


def around(angle: float, velocity: float) -> np.ndarray:
    """A few arrows around a state, and the one in the centre."""
    offsets = np.array([(x, y) for x in (-0.3, 0.0, 0.3) for y in (-0.8, 0.0, 0.8)])
    starts = offsets + np.array([angle, velocity])
    return np.vstack([CENTRE, np.hstack([starts, np.tile([0.2, 0.5], (9, 1))])])


def drawn(module, file, titles, fields, paths):
    module.draw_portraits(file, titles, fields, paths)


DRAWN: WeakKeyDictionary[Student, dict[bytes, np.ndarray]] = WeakKeyDictionary()
"""Each student's pictures of one panel, unless they are large: two checks may need the same."""


def pixels_of(student: Student, fields: list, paths: list, titles=TITLES) -> np.ndarray:
    """The picture's pixels as numbers from 0 to 1, (height, width, 3)."""
    known = DRAWN.setdefault(student, {})
    key = b"path".join([fields[0].tobytes(), paths[0].tobytes()])
    if len(fields) > 1 or key not in known:
        pixels = newly_drawn(student, fields, paths, titles)
        if len(fields) > 1 or pixels.size > KEPT:
            return pixels
        known[key] = pixels
    return known[key]


def newly_drawn(student: Student, fields: list, paths: list, titles) -> np.ndarray:
    """As pixels_of, but the student draws the picture now."""
    from matplotlib.image import imread

    file = picture_file(student, fields, paths, titles[: len(fields)])
    try:
        pixels = imread(file)
    except Exception:
        raise Wrong(f"{student.said} wrote a PNG picture that cannot be read.") from None
    if pixels.ndim == 2:
        return np.repeat(pixels[..., None], 3, axis=2)
    opaque = pixels[..., 3:] if pixels.shape[2] == 4 else 1.0
    return pixels[..., :3] * opaque + 1.0 - opaque  # upon white


def picture_file(student: Student, fields: list, paths: list, titles) -> Path:
    """The file that the student draws, of a good size."""
    n = len(fields)
    most = max(LARGEST, 1000 * n)
    said = f"draw_portraits('portraits.png', ...), {n} panel{'s' if n > 1 else ''}"
    student.run(drawn, "portraits.png", list(titles), fields, paths, said=said)
    file = student.scratch("portraits.png")
    head = file.read_bytes()[:24]
    width, height = (int.from_bytes(head[at : at + 4], "big") for at in (16, 20))
    expect(head[:8] == b"\x89PNG\r\n\x1a\n", f"{said} wrote a file that is not a PNG picture.")
    size = f"{said} wrote a picture of {width} x {height} pixels"
    expect(max(width, height) <= most, f"{size}, which is too large to judge.")
    expect(
        width >= 300 * n and height >= 300,
        f"{size}, but at least {300 * n} x 300 are asked for: 300 for the width of each panel.",
    )
    return file


def difference(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """How much two pictures differ, (height, width)."""
    height, width = np.min([one.shape[:2], other.shape[:2]], axis=0)
    return np.abs(one[:height, :width] - other[:height, :width]).max(axis=2)


def differences(student: Student, drawings: list[tuple[list, list]]) -> np.ndarray:
    """How much each picture differs from what most of them share, (pictures, height, width)."""
    pictures = [pixels_of(student, *drawing) for drawing in drawings]
    height, width = np.min([each.shape[:2] for each in pictures], axis=0)
    pictures = np.array([each[:height, :width] for each in pictures])
    return np.abs(pictures - np.median(pictures, axis=0)).max(axis=3)


def places(student: Student, drawings: list[tuple[list, list]]) -> list[tuple[float, float]]:
    """Where the three pictures differ from what they share: (from left, from below), in 0..1."""
    found = []
    for different in differences(student, drawings):
        (height, width), (rows, columns) = different.shape, np.nonzero(different > VISIBLE)
        expect(
            len(rows) > 20,
            f"{student.said}: with other arrows the picture is nearly the same, so nearly nothing "
            "of them is seen. Perhaps they are not drawn, or lie outside of the axes.",
        )
        expect(
            len(rows) < 0.2 * height * width,
            f"{student.said}: a few other arrows change {len(rows) / (height * width):.0%} of the "
            "picture, but axes and panels should stay as they are, and each arrow should be as "
            "long as its change.",
        )
        found.append((float(np.median(columns)) / width, 1 - float(np.median(rows)) / height))
    return found


@picture.check(3)
def field_where_it_belongs(student: Student):
    drawings = [([around(*at)], [CENTRE]) for at in STATES]
    expect_fixed_axes(student, places(student, drawings))
    many = [CENTRE] * 7
    picture_file(student, many, many, [f"stage {i}" for i in range(7)])


@picture.check(3)
def path_where_it_belongs(student: Student):
    drawings = [([CENTRE], [around(*at)]) for at in STATES]
    expect_fixed_axes(student, places(student, drawings))


def expect_fixed_axes(student: Student, found: list[tuple[float, float]]) -> None:
    """Arrows around STATES were found where axes from -pi to pi and -8 to 8 put them."""
    states, places = np.array(STATES), np.array(found)
    for name, values, spots in zip(("angles", "velocities"), states.T, places.T, strict=True):
        why = (
            "Each panel should show -pi to pi and -8 to 8, whatever is drawn, and each arrow "
            "should begin in its state and end in the next one."
        )
        if spread(spots[::-1], values[::-1]):
            side = "upwards" if name == "velocities" else "from left to right"
            why = f"The {name} should grow {side}, but they grow the other way."
        expect(
            spread(spots, values),
            f"{student.said}: arrows at the {name} {', '.join(map(str, values))} were found at "
            f"{', '.join(f'{100 * x:.0f} %' for x in spots)} of the picture, counted from "
            f"{'the left' if name == 'angles' else 'below'}. {why}",
        )


def spread(spots: np.ndarray, values: np.ndarray) -> bool:
    """Whether three spots of a picture lie as three values do, from the first to the last."""
    middle, span = spots[1] - spots[0], spots[2] - spots[0]
    share = (values[1] - values[0]) / (values[2] - values[0])
    return bool(span > 0.3 and abs(middle / span - share) < 0.06)


@picture.check(3)
def one_panel_for_each(student: Student):
    three = [CENTRE] * 3
    plain = pixels_of(student, three, three)
    states = [state[1] for state in STATES]
    alone = [CENTRE, around(*STATES[1]), CENTRE]
    for what in ("paths", "fields"):
        arrows = [around(*at) for at in STATES]
        drawing = (three, arrows) if what == "paths" else (arrows, three)
        different = difference(pixels_of(student, *drawing), plain)
        found = []
        for k, third in enumerate(np.array_split(different, 3, axis=1)):
            rows, _ = np.nonzero(third > VISIBLE)
            expect(
                len(rows) > 20,
                f"{student.said}: with other arrows in {what}[{k}], the {PLACES[k]} third of the "
                "picture is nearly the same, so nearly nothing of them is seen there.",
            )
            low, middle, high = np.percentile(rows, [5, 50, 95]) / len(third)
            if high - low >= 0.25:
                drawing = (three, alone) if what == "paths" else (alone, three)
                one = np.array_split(difference(pixels_of(student, *drawing), plain), 3, axis=1)
                layout = panels_otherwise(student, what, plain)
                why = (
                    "Each arrow should be as long as its change, in axes from -pi to pi and from "
                    "-8 to 8."
                )
                if (one[0] > VISIBLE).any() or (one[2] > VISIBLE).any():
                    why = (
                        f"Panel i should show {what}[i] and no other, and its axes should go from "
                        "-pi to pi and from -8 to 8, whatever is drawn."
                    )
                raise Wrong(
                    f"{student.said}: a few other arrows in {what}[{k}], all near the velocity "
                    f"{states[k]:g}, should change little of the {PLACES[k]} third of the picture, "
                    f"but the changes cover {100 * (high - low):.0f} % of its height. "
                    f"{layout or why}"
                )
            found.append(float(1 - middle))
        why = f"Panel i should show {what}[i]."
        if spread(np.array(found)[::-1], states[::-1]):
            why = "The velocities should grow upwards, but they grow the other way."
        elif found[0] < found[1] < found[2]:  # in the right order, at wrong distances
            why = "Each panel should show -8 to 8, and each arrow should end in the next state."
        expect(
            spread(found, states),
            f"{student.said}: {what}[0], {what}[1] and {what}[2] with arrows at the velocities "
            f"{', '.join(map(str, states))} should be in the left, the middle and the right third "
            f"of the picture, at these velocities, but the arrows there are at "
            f"{', '.join(map('{:.0%}'.format, found))} of the height, counted from below. {why}",
        )
    limits_stay(student)
    titles_stand_above(student, plain)
    path_lies_above(student)


def panels_otherwise(student: Student, what: str, plain: np.ndarray) -> str:
    """How panels lie that do not lie side by side, or "": the same arrows in the first and last."""
    found = []
    for k in (0, 2):
        arrows = [around(*STATES[0]) if i == k else CENTRE for i in range(3)]
        drawing = ([CENTRE] * 3, arrows) if what == "paths" else (arrows, [CENTRE] * 3)
        rows, columns = np.nonzero(difference(pixels_of(student, *drawing), plain) > VISIBLE)
        if len(rows) <= 20 or np.ptp(columns) > 0.4 * plain.shape[1]:
            return ""
        found.append((np.median(columns) / plain.shape[1], np.median(rows) / plain.shape[0]))
    (x, y), (other_x, other_y) = found
    if abs(x - other_x) > 0.05:
        return ""
    if abs(y - other_y) > 0.4:
        return "The panels stand one below the other, but should stand side by side in one row."
    same = abs(y - other_y) < 0.05
    return f"{what}[0] and {what}[2] are drawn at one place, not in two panels." if same else ""


def limits_stay(student: Student) -> None:
    """Arrows near the edges leave what is drawn elsewhere as it is, in each panel."""
    here = around(*STATES[0])
    starts = [[-3.1, 7.9], [3.1, 7.9], [1.5, -7.9]]
    edges = np.vstack([here, [[x, y, -0.05 * x, -0.05 * y] for x, y in starts]])
    three = [CENTRE] * 3
    pictures = [pixels_of(student, three, [path] * 3) for path in (here, edges)]
    for k, third in enumerate(np.array_split(difference(*pictures), 3, axis=1)):
        height, width = third.shape
        quarter = third[height // 2 :, : width // 2]
        expect(
            np.sum(quarter > VISIBLE) <= 20,
            f"{student.said}: in the {PLACES[k]} panel, the lower left quarter changes when arrows "
            "at other edges are added (angles -3.1 and 3.1, velocities -7.9 and 7.9), but each "
            "panel should show exactly -pi to pi and -8 to 8, whatever is drawn.",
        )


def titles_stand_above(student: Student, plain: np.ndarray) -> None:
    """Another titles[k] changes the picture in its k-th third alone."""
    three = [CENTRE] * 3
    for changed in ((0, 1), (1, 2)):
        titles = [title.upper() if k in changed else title for k, title in enumerate(TITLES)]
        different = difference(pixels_of(student, three, three, titles), plain)
        for k, third in enumerate(np.array_split(different, 3, axis=1)):
            expect(
                bool((third > VISIBLE).any()) == (k in changed),
                f"{student.said}: with titles = {titles} in place of {list(TITLES)}, panel {k} "
                f"looks {'the same' if k in changed else 'different'}, but titles[i] should stand "
                "above panel i.",
            )


def path_lies_above(student: Student) -> None:
    """Where both are drawn, the picture of both is that of the path."""
    here = around(*STATES[1])
    pairs = (([here], [here]), ([CENTRE], [here]), ([here], [CENTRE]), ([CENTRE], [CENTRE]))
    pictures = [pixels_of(student, *pair) for pair in pairs]
    height, width = np.min([each.shape[:2] for each in pictures], axis=0)
    both, path, field, none = (each[:height, :width] for each in pictures)
    shared = (np.abs(path - none).max(axis=2) > 0.1) & (np.abs(field - none).max(axis=2) > 0.05)
    expect(
        bool(np.abs(both - path)[shared].sum() <= np.abs(both - field)[shared].sum()),
        f"{student.said}: where an arrow of a path and one of the field lie upon each other, the "
        "field covers the path, but the path should lie above the field.",
    )


ARROWS = np.array(
    [
        [-2.6, -6.0, 1.2, 2.5],
        [-0.4, 5.5, -1.8, -3.0],
        [2.6, -1.5, -1.5, -4.5],
    ]
)
"""In different quarters of the state space, in different directions."""


LIMITS = np.array([np.pi, 8.0])


def fitted(extent: np.ndarray, begins: np.ndarray, ends: np.ndarray) -> list[np.ndarray]:
    """For x and y: the line that leads from states to pixels if arrows are drawn so.

    extent: the smallest and the largest x and y of each arrow's pixels.
    """
    wanted = np.stack([np.minimum(begins, ends), np.maximum(begins, ends)], axis=1)
    return [np.polyfit(wanted[..., i].ravel(), extent[..., i].ravel(), 1) for i in (0, 1)]


def misfits(extent: np.ndarray, begins: np.ndarray, ends: np.ndarray, sizes) -> list[float]:
    """For x and y: how far, as a share of the picture, the arrows are from being drawn so."""
    wanted = np.stack([np.minimum(begins, ends), np.maximum(begins, ends)], axis=1)
    found = []
    for i, (line, size) in enumerate(zip(fitted(extent, begins, ends), sizes, strict=True)):
        off = np.abs(np.polyval(line, wanted[..., i]) - extent[..., i]).max() / size
        found.append(float(off) if line[0] > 0 else np.inf)
    return found


def within_axes(begins: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The parts of arrows that axes from -pi to pi and -8 to 8 show."""
    way = ends - begins
    with np.errstate(divide="ignore"):
        sides = np.stack([(-LIMITS - begins) / way, (LIMITS - begins) / way])
    first = sides.min(axis=0).max(axis=1).clip(0, 1)[:, None]
    last = sides.max(axis=0).min(axis=1).clip(0, 1)[:, None]
    return begins + first * way, begins + last * way


def drawn_otherwise(extent: np.ndarray, sizes) -> str:
    """How arrows are drawn that do not go to the next state, or ""."""
    states, changes = ARROWS[:, :2], ARROWS[:, 2:]
    ways = {
        "They are as long as the numbers of the next state, but should be as long as the change.": (
            states, 2 * states + changes
        ),
        "They end at the change, as if that were a state, but should end in the next state.": (
            states, changes
        ),
        "They end in their state, but should begin there.": (states - changes, states),
        "Their middle is in their state, but they should begin there.": (
            states - changes / 2, states + changes / 2
        ),
        "They point the other way, but the changes should be added to the states.": (
            states, states - changes
        ),
    }  # fmt: skip
    for factor in (0.1, 0.2, 0.5, 2, 5, 10):
        text = (
            f"They are {factor:g} times as long as their change, but should end in the next state."
        )
        ways[text] = (states, states + factor * changes)
    off = {text: max(misfits(extent, *within_axes(*ends), sizes)) for text, ends in ways.items()}
    exchanged = (states[:, ::-1], (states + changes)[:, ::-1])
    off["Angles and velocities are exchanged, but the angles should grow from left to right."] = (
        max(misfits(extent, *exchanged, sizes))
    )
    directions = changes / np.hypot(*changes.T)[:, None]
    off["All are equally long, but each should be as long as its change."] = min(
        max(misfits(extent, *within_axes(states, states + length * directions), sizes))
        for length in (0.2, 0.5, 1, 2)
    )
    best = min(off, key=lambda text: off[text])
    return f"\n  {best}" if off[best] < 0.05 else ""


def drawn_arrows(different: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """(points, weights) of what each picture shows alone; x and y in pixels, y upwards."""
    found = []
    for each in different:
        rows, columns = np.nonzero(each > VISIBLE)
        points = np.stack([columns, each.shape[0] - rows], axis=1).astype(float)
        found.append((points, each[rows, columns]))
    return found


def heads_and_tails(points, weights, begin, end) -> tuple[float, float]:
    """How wide an arrow is near its end, and near its beginning: second moments across."""
    length = float(np.linalg.norm(end - begin))
    along = (points - begin) @ (end - begin) / length
    across = (points - begin) @ np.array([-(end - begin)[1], (end - begin)[0]]) / length
    zone = max(8.0, 0.12 * length)
    width = weights * across**2
    return float(width[along > length - zone].sum()), float(width[along < zone].sum())


@picture.check(3)
def arrows_point_to_the_next_state(student: Student):
    for what in ("field", "path"):
        drawings = [([arrow[None]], [CENTRE]) for arrow in ARROWS]
        drawings = drawings if what == "field" else [pair[::-1] for pair in drawings]
        different = differences(student, drawings)
        shape, found = different.shape[1:], drawn_arrows(different)
        expect(
            all(len(points) > 5 for points, _ in found),
            f"{student.said}: at least one arrow of a {what} is hardly seen. Perhaps it is not "
            "drawn, or lies outside of the axes.",
        )
        begins, ends = ARROWS[:, :2], ARROWS[:, :2] + ARROWS[:, 2:]
        extent = np.array([[points.min(axis=0), points.max(axis=0)] for points, _ in found])
        off = max(misfits(extent, begins, ends, shape[::-1]))
        if off >= 0.05:
            far = f"up to {100 * off:.0f} % of the picture away" if off < 1 else "elsewhere"
            raise Wrong(
                f"{student.said}: in axes from -pi to pi and -8 to 8, the arrows of a {what} "
                f"should go from their state to the next one, but they begin or end {far}."
                f"{drawn_otherwise(extent, shape[::-1])}"
            )
        scales = fitted(extent, begins, ends)
        places = [
            np.stack(
                [np.polyval(scale, side[:, axis]) for axis, scale in enumerate(scales)], axis=1
            )
            for side in (begins, ends)
        ]
        widths = [
            heads_and_tails(*drawn, *ab)
            for drawn, ab in zip(found, zip(*places, strict=True), strict=True)
        ]
        at_head, at_tail = np.sum(widths, axis=0)
        expect(
            at_head > 1.15 * at_tail,
            f"{student.said}: the arrows of a {what} should have heads at the next state, "
            "but they are not wider there than at their own state.",
        )
    axes_end_exactly(student)


def axes_end_exactly(student: Student) -> None:
    """Arrows just inside of the axes' limits are seen, those just outside are not."""
    plain = pixels_of(student, [CENTRE], [CENTRE])

    def is_seen(*states: tuple[float, float]) -> bool:
        arrows = [[*state, 0.04, 0.2] for state in states]
        picture = pixels_of(student, [CENTRE], [np.vstack([CENTRE, arrows])])
        return picture.shape != plain.shape or np.abs(picture - plain).max() > VISIBLE

    inside, outside = ((3.02, 1.0), (1.0, 7.6)), ((3.3, 1.0), (-3.34, 1.0), (1.0, 8.5), (1.0, -8.7))
    wrong = [state for state in inside if not is_seen(state)]
    if not wrong and is_seen(*outside):
        wrong = [state for state in outside if is_seen(state)]
    expect(
        not wrong or is_seen((1.0, 1.0)),
        f"{student.said}: of a path of two arrows only the first one is seen, but both lie within "
        "the axes and should be seen.",
    )
    for angle, velocity in wrong[:1]:
        raise Wrong(
            f"{student.said}: an arrow at angle {angle:g} and velocity {velocity:g} is "
            f"{'not ' if (angle, velocity) in inside else ''}seen, but each panel should show "
            "exactly -pi to pi and -8 to 8."
        )
