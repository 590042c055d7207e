"""Ways to spoil a finished laboratory, for tests: each changes the files of a place.

Each gives what is left of the points, and a part of what the check says. Forgers know our code:
they give a borrowed robot the fitness that it gets under their own seeds.
"""

import json
import re
import shutil
from dataclasses import replace

import numpy as np

from botschool.errors import BotschoolError
from botschool.evolution.algorithms.sides import everyone, mean
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.record import RunFiles
from botschool.labs.check import Check
from botschool.labs.declare import PARTS
from botschool.labs.evolving import evaluator_of
from botschool.labs.runs import ABOUT, make_runs, own_runs
from botschool.labs.sheet import base_seed, numbers_in, seeds_of
from botschool.labs.training import filled, post_evaluated
from lab_students import answer, edit, offered, write_row

FULL = {name: float(most) for name, most in PARTS.items()}
NOTHING = dict.fromkeys(FULL, 0)
OTHER_FILES = "Evolving from the same seeds gives other files"


def no_runs(place, other):
    shutil.rmtree(place.runs)
    return NOTHING, "There are no runs yet"


def runs_of_another(place, other):
    """As they are: their seeds follow from another name."""
    shutil.rmtree(place.runs)
    shutil.copytree(other.runs, place.runs)
    return NOTHING, "belong to"


def another_robot(place, other):
    """A genotype edited, in the best run of the last condition."""
    name = place.lab.conditions[-1].name
    runs = own_runs(place.lab, place.sheet(), place.runs)[name]
    best = max(runs, key=lambda run: run.stat[-1, 2])
    file = place.runs / name / f"bestgS{best.seed}.npy"
    genotype = np.load(file)
    genotype[: len(genotype) // 2] = 0
    np.save(file, genotype)
    return without(place.lab, name, evidence=0), f"{name}, seed {best.seed}"


def too_few(place, other):
    name = place.lab.conditions[-1].name
    next((place.runs / name).glob("statS*.npy")).unlink()
    left = place.lab.replications - 1
    return without(place.lab, name, evidence=15), f"{name} has {left}"


def another_prediction(place, other):
    answer(place, {"why": "I knew it before because somebody has told me the result of it all."})
    return NOTHING, "The prediction has changed since the runs were made"


def invented_number(place, other):
    """A cell of the table."""
    lab = place.lab
    name = lab.conditions[-1].name
    at = next(i for i, column in enumerate(lab.columns) if name.startswith(column.only))
    row = [*place.sheet().row(name)]
    row[at] = re.sub(r"[-\d.]+", "-77777", row[at])
    write_row(place, name, f"| {name} | {' | '.join(row)} |")
    most = len(cells(lab))
    left = FULL | {"measurements": round(10 + 15 * (most - 1) / most, 1)}
    return left, f"The table, {name}, {lab.titles[at]}: your runs give"


def conclusions_against_their_data(place, other):
    """Every one."""
    contradict(place, *place.lab.statements)
    return FULL | {"conclusion": 0}, place.lab.fields[[*place.lab.statements][-1]].what


def contradict(place, *ids):
    """Answer what the student's own data do not support."""
    found = Check(place).all()
    for id in ids:

        def wrong(given, id=id):
            judge = place.lab.statements[id].judge
            return not judge(found.data, found.answers | {id: given})[0](given)

        found.answers[id] = next(filter(wrong, offered(place, id) or [0, 1, 0.5, -7, 77]))
        answer(place, {id: found.answers[id]})


def cells(lab):
    """The condition of each cell of the table."""
    return [
        c.name for c in lab.conditions for column in lab.columns if c.name.startswith(column.only)
    ]


def without(lab, *conditions, evidence):
    """The points that are left where conditions lack a run; evidence: for the other runs."""
    most, all_cells, states = len(lab.conditions), cells(lab), lab.statements.values()
    kept = sum(name not in conditions for name in all_cells)
    return FULL | {
        "runs": round(evidence + 10 * (most - len(conditions)) / most, 1),
        "measurements": round(10 + 15 * kept / len(all_cells), 1),
        "conclusion": sum(s.points for s in states if not {*conditions} & {*s.needs}),
    }


# --- forgers
def forge(place, condition, seed, stat, genotype):
    """Write a run whose robot has the fitness that its files tell."""
    stat = stat.copy()
    try:
        if condition.kind == "training":
            told = condition.experiment
            stat[-1, 2] = post_evaluated(told, filled(told, genotype), seed)
        elif not condition.load().competitive:
            evaluator = evaluator_of(condition, seed)
            stat[-1, 2] = evaluator.post_fitness(*evaluator.policy.split(genotype))
    except (AttributeError, BotschoolError):
        pass  # a robot of another shape gets no fitness
    files = RunFiles(place.runs / condition.name, seed)
    np.save(files.stat, stat.ravel())
    np.save(files.bestg, genotype)
    return files


def forge_from(place, condition, seed, folder, run):
    """Write a run with the files of a finished one in another folder, as long as it must be."""
    stat = stretched(condition, run.stat, len(run.populations) > 0)
    files = forge(place, condition, seed, stat, run.genotype)
    theirs = RunFiles(folder / run.condition.name, run.seed)
    for generation in run.populations:
        shutil.copy(theirs.populations(generation), files.populations(generation))
    if theirs.checkpoint.exists():
        shutil.copy(theirs.checkpoint, files.checkpoint)


def runs_of_another_forged(place, other):
    mine = seeds_of(place.sheet(), place.lab)
    for name, runs in own_runs(other.lab, other.sheet(), other.runs).items():
        for seed, run in zip(mine[name], runs, strict=True):
            forge_from(place, run.condition, seed, other.runs, run)
    return NOTHING, OTHER_FILES


def one_run_copied_to_fill_up(place, other):
    """Under the seed of the run that was not made."""
    condition = place.lab.conditions[-1]
    first, second, *_ = own_runs(place.lab, place.sheet(), place.runs)[condition.name]
    forge_from(place, condition, second.seed, place.runs, first)
    return without(place.lab, condition.name, evidence=0), f"{condition.name}, seed {second.seed}"


def another_robot_forged(place, other):
    condition = place.lab.conditions[-1]
    run = own_runs(place.lab, place.sheet(), place.runs)[condition.name][0]
    genotype = run.genotype.copy()
    genotype[: len(genotype) // 2] *= 0.5
    files = forge(place, condition, run.seed, run.stat, genotype)
    if run.populations:
        forge_meeting(run, files)
    return without(place.lab, condition.name, evidence=0), f"{condition.name}, seed {run.seed}"


def forge_meeting(run, files):
    """Co-evolution: the last population is edited, and its meetings told as they come out."""
    last, again = max(run.populations), Coevolution(run.condition.load(), run.seed)
    networks, stat = run.populations[last].copy(), run.stat.copy()
    networks[0] *= 0.5
    met = everyone(lambda *pairs: again._meet(lambda: False, *pairs)[0], *np.split(networks, 2))
    stat[last - 1, 3:5] = mean(met[0]), mean(met)
    np.save(files.populations(last), networks)
    np.save(files.stat, stat.ravel())
    np.save(files.bestg, np.concatenate([networks[0], networks[len(networks) // 2]]))


def stretched(condition, stat, competitive):
    """A curve with the steps, or the generations, of a whole run."""
    algo = condition.load().algo if condition.kind == "evolving" else None
    budget = algo.maxmsteps if hasattr(algo, "maxmsteps") else None
    if condition.kind == "training":
        budget = condition.experiment["algo"]["maxmsteps"]
    if condition.generations or budget is None or competitive:
        whole = condition.generations or getattr(algo, "ngenerations", len(stat))
        return stat[np.linspace(0, len(stat) - 1, max(whole, len(stat))).astype(int)]
    stat = stat.copy()
    stat[:, 0] *= np.ceil(budget * 1e6 / stat[-1, 0])
    return stat


def a_run_of_another_experiment(place, other):
    """The second condition's settings, under a seed of the first."""
    one, two, *_ = place.lab.conditions
    lab = replace(place.lab, conditions=(replace(two, name=one.name),))
    assert make_runs(lab, place.sheet(), place.folder / "runs-other", 1, 1)
    (run,) = own_runs(lab, place.sheet(), place.folder / "runs-other")[one.name]
    forge_from(place, one, run.seed, place.folder / "runs-other", run)
    return without(place.lab, one.name, evidence=0), f"{one.name}, seed {run.seed}"


def another_prediction_and_files_renamed(place, other):
    """And the note beside the runs rewritten."""
    before = seeds_of(place.sheet(), place.lab)
    answer(place, {"why": "I knew it before because somebody has told me the result of it all."})
    for name, seeds in seeds_of(place.sheet(), place.lab).items():
        for old, seed in zip(before[name], seeds, strict=True):
            for path in (place.runs / name).glob(f"*S{old}*.np*"):
                path.rename(path.with_name(path.name.replace(str(old), str(seed))))
    told = {"seed": base_seed(place.sheet(), place.lab), "prediction": place.sheet().prediction}
    (place.runs / ABOUT).write_text(json.dumps(told))
    return NOTHING, OTHER_FILES


# --- what costs nothing
def spaces_in_the_prediction(place, other):
    def spaced(text):
        head, title, rest = text.partition("## Prediction")
        body, after, end = rest.partition("\n## ")
        return head + title + body.replace(" ", "  ").replace("\n", " \n") + after + end

    edit(place, spaced)
    return FULL, ""


def numbers_written_in_another_way(place, other):
    """With more digits, a typographic minus and a dash between the ends of an interval."""
    for condition in place.lab.conditions:
        row = place.sheet().row(condition.name)
        for at, column in enumerate(place.lab.columns):
            if condition.name.startswith(column.only):
                count = 1 + (" to " in row[at])
                numbers = numbers_in(row[at], "it", count)
                shown = [f"{each:.7f}".replace("-", "\u2212") for each in numbers]
                row[at] = " \u2013 ".join(shown)
        write_row(place, condition.name, f"| {condition.name} | {' | '.join(row)} |")
    return FULL, ""


SPOILED = [
    no_runs,
    runs_of_another,
    runs_of_another_forged,
    another_robot,
    too_few,
    one_run_copied_to_fill_up,
    another_prediction,
    another_prediction_and_files_renamed,
    spaces_in_the_prediction,
    invented_number,
    numbers_written_in_another_way,
    conclusions_against_their_data,
]
IF_DRAWN = [another_robot_forged, a_run_of_another_experiment]
"""Those of some of the runs, found where one of these is made again."""
