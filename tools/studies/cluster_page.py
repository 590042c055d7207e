"""Blocks of docs/reports/cluster.md, `<!-- NAME -->` to `<!-- end -->`, and its figure, made from
tools/studies/data/cluster.json."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
from cluster_model import Load, Times, Wire, generation
from results_page import DOCS, markdown, re

from botschool.cluster.chunks import LEAST

DATA = Path(__file__).parent / "data" / "cluster.json"
PAGE = DOCS / "reports" / "cluster.md"
FIGURE = DOCS / "images" / "cluster.png"
NETWORK = 2e-4
"""Seconds that a message and its answer take more between machines than inside one: assumed."""
THREADS = 16
"""Cores of a machine, and threads of its worker, in the outlook."""
CORES = (1, 16, 112, 1440)
CURVE = (1, 2, 4, 8, 16, 32, 64, 112, 224, 448, 960, 1440)
LARGER = (1, 10, 100)
CORES_HERE = 2


def load() -> dict:
    """{part: {"data", "measured"}}."""
    return json.loads(DATA.read_text(encoding="utf-8"))


def loads(data: dict, kind: str) -> dict[str, Load]:
    found = data["constants"]["data"][kind]
    return {
        name: Load(**{**each, "steps": np.array(each["steps"])}) for name, each in found.items()
    }


def constants(data: dict) -> str:
    """What the model is made of."""
    rows = [
        [
            name,
            str(each.episodes),
            f"{each.steps.mean():.0f}",
            f"{1e6 * each.step / each.lanes:.2g}",
            f"{each.steps.mean() * each.episodes * each.step / each.lanes:.3g}",
            f"{1000 * each.algorithm:.2g}",
        ]
        for name, each in loads(data, "as it is").items()
    ]
    wire = data["turns"]["data"]["wire"]
    table = markdown(
        [
            *("experiment", "episodes of a turn", "steps of each", "microseconds a step"),
            *("seconds of a core", "algorithm, ms"),
        ],
        rows,
    )
    chunk, there, latency = (1000 * wire[name] for name in ("chunk", "there", "latency"))
    return (
        f"{table}\n\nA chunk costs command and scheduler {chunk:.1f} ms and its worker {there:.1f} "
        f"ms, and takes {latency:.1f} ms from its sending to its answer besides its computation."
    )


def measured(data: dict) -> str:
    """Prediction against measurement, on this machine."""
    wire = Wire(**data["turns"]["data"]["wire"])
    cores, rows, off = ours(data), [], []
    for name, each in loads(data, "heavier").items():
        clock = data["turns"]["data"][name]
        for kind in ("predicted", "measured"):
            row = [f"{name}, {kind}"]
            for workers, seconds in sorted(clock.items(), key=lambda pair: int(pair[0])):
                said = generation(each, wire, int(workers), cores=cores).whole
                row.append(f"{said if kind == 'predicted' else seconds:.2f}")
                if kind == "measured":
                    off.append(said / seconds)
            rows.append(row)
    counts = sorted(map(int, clock))
    ratios = [
        f"{np.median(off[place :: len(counts)]):.2f} with {n}" for place, n in enumerate(counts)
    ]
    heads = ["seconds of a turn", *(f"{n} workers" for n in counts)]
    return (
        f"{markdown(heads, rows)}\n\nOther programs took {CORES_HERE - cores:.1f} of the two cores "
        f"meanwhile, so the prediction is for {cores:.1f}. Prediction / measurement, median of the "
        f"four: {', '.join(ratios)} workers."
    )


def ours(data: dict) -> float:
    """Cores that other programs left us while turns were measured."""
    found = re.search(r"used ([\d.]+) cores", data["turns"]["measured"]["note"])
    return CORES_HERE - (float(found[1]) if found else 0.0)


@cache
def outlook_of(text: str) -> tuple[dict[str, Load], Wire]:
    data = json.loads(text)
    wire = data["turns"]["data"]["wire"]
    return loads(data, "as it is"), Wire(wire["chunk"], wire["there"], wire["latency"] + NETWORK)


def speedups(each: Load, wire: Wire, cores: int) -> tuple[float, Times]:
    """How many times as fast as one core without a cluster, and the times of a turn."""
    if cores == 1 or each.evaluation < LEAST:  # too short: it is not sent
        times = Times(each.evaluation, 0.0, 0.0, each.algorithm, 0)
        return 1.0, times
    threads = min(cores, THREADS)
    times = generation(each, wire, max(1, cores // threads), threads)
    return (each.evaluation + each.algorithm) / times.whole, times


def outlook(data: dict) -> str:
    """What the model says for more cores."""
    found, wire = outlook_of(json.dumps(data))
    rows = []
    for (name, each), larger in [(pair, f) for pair in found.items() for f in LARGER]:
        bigger = each.larger(larger)
        row = [name if larger == 1 else f"... {larger} times the candidates"]
        row.append(f"{bigger.evaluation + bigger.algorithm:.3g}")
        for cores in CORES[1:]:
            speedup, times = speedups(bigger, wire, cores)
            row += [f"{times.whole:.3g}", f"{speedup:.3g}"]
        row.append(most(times))
        rows.append(row)
    heads = ["experiment", "1 core, s"]
    for cores in CORES[1:]:
        heads += [f"{cores:,} cores, s", "times as fast"]
    return markdown([*heads, f"most of {CORES[-1]:,} cores' time"], rows)


def most(times: Times) -> str:
    """What most of a turn goes to."""
    parts = ("evaluation", "stragglers", "wire", "algorithm")
    whole = times.whole
    name = max(parts, key=lambda part: getattr(times, part))
    return f"{name} {100 * getattr(times, name) / whole:.0f} %"


def overhead(data: dict) -> str:
    rows = [
        [
            name,
            f"{each['generation']:.2f}",
            f"{100 * (each['clock'] - 1):+.1f} %",
            ", ".join(f"{100 * (c - 1):+.0f}" for c in each["all clocks"]),
            f"{100 * (each['processor'] - 1):+.1f} %",
        ]
        for name, each in data["overhead"]["data"].items()
    ]
    return markdown(
        [
            *("experiment", "a generation with -w 2, s", "by the clock (median)", "each pair, %"),
            "processor time",
        ],
        rows,
    )


def traffic(data: dict) -> str:
    rows = [
        [
            name,
            str(each["candidates"]),
            str(each["parameters"]),
            f"{each['messages']:.0f}",
            f"{each['all']:.0f}",
            f"{8 * each['parameters']}",
        ]
        for name, each in data["traffic"]["data"].items()
    ]
    return markdown(
        [
            *("experiment", "candidates of a turn", "parameters", "bytes a candidate, messages"),
            *("with all that Dask adds", "its genotype, bytes"),
        ],
        rows,
    )


def conditions(data: dict) -> str:
    rows = [
        [name, m["date"], m["commit"], m["machine"], m["note"]]
        for name, m in ((name, part["measured"]) for name, part in data.items())
    ]
    return markdown(["part", "date", "commit", "machine", "meanwhile"], rows)


BLOCKS: dict[str, Callable[[dict], str]] = {
    "constants": constants,
    "measured": measured,
    "outlook": outlook,
    "overhead": overhead,
    "traffic": traffic,
    "conditions": conditions,
}


def filled(text: str, data: dict) -> str:
    """The page with its blocks made anew."""
    for name, made in BLOCKS.items():
        pattern = rf"(<!-- {name} -->\n).*?(<!-- end -->)"
        block = made(data)
        text = re.sub(pattern, lambda m, b=block: f"{m[1]}{b}\n{m[2]}", text, flags=re.DOTALL)
    return text


def figure(data: dict) -> None:
    """Times as fast as one core, by the number of cores; and prediction against measurement."""
    import matplotlib.pyplot as plt

    found, wire = outlook_of(json.dumps(data))
    own = Wire(**data["turns"]["data"]["wire"])
    panes, (left, right) = plt.subplots(1, 2, figsize=(12, 4.6), constrained_layout=True)
    for colour, (name, each) in enumerate(loads(data, "heavier").items()):
        clock = {int(n): t for n, t in data["turns"]["data"][name].items()}
        counts = sorted(clock)
        said = [generation(each, own, n, cores=ours(data)).whole for n in counts]
        left.plot(counts, [clock[n] for n in counts], "o", color=f"C{colour}")
        left.plot(counts, said, "-", color=f"C{colour}", label=name)
    left.set(
        xlabel="local workers, on two cores",
        ylabel="seconds of a turn",
        ylim=(0, None),
        title="Predicted (lines), measured (dots)",
    )
    left.legend()
    for colour, (name, each) in enumerate(found.items()):
        for larger, style in zip(LARGER, ("-", "--", ":"), strict=True):
            fast = [speedups(each.larger(larger), wire, n)[0] for n in CURVE]
            label = name if larger == 1 else None
            right.plot(CURVE, fast, style, color=f"C{colour}", label=label)
    right.plot(CURVE, CURVE, color="grey", linewidth=0.7)
    right.set(
        xscale="log",
        yscale="log",
        xlabel=f"cores, in workers of {THREADS}",
        ylabel="times as fast as one core",
        title="Predicted; with 10 (dashed), 100 (dotted) times the candidates",
    )
    right.legend()
    panes.savefig(FIGURE, dpi=110)
    plt.close(panes)


def write() -> None:
    """The page and its figure."""
    data = load()
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), data), encoding="utf-8")
    figure(data)
