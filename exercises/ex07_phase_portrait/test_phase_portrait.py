"""Grader of exercise 7; run it with `botschool grade 7`.

Tasks 7.1 to 7.5 compare with our solution. Task 7.6 evolves a robot whose parameters count with
gains drawn in secret. Task 7.7 finds out from the pixels where arrows are drawn.

Stochastic check (task 7.6; 100 unseen episodes): the first stage below -900, the last at least
-400, the middle one 100 away from both. Over 20 seeds, each with gains of its own, the solution's
first stages reach -1273 to -1138, the middle ones -739 to -638 (margin 421), the last ones -191 to
-139. Of 300 others, 3 ended below -400: so one of two seeds is enough.
"""

import numpy as np
from PIL import Image

from botschool.grading import Exercise, Student, Wrong, expect, expect_array, same, seed_of
from botschool.grading.run.rewiring import Disguised

PENDULUM = "gymnasium.envs.classic_control.pendulum"
exercise = Exercise(7, "Phase portrait", file="phase_portrait.py", imports=(PENDULUM,))


def states_in(rng, n, largest=np.pi):
    """Angles and velocities from all over the state space."""
    return np.stack([rng.uniform(-largest, largest, n), rng.uniform(-8, 8, n)], axis=1)


def parts_of(answer, *_):
    """States whose angles may be at either end, as -pi is the same place as pi."""
    states = expect_array("the answer", answer, (len(np.atleast_1d(answer)), 2))
    angles, velocities = states.T
    return {
        "the number of states": len(states),
        "the number of angles beyond -pi or pi": int((np.abs(angles) > np.pi + 1e-6).sum()),
        "each angle's cosine": np.cos(angles),
        "each angle's sine": np.sin(angles),
        "each velocity": velocities,
    }


state = exercise.task("7.1", "From observation to state")


def observed(states):
    return np.stack([np.cos(states[:, 0]), np.sin(states[:, 0]), states[:, 1]], axis=1)


def at_one_end(answer, observation):
    """The answer with pi in place of -pi."""
    states = np.array(answer, dtype=float)
    states[..., 0] += 2 * np.pi * (np.abs(states[..., 0] + np.pi) < 1e-6)
    return states


@same(state, 6, "to_state", 1e-5, view=at_one_end)
def one_observation(rng):
    yield from observed(np.array([[0.5, 1.0], [-2.5, -3.0], *states_in(rng, 4)]))
    yield from np.array([[-1.0, 0.0, 2.0], [-1.0, 0.0, -3.5], [0.0, -1.0, 2.0]])


@same(state, 4, "to_state", 1e-5, view=at_one_end)
def many_observations(rng):
    yield from (observed(states_in(rng, n)) for n in (1, 3, 3, 50))


recording = exercise.task("7.2", "Recording an episode", needs=("7.1",))


def recorded(module, gains, seed, steps):
    """record(controller, seed={1}, steps={2})"""
    import numpy

    asked = []

    def controller(seen):
        assert numpy.shape(seen) == (3,), f"the controller was given {seen}, not shape (3,)"
        asked.append(1)
        return numpy.clip([gains @ seen], -2, 2)

    return [module.record(controller, seed, steps), len(asked)]


def recording_of(answer, gains, seed, steps):
    states, asked = answer
    asked -= asked == min(steps, 200) + 1  # a generator may ask once more at the end
    return parts_of(states) | {"the number of times that the controller was asked": asked}


@same(recording, 11, recorded, 1e-3, view=recording_of)
def states_of_an_episode(rng):
    """Torques may be in single precision, too. Seed 0 is one like any other."""
    for steps, seed in ((12, seed_of(rng)), (1, seed_of(rng)), (60, seed_of(rng)), (5, 0), (20, 0)):
        yield rng.uniform(-1.5, 1.5, 3), seed, steps


@same(recording, 4, recorded, 1e-3, view=recording_of)
def ends_with_the_episode(rng):
    for steps in (200, 203, 230):
        yield rng.uniform(-1.5, 1.5, 3), seed_of(rng), steps


changes = exercise.task("7.3", "Arrows")
COLUMNS = dict.fromkeys(("square", "one"), "a state has two numbers")


NEAR = COLUMNS | {"changes": "states of two draws may be half a turn apart: the next check's"}


@same(changes, 7, "arrows", 1e-6, off=NEAR)
def starts_and_changes(rng):
    for n in (1, 2, 5, 40):
        before = states_in(rng, n, 2.5)
        yield before, before + rng.uniform(-0.5, 0.5, (n, 2))


@same(changes, 6, "arrows", 1e-6, off=COLUMNS)
def short_way_around(rng):
    """Velocities do not wrap, however much they change."""
    yield np.array([[3.1, 2.0], [-3.1, -2.0]]), np.array([[-3.1, 1.5], [3.1, 2.5]])
    yield from ((states_in(rng, n), states_in(rng, n)) for n in (3, 10, 60))


everywhere = exercise.task("7.4", "The whole state space", needs=("7.1",))


@same(everywhere, 5, "grid", 1e-6)
def grid_of_states(rng):
    yield 3, 2
    for low, high in (((2, 5), (5, 21)), ((5, 2), (21, 5))):
        yield from map(tuple, rng.integers(low, high, (2, 2)).tolist())


def stepped(module, gains, states, strongest):
    """next_states(controller, {1}), with torques from -{2} to {2}"""
    import numpy

    def controller(seen):
        assert numpy.shape(seen) == (3,), f"the controller was given {seen}, not shape (3,)"
        return numpy.clip([gains @ seen], -strongest, strongest)

    return module.next_states(controller, states)


@same(everywhere, 5, stepped, 1e-5, view=parts_of)
def pendulum_without_motor(rng):
    yield from ((np.zeros(3), states_in(rng, n), 2) for n in (3, 30))


@same(everywhere, 8, stepped, 1e-5, view=parts_of)
def pendulum_with_controller(rng):
    """In more states than an episode has steps; with torques that the motor limits."""
    for n in (4, 230, 300):
        yield rng.uniform(-1, 1, 3), states_in(rng, n), 2
    for n in (10, 20):
        yield np.array([3.0, 8.0, 2.0]), states_in(rng, n), 25


stages = exercise.task("7.5", "Keeping stages of evolution")


def staged(module, prepared, target, generations, every, least):
    """evolve(algorithm, evaluate, generations={2}, every={3})"""
    import numpy

    class Algorithm:
        asked, told, candidates = 0, 0.0, prepared[0].copy()

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

    result = module.evolve(Algorithm(), evaluate, generations, every)
    return {"the generations of evaluate": asked} | result


def run(rng, generations, every, least=0.0):
    """least: what is added to every fitness."""
    prepared, target = rng.normal(size=(generations + 2, 6, 4)), rng.normal(size=4)
    return prepared, target, generations, every, least


@same(stages, 7, staged, 1e-6, parts=("the generations of evaluate", "history"))
def asks_evaluates_and_tells(rng):
    for generations in (3, 1, 15):
        yield run(rng, generations, 5)


@same(stages, 6, staged, parts=("the generations of evaluate", "generations"))
def keeps_every_nth_and_the_last(rng):
    for generations, every in ((5, 3), (15, 4), (9, 4), (6, 1), (5, 10)):
        yield run(rng, generations, every)


@same(stages, 6, staged, 1e-6, parts=("the generations of evaluate", "parameters"))
def keeps_the_best_as_they_were(rng):
    for generations, every, least in ((13, 3, 0.0), (16, 5, -50.0), (9, 4, -50.0)):
        yield run(rng, generations, every, least)


three = exercise.task("7.6", "Three stages", seconds=60, needs=("7.5",))
SEEDS = (25, 30)
NEW = "on average in 100 new episodes (the robot's parameters count with other signs and sizes)"


@exercise.cached
def stages_for(student: Student, index: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The student's stages, what they reach in new episodes, and the first candidates."""
    robot, seed = Disguised("Pendulum-v1", exercise.seed(28)), exercise.seed(index) % 100_000
    said = f"three_stages(seed={seed})"
    stages = robot.trained(student, "three_stages", seed, said=said, rows=(3,))
    early = student.rewired.first(100)
    begins = bool(np.isclose(early, stages[0], rtol=1e-5, atol=1e-5).all(axis=1).any())
    expect(begins, f"{said}: the first stage should be among the candidates evaluated first.")
    return stages, robot.means(stages, exercise.seed(26), 100), early


@three.check(5)
def last_stage_holds_the_pendulum(student: Student):
    most = max(stages_for(student, index)[1][2] for index in SEEDS)
    expect(most >= -400, f"three_stages: the last stage should reach -400 {NEW}, not {most:.0f}.")


@three.check(3)
def seed_decides(student: Student):
    """The same seed gives the same in a new process; another seed gives no relatives."""
    (one, _, early), (other, _, others) = (stages_for(student, index) for index in SEEDS)
    said = "three_stages with another seed"
    shared = (early[:, None] == others[None]).all(axis=2).any(axis=1).mean()
    expect(bool(shared < 0.1), f"{said} should begin with other candidates, but begins the same.")
    likeness = np.sum(one * other, axis=1) / np.sqrt(np.sum(one**2, 1) * np.sum(other**2, 1))
    expect(bool(likeness.max() < 0.8), f"{said} should give other stages, but one is nearly equal.")
    student.stop()
    same_again = np.array_equal(one, stages_for.__wrapped__(student, SEEDS[0])[0])
    expect(same_again, f"{student.said} gives other stages when it is called again.")


@three.check(5)
def stages_rise(student: Student):
    for index in SEEDS:
        first, middle, last = stages_for(student, index)[1]
        said = f"three_stages: its stages reach {first:.0f}, {middle:.0f} and {last:.0f} {NEW}, but"
        said += " the first one should be below -900, the middle one 100 away from both others."
        expect(first < -900 and first + 100 <= middle <= last - 100, said)


picture = exercise.task("7.7", "The picture", seconds=45)
TITLES = ("early", "middle", "late")
VISIBLE = 2  # of 255: a field may be drawn in a very light grey
CENTRE, CORNER = np.array([[0.0, 0.0, 0.3, 0.8]]), np.array([3.02, 7.6])
INSIDE = np.array([[*-CORNER, 0.01, 0.03], [*CORNER, -0.01, -0.03]])
OUTSIDE = np.array([[x, y, 0.04, 0.2] for x, y in ((3.3, 1), (-3.36, 1), (1, 8.5), (1, -8.7))])
ARROWS = np.array([[-2.6, -6.0, 1.2, 2.5], [-0.4, 5.5, -1.8, -3.0], [2.6, -1.5, -1.5, -4.5]])


def drawn(module, file, titles, fields, paths):
    module.draw_portraits(file, titles, fields, paths)


def pixels_of(student: Student, fields: list, paths: list, titles=TITLES) -> np.ndarray:
    """The picture that the student draws, of shape (height, width, 3), upon white."""
    n, name = len(titles), f"portraits_{len(titles)}.png"
    said = f"draw_portraits({name!r}, ...), {n} panel{'s' * (n > 1)}"
    student.run(drawn, name, list(titles), fields, paths, said=said)
    try:
        image = Image.open(student.scratch(name), formats=["PNG"])
        (width, height), most = image.size, max(6000, 1000 * n)
        size = f"{said}: the picture has {width} x {height} pixels, but needs at least {300 * n} x"
        large = 300 * n <= width <= most and 300 <= height <= most
        expect(large, f"{size} 300, and at most {most} x {most}.")
        white = Image.new("RGBA", image.size, "white")
        return np.asarray(Image.alpha_composite(white, image.convert("RGBA")))[..., :3]
    except (OSError, ValueError, SyntaxError, EOFError):
        raise Wrong(f"{said}: this writes no PNG picture that can be read.") from None


def difference(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """How much two pictures differ, (height, width)."""
    height, width = np.min([one.shape[:2], other.shape[:2]], axis=0)
    one, other = (each[:height, :width].astype(np.int16) for each in (one, other))
    return np.abs(one - other).max(axis=2)


def seen(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Where two pictures differ: rows of x and y in pixels, y upwards."""
    rows, columns = np.nonzero(difference(one, other) > VISIBLE)
    return np.stack([columns, -rows], axis=1).astype(float)


@exercise.cached
def panels(student: Student) -> tuple[np.ndarray, list[np.ndarray]]:
    """The picture with CENTRE alone, and where -CORNER and CORNER of each panel are."""
    plain, corners = pixels_of(student, [CENTRE] * 3, [CENTRE] * 3), []
    for i in range(3):
        arrows = [np.vstack([CENTRE, INSIDE]) if k == i else CENTRE for k in range(3)]
        points = seen(pixels_of(student, arrows, arrows), plain)
        corners.append([points.min(0), points.max(0)] if len(points) else np.zeros((2, 2)))
    low, high = np.swapaxes(corners, 0, 1)
    in_a_row = (low[1:, 0] > high[:-1, 0]).all() and np.ptp(low[:, 1]) < 9
    said = f"{student.said}: short arrows at [-3.02, -7.6] and [3.02, 7.6] of fields[i] and"
    said += " paths[i] should be seen near two corners of panel i, which shows exactly -pi to pi"
    said += " and -8 to 8, whatever is drawn. Panels stand side by side."
    expect(bool(in_a_row and (high - low).min() > 100), said)
    return plain, corners


@exercise.cached
def with_arrows(student: Student, what: str) -> np.ndarray:
    """The picture with one of ARROWS in each panel; what: "fields", "paths", or both names."""
    arrows, none = [np.vstack([CENTRE, each]) for each in ARROWS], [CENTRE] * 3
    return pixels_of(student, *(arrows if each in what else none for each in ("fields", "paths")))


def expect_drawn(student: Student, what: str) -> None:
    """Arrows go from their states to the next ones, with their heads there."""
    (plain, corners), widths = panels(student), []
    every = seen(with_arrows(student, what), plain)
    for i, (low, high) in enumerate(corners):
        start, change = ARROWS[i].reshape(2, 2)
        points = every[((every >= low) & (every <= high)).all(axis=1)]
        said = f"{student.said}: the arrow of {what}[{i}] from {start} to {start + change}"
        expect(len(points) > 5, f"{said} is hardly seen in panel {i}.")
        scale = (high - low) / (2 * CORNER)
        states = (points - low) / scale - CORNER
        wanted, found = np.sort([start, start + change], axis=0), [states.min(0), states.max(0)]
        right = bool((np.abs(found - wanted) < [0.4, 1]).all())
        (a, b), (c, d) = (np.round(each, 1).tolist() for each in (wanted, found))
        expect(right, f"{said} should cover {a} to {b} (angle, velocity), but covers {c} to {d}.")
        way = (states - start) * scale @ [1, 1j] / complex(*change * scale)  # it goes from 0 to 1
        widths.append([(way.imag[at] ** 2).sum() for at in (way.real < 0.12, way.real > 0.88)])
    tail, head = np.sum(widths, axis=0)
    expect(head > 1.15 * tail, f"{student.said}: {what} should have heads at the next state only.")


@picture.check(3)
def field_where_it_belongs(student: Student):
    expect_drawn(student, "fields")


@picture.check(3)
def path_where_it_belongs(student: Student):
    expect_drawn(student, "paths")


@picture.check(3)
def one_panel_for_each(student: Student):
    """Of 1, 3 and 7; titles[i] stands above panel i, and the path above the field."""
    for n in (1, 7):
        pixels_of(student, [CENTRE] * n, [CENTRE] * n, [f"stage {i}" for i in range(n)])
    plain, corners = panels(student)
    middles = np.mean(corners, axis=1)[:, 0]
    for changed in ([0, 1], [1, 2]):
        titles = [title.upper() if i in changed else title for i, title in enumerate(TITLES)]
        points = seen(pixels_of(student, [CENTRE] * 3, [CENTRE] * 3, titles), plain)
        found = sorted({int(np.abs(middles - x).argmin()) for x in points[:, 0]})
        said = f"{student.said}: with titles = {titles} in place of {list(TITLES)}, the panels"
        expect(found == changed, f"{said} {found} change, but titles[i] belongs to panel i.")
    field, path, both = (with_arrows(student, e) for e in ("fields", "paths", "fields and paths"))
    shared = (difference(path, plain) > 25) & (difference(field, plain) > 12)
    off = [difference(both, each)[shared].sum() for each in (path, field)]
    expect(off[0] <= off[1], f"{student.said}: the field covers the path, which should lie above.")


@picture.check(3)
def axes_end_exactly(student: Student):
    """What lies just outside of the axes changes nothing."""
    arrows = [np.vstack([CENTRE, OUTSIDE])] * 3
    points = seen(pixels_of(student, arrows, arrows), panels(student)[0])
    said = f"{student.said}: arrows at the angles 3.3 and -3.36 and the velocities 8.5 and -8.7"
    expect(not len(points), f"{said} are seen, but panels end at -pi, pi, -8 and 8.")
