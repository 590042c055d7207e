"""Post-evaluate co-evolved populations: `es -p -g STRING`.

P-g-n          the n best predators of generation g against its n best prey, shown
p-g-n          the same without a picture
m-g-i          generation g against generations g, g - i, g - 2 i, ...
M-g-i          all of these generations against each other
c-FILE1-FILE2  populations of two runs against each other
"""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from botschool.analysis import tournament_report as report
from botschool.analysis.populations import (
    POPULATIONS,
    Population,
    Populations,
    counted,
    read_population,
    seeds_of,
)
from botschool.analysis.tournament import Contest, Table, master_tournament, play, summarised
from botschool.analysis.tournament_report import check_files, draw, save_csv
from botschool.cluster import Open
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.inifile import shown

FORMS = "P-100-5, p-100-5, m-100-10, M-100-10, c-FILE1-FILE2"
GENERATIONS = 11
"""Largest number of generations of a tournament, unless the user chooses."""
BEST = 10
"""Individuals of each population that take part, unless the user chooses."""

_STRING = re.compile(r"(?P<kind>[PpmM])-(?P<generation>\d{1,9})-(?P<number>\d{1,9})", re.ASCII)


def names_file(text: str) -> bool:
    """Return whether -g names a file of one predator and one prey, not one of the strings above.

    Raises BotschoolError for a file of populations.
    """
    if POPULATIONS.fullmatch(Path(text).name) and Path(text).is_file():
        raise BotschoolError(
            f"{text} holds whole populations: give their generation, as -g P-100-5, and with -o "
            "the folder."
        )
    return Path(text).is_file() or (text.endswith(".npy") and not text.startswith("c-"))


@dataclass(frozen=True)
class Request:
    """A parsed string: its letter, then generation and last number (n or i), or files."""

    kind: str
    generation: int = 0
    number: int = 1
    files: tuple[Path, Path] | None = None


def parse(text: str, folder: Path) -> Request:
    """Return the meaning of the string.

    Raises BotschoolError for any other string; the sentence lists what the folder holds.
    """
    if text.startswith("c-"):
        return Request("c", files=split_files(text, folder))
    match = _STRING.fullmatch(text)
    if match is None or int(match["number"]) == 0:
        raise BotschoolError(
            f"-g {shown(text)} is neither a file nor one of {FORMS}, whose last "
            f"number is at least 1 ({_there(folder)})."
        )
    return Request(match["kind"], int(match["generation"]), int(match["number"]))


def split_files(text: str, folder: Path) -> tuple[Path, Path]:
    """Return the two files of c-FILE1-FILE2; their names may contain "-", too.

    Among all ways to split the string, only one may give two files that exist, from here or in the
    run's folder. Raises BotschoolError otherwise.
    """
    parts = text.split("-")[1:]
    splits = []
    for cut in range(1, len(parts)):
        names = "-".join(parts[:cut]), "-".join(parts[cut:])
        one, other = (_existing(name, folder) for name in names)
        if one and other:
            splits.append((one, other))
    if len(splits) == 1:
        return splits[0]
    if splits:
        raise BotschoolError(
            f"-g {shown(text)} names two files in more ways than one: rename one without '-'."
        )
    raise BotschoolError(
        f"-g {shown(text)} does not name two files that exist, as c-one/S1G100.npy-two/S2G100.npy "
        f"would ({_there(folder)})."
    )


def _existing(name: str, folder: Path) -> Path | None:
    candidates = (Path(name), folder / name) if name else ()
    return next(filter(Path.is_file, candidates), None)


def _there(folder: Path) -> str:
    """Return the generations of each seed that the folder holds."""
    found = seeds_of(folder)
    if not found:
        return f"{folder} holds no populations"
    seeds = "; ".join(f"{counted(found[seed])} of seed {seed}" for seed in list(found)[:5])
    return f"{folder} holds {seeds}{' and more' if len(found) > 5 else ''}"


Show = Callable[[Population], None]


def post_evaluate(
    experiment: Experiment, seed: int, folder: Path, request: Request, workers: int, show: Show
) -> None:
    """Run the post-evaluation of a request and print its tables; `show` gets the population of P.

    Raises BotschoolError for a generation or a file that cannot be used.
    """
    with Contest(experiment, seed, workers) as contest:
        report.print_roles(contest.roles)
        _post_evaluate(contest, folder, request, show)


def _post_evaluate(contest: Contest, folder: Path, request: Request, show: Show) -> None:
    if request.files:
        cross_test(contest, request.files)
        return
    populations = Populations(folder, contest.seed, contest.policy, contest.single)
    if request.kind in "Pp":
        [generation] = nearest(populations, [request.generation])
        population = populations.load(generation).best(request.number)
        if request.kind == "P":
            show(population)
        _pairs(contest, population)
        return
    chosen = select(populations, earlier(populations, request.generation, request.number))
    names = [population.name for population in chosen]
    print(_taking_part(chosen))
    if request.kind == "M":
        report.print_tournament(_tournament(contest, chosen), names)
    else:
        report.print_row(*_row(contest, chosen), names[-1], names)


def tournament(
    experiment: Experiment,
    folder: Path,
    seed: int | None,
    wanted: list[int] | None,
    every: int | None,
    best: int | None,
    workers: int,
    picture: Path | None,
    window: bool,
    cluster: Open | None = None,
) -> None:
    """Run `botschool tournament`: print tables and verdict, write the picture and its CSV file.

    seed: None means the only one in the folder. cluster: evaluates instead of `workers` cores.
    wanted: the generations; None chooses every `every`-th, or GENERATIONS of them. window: show the
    picture on the screen if no file is named.
    """
    files = None if picture is None else check_files(picture)
    seed = only_seed(folder) if seed is None else seed
    with Contest(experiment, seed, workers) as contest, ExitStack() as stack:
        populations = Populations(folder, seed, contest.policy, contest.single)
        generations = wanted or thinned(populations, every)
        if len(generations) < 2:
            raise BotschoolError(
                f"A tournament needs at least two generations: {populations.there()}."
            )
        chosen = select(populations, generations, best)
        report.print_roles(contest.roles)
        print(_taking_part(chosen))
        if cluster:
            contest.problem = stack.enter_context(cluster.problem(experiment, print))
        tables = _tournament(contest, chosen)
    report.print_tournament(tables, [population.name for population in chosen])
    if files:
        save_csv(files[1], tables, generations)
    if files or window:
        draw(tables, generations, _title(contest, chosen), picture)
    if files:
        print(f"picture: {files[0]}, its numbers: {files[1]}")
    elif not window:
        print("For a picture of the tournament, add -o PICTURE.png.")


def only_seed(folder: Path) -> int:
    """Return the only seed of the folder's populations. Raises BotschoolError without just one."""
    seeds = list(seeds_of(folder))
    if len(seeds) != 1:
        there = f"several seeds ({', '.join(map(str, seeds))})" if seeds else "no populations"
        raise BotschoolError(f"{folder} holds {there}: name the run's folder and its seed (-s).")
    return seeds[0]


def generations_in(text: str | None, every: int | None) -> list[int] | None:
    """Return the generations in a text like 0,100,200, sorted, or None. Raises BotschoolError."""
    if text is None:
        return None
    if every is not None:
        raise BotschoolError("--generations and --every both choose generations: give one of them.")
    numbers = text.replace(" ", "").split(",")
    if not all(re.fullmatch(r"[0-9]{1,9}", number) for number in numbers):
        raise BotschoolError(
            f"--generations {shown(text)} is not a list of generations such as 0,100,200."
        )
    return sorted(set(map(int, numbers)))


def thinned(populations: Populations, every: int | None) -> list[int]:
    """Return the saved generations that `every` divides; without it, GENERATIONS evenly spaced.

    Raises BotschoolError if fewer than two are left.
    """
    there = populations.generations
    if every is None:
        return [there[place] for place in report.spaced(len(there), GENERATIONS)]
    found = [generation for generation in there if generation % every == 0]
    if len(found) < 2:
        raise BotschoolError(
            f"--every {every} leaves {len(found)} generations, and two are needed: "
            f"{populations.there()}."
        )
    return found


def _taking_part(chosen: list[Population], of: str = "generation") -> str:
    count = len(chosen[0].prey)
    return f"the {count} best predators and prey of each of {len(chosen)} {of}s take part"


def _title(contest: Contest, chosen: list[Population]) -> str:
    return (
        f"{contest.problem.name}, seed {contest.seed}: master tournament of "
        f"{_taking_part(chosen).removesuffix(' take part')}"
    )


def _tournament(contest: Contest, chosen: list[Population]) -> tuple[Table, Table]:
    with report.progress_bar(len(chosen)) as done:
        return master_tournament(contest, chosen, done)


def earlier(populations: Populations, generation: int, every: int) -> list[int]:
    """Return generations g, g - i, g - 2 i, ... sorted, the nearest saved one for each.

    Prints a warning about missing ones.
    """
    found = nearest(populations, list(range(generation, -1, -every)))
    if len(found) < 2:
        raise BotschoolError(
            f"There is no generation before {generation} in steps of {every}: "
            f"{populations.there()}."
        )
    return found


def nearest(populations: Populations, wanted: list[int]) -> list[int]:
    """Return the saved generations that are nearest to the wanted ones, sorted.

    Prints a warning about missing ones.
    """
    there = populations.generations
    found = sorted({min(there, key=lambda saved: abs(saved - g)) for g in wanted})
    if missing := sorted(set(wanted) - set(there)):
        names, instead = (counted(some).removesuffix(" alone") for some in (missing, found))
        are = "is" if len(missing) == 1 else "are"
        take = "takes" if len(found) == 1 else "take"
        print(f"warning: {names} {are} not saved; the nearest {take} part: {instead}")
    return found


def select(
    populations: Populations, generations: list[int], best: int | None = None
) -> list[Population]:
    """Return the best individuals of these generations, at most BEST, equally many of each."""
    loaded = [populations.load(generation) for generation in generations]
    return equal_parts(loaded, best)


def equal_parts(loaded: list[Population], best: int | None = None) -> list[Population]:
    """Return the best individuals of each population, the same number of each.

    Raises BotschoolError if that is less than two.
    """
    fewest = min(loaded, key=lambda population: len(population.prey))
    if len(fewest.prey) < 2:
        raise BotschoolError(
            f"{fewest.name} has a single predator and prey, which gives no 95 % interval: "
            "set popsize to 2 or more."
        )
    return [population.best(best or min(BEST, len(fewest.prey))) for population in loaded]


def cross_test(contest: Contest, files: tuple[Path, Path]) -> None:
    """Evaluate the best individuals of two runs against each other and against their own run's."""
    loaded = [read_population(path, contest.policy, str(path), contest.single) for path in files]
    print(_taking_part(loaded := equal_parts(loaded), "population"))
    report.print_cross(master_tournament(contest, loaded), [str(path) for path in files])


def _pairs(contest: Contest, population: Population) -> None:
    fitness = play(contest, [population.predators], [population.prey])
    report.print_pairs(fitness[..., 0, 0, :, :], summarised(fitness, contest.seed), population.name)


def _row(contest: Contest, populations: list[Population]) -> tuple[Table, Table]:
    """Return the tables of the last generation's predators and prey against all generations."""
    last = populations[-1]
    hunting = play(contest, [last.predators], [population.prey for population in populations])
    hunted = play(contest, [population.predators for population in populations], [last.prey])
    return summarised(hunting, contest.seed)[0], summarised(hunted, contest.seed)[1]
