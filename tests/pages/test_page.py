"""Pages that evolve: the twins in C++ and JavaScript against the command, in Node and in a browser.

They need the core for pages; `make test-all` builds it.
"""

import hashlib
import json
import re
import shutil
import subprocess
import sys
from dataclasses import make_dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from botschool import config, page
from botschool.analysis.tournament import Contest
from botschool.config import from_dict
from botschool.errors import BotschoolError
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.run import Run, evolve
from botschool.page.training import page_data, settings_of, write_training_page
from botschool.problems.native import NativeProblem
from botschool.render.scenes import make_scene
from botschool.rl.model import choose
from botschool.rl.native import files, training
from botschool.rl.native import problem as problem_of_training

ROOT = Path(__file__).parents[2]
SCRIPTS = ROOT / "lib/botschool/page"
PROBLEMS = (
    "CartPole-v1",
    "Acrobot-v1",
    "Pendulum-v1",
    "ErDpole",
    "ErDiscrim",
    "MountainCarContinuous-v0",
    "envSwingupCustom",
    "PlanarHopper-v5",
    "SpatialAnt-v5",
)


def experiment_of(problem, algo, **policy):
    given = {"episodes": 2, "pepisodes": 3, "maxsteps": 100, "nhiddens": 7, "bias": 1} | policy
    evolving = (
        {"popsize": 6}
        if algo == "SSS"
        else {
            "samplesize": 4,
            "wdecay": len(problem) % 3,
            "symseed": (len(problem) + 1) % 3,
        }
    )
    return from_dict(
        {
            "exp": {"environment": problem, "algo": algo},
            "policy": given,
            "algo": {"maxmsteps": 0.02} | evolving,
        }
    )


def predators_and_prey(**options):
    """A small arms race."""
    policy = {"nrobots": 2, "heterogeneous": 1, "maxsteps": 60, "nhiddens": 5, "pepisodes": 2}
    rules = {"ngenerations": 4, "popsize": 5, "selsize": 2, "samplesize": 3, "saveeach": 3}
    return from_dict(
        {
            "exp": {"environment": "ErPredprey", "algo": "coevo2"},
            "policy": policy | {"out_type": 2, "winit": 0},
            "algo": rules | {"wdecay": 1, "noiseStdDev": 0.3, "stepsize": 0.2} | options,
        }
    )


def written(experiment, tmp_path, seed=3, **more):
    """The page of an experiment, its data and its path."""
    path = tmp_path / "page.html"
    page.write_page(path, experiment, seed, **more)
    text = path.read_text()
    data = text.partition('<script id="data" type="application/json">')[2].partition("</script>")[0]
    return path, json.loads(data)


def core_of(experiment):
    return str(SCRIPTS / f"{page.part_of(experiment.exp.environment)}.wasm")


def node(tmp_path, script, *scripts):
    """What a program in JavaScript prints, as JSON."""
    if shutil.which("node") is None:
        pytest.skip("no Node found: install nodejs to test pages without a browser")
    parts = [(SCRIPTS / name).read_text() for name in (*scripts, "core.js", "files.js")]
    program = tmp_path / "program.mjs"
    program.write_text("\n".join(['import { readFileSync } from "fs";', *parts, script]))
    done = subprocess.run(
        ["node", "--no-warnings", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


EVOLVE = """
import { createHash } from "crypto";
const { core: place, experiment, seed } = JSON.parse(readFileSync(0));
const core = await Core.load(readFileSync(place));
const run = core.run(core.task(experiment), experiment, seed);
const kept = [];
let steps = 0;
const { generations } = experiment;
while (generations ? run.generation < generations : steps < experiment.steps) {
  steps = run.advance();
  if (!generations || run.part > 0) continue;
  const last = run.generation === generations;
  if (last || run.generation % experiment.saveeach === 0)
    kept.push([run.generation, run.individuals, run.meetings]);
}
const { rows, best, bestg, generation } = run;
const files = runFiles(seed, { rows, best, bestg, generation, kept });
const digest = (bytes) => createHash("sha256").update(bytes).digest("hex");
console.log(JSON.stringify(Object.fromEntries(
  Object.entries(files).map(([name, bytes]) => [name, digest(bytes)]))));
"""


def digests_of_the_command(experiment, seed, folder):
    folder.mkdir()
    evolve((Coevolution if experiment.competitive else Run)(experiment, seed), folder)
    own = ("checkpoint", "fresh")  # that a page does not offer
    files = [path for path in folder.glob("*S*.*") if not path.name.startswith(own)]
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def evolved_by_node(experiment, seed, tmp_path, core=None):
    _, data = written(experiment, tmp_path, seed)
    given = {"core": core or core_of(experiment), "experiment": data["experiment"], "seed": seed}
    (tmp_path / "given.json").write_text(json.dumps(given))
    script = EVOLVE.replace("readFileSync(0)", f'readFileSync("{tmp_path}/given.json")')
    return node(tmp_path, script)


@pytest.mark.slow
@pytest.mark.parametrize("algo", ["OpenAI-ES", "SSS"])
@pytest.mark.parametrize("problem", PROBLEMS)
def test_run_files_are_the_command_s(problem, algo, tmp_path):
    kinds = {
        "ErDiscrim": {"architecture": 3},
        "ErDpole": {"architecture": 1, "pmaxsteps": 150},
        "Acrobot-v1": {"out_type": 3, "winit": 1},
        "PlanarHopper-v5": {"action_noise": 1, "normalize": 1, "clip": 1, "winit": 1},
        "SpatialAnt-v5": {"action_noise": 1, "normalize": 1, "clip": 1, "winit": 1},
        "Pendulum-v1": {"nlayers": 2, "normalize": 1, "episodes": 1},
        "envSwingupCustom": {"architecture": 2, "out_type": 2},
    }
    experiment = experiment_of(problem, algo, **kinds.get(problem, {}))
    expected = digests_of_the_command(experiment, 3, tmp_path / "run")
    assert evolved_by_node(experiment, 3, tmp_path) == expected


@pytest.mark.slow
@pytest.mark.parametrize("evolving", ["best", "random"])
def test_arms_races_are_the_command_s(evolving, tmp_path):
    experiment = predators_and_prey(evolving=evolving)
    expected = digests_of_the_command(experiment, 3, tmp_path / "run")
    assert {"S3G0.npy", "S3FitG3.npy", "S3G4.npy", "statS3.npy", "bestgS3.npy"} <= expected.keys()
    assert evolved_by_node(experiment, 3, tmp_path) == expected


def core_file(data):
    return str(SCRIPTS / f"{page.part_of(data['experiment']['problem'])}.wasm")


TRAIN = """
import { createHash } from "crypto";
const { core: place, data: read, seed } = JSON.parse(readFileSync(GIVEN));
globalThis.data = read;
const { experiment } = read;
const core = await Core.load(readFileSync(place));
const task = core.task(experiment);
const run = core.run(task, experiment, seed);
for (let steps = 0; steps < experiment.steps;) steps = run.advance();
const digest = (bytes) => createHash("sha256").update(bytes).digest("hex");
console.log(JSON.stringify({
  rows: [...run.rows],
  first: [...core.initial(task, seed, 1, run.best.length).slice(0, 20)],
  files: Object.fromEntries(Object.entries(modelFiles(run)).map(([name, bytes]) => [name, digest(bytes)])),
}));
"""  # noqa: E501


@pytest.mark.slow
@pytest.mark.parametrize(
    ("env", "given"),
    [
        ("CartPole-v1", {"clip_range": "linear 0.2", "learning_rate": "linear 0.003"}),
        ("Pendulum-v1", {"normalize": True, "clip_range_vf": 0.2, "net_arch": [16]}),
        ("Acrobot-v1", {"normalize": True, "target_kl": 0.01, "ortho_init": False}),
        ("botschool/Discrim-v0", {"ent_coef": 0.01, "share_layers": True}),
        ("botschool/DoublePole-v0", {"normalize": True}),
        ("botschool/SwingUp-v0", {"gae_lambda": 0.9}),
        ("botschool/PlanarHopper-v5", {"normalize": True, "activation_fn": "relu"}),
    ],
)
def test_trainings_are_the_command_s(env, given, tmp_path):
    """Both model files byte by byte, with all parameters, and all post-evaluations."""
    small = {"n_steps": 64, "batch_size": 128, "n_epochs": 3}
    length = {"envs": 20, "steps": 8000, "seed": 3, "evaluations": 4, "episodes": 10}
    settings = choose("ppo", env, params=small | given, engine="native", **length)
    run, found = training.learn(settings, tmp_path / "run", lambda steps, found: None)
    expected = {
        name: hashlib.sha256((run.path / name).read_bytes()).hexdigest()
        for name in ("best_model.npz", "last_model.npz")
    }
    ppo = files.make(settings)
    first = ppo.parameters[:20].tolist()
    data = page_data(settings, ppo)
    given = {"core": core_file(data)}
    (tmp_path / "given.json").write_text(json.dumps(given | {"data": data, "seed": 3}))
    answer = node(tmp_path, TRAIN.replace("GIVEN", f'"{tmp_path}/given.json"'))
    assert answer["first"] == first
    rows = np.array(answer["rows"]).reshape(-1, 6)
    assert rows[:, 0].tolist() == found.steps.tolist()
    assert rows[:, 3].tolist() == found.returns.mean(axis=1).tolist()
    assert answer["files"] == expected


@pytest.mark.parametrize(
    "problem", [*PROBLEMS, "PlanarWalker2D-v0", "SpatialHumanoid-v0", "ErPredprey"]
)
def test_pictures_move_as_python_says(problem, tmp_path):
    native = NativeProblem(problem)
    scene = make_scene(native.dynamics, native.robots)
    kind = page.twin(native, scene)
    draws = np.random.default_rng(1)
    cases = []
    face = native.interface
    for i in range(20):
        state = draws.normal(size=scene.state_size)
        if "side" in kind:
            state = draws.uniform(0, kind["side"], scene.state_size)
        action = draws.integers(0, 2, 1) if face.discrete else draws.normal(size=face.outputs)
        action = np.tile(action, face.robots if not face.discrete else 1)
        seen = draws.uniform(-0.2, 1.2, face.observations * face.robots)
        reward = float(i % 2)
        cases.append([state.tolist(), action.tolist(), seen.tolist(), reward])
    expected = [scene.numbers(*case) for case in cases]
    if shutil.which("node") is None:
        pytest.skip("no Node found: install nodejs to test pages without a browser")
    (tmp_path / "cases.json").write_text(json.dumps({"scene": kind, "cases": cases}))
    script = (
        f'const {{ scene, cases }} = JSON.parse(readFileSync("{tmp_path}/cases.json"));'
        "console.log(JSON.stringify(cases.map((one) => numbersOf(scene, ...one))));"
    )
    np.testing.assert_allclose(node(tmp_path, script, "scenes.js"), expected, rtol=1e-12, atol=1e-9)


def test_the_tables_are_numpy_s():
    """The header is what the generator gives with this numpy."""
    folder = ROOT / "lib/evolution"
    made = subprocess.run([sys.executable, folder / "ziggurat.py"], capture_output=True, check=True)
    assert made.stdout == (folder / "ziggurat.hpp").read_bytes()


# Taking a robot apart

BENCH = """
const given = JSON.parse(readFileSync(GIVEN));
const { core: place, experiment, genotype, normalisation, seed, changes } = given;
const core = await Core.load(readFileSync(place));
const task = core.task(experiment);
const bench = core.bench(task, experiment.heterogeneous, experiment.limit);
bench.genotype.set(genotype);
bench.normalisation.set(normalisation ?? []);
bench.start(seed, 0);
const rows = [];
for (let step = 0; step < 40; step++) {
  for (const [when, what, which, value] of changes) {
    if (when !== step) continue;
    if (what === "blind") bench.blind[which] = 1;
    const own = what === "cut" ? core.mark(task, which, genotype.length) : [];
    own.forEach((cut, i) => { if (cut) bench.genotype[i] = 0; });
    if (what === "freeze") bench.freeze(true);
    if (what === "move") { bench.state[which] = value; bench.move(); }
  }
  const ended = bench.step();
  rows.push([bench.reward, ...bench.state, ...bench.activation]);
  if (ended) break;
}
console.log(JSON.stringify(rows));
"""


def benched(experiment, genotype, changes, tmp_path):
    _, data = written(experiment, tmp_path)
    given = {"core": core_of(experiment), "experiment": data["experiment"]}
    given |= {"genotype": genotype.tolist(), "seed": 5, "changes": changes}
    (tmp_path / "given.json").write_text(json.dumps(given))
    script = BENCH.replace("GIVEN", f'"{tmp_path}/given.json"')
    return np.array(node(tmp_path, script))


def by_python(experiment, genotype, changes):
    """The same steps with the module's stepper and network, and the changes made by hand."""
    from botschool import _core

    native = NativeProblem(experiment.exp.environment)
    policy = native.policy(experiment.policy)
    network, stepper = policy.network, _core.make_stepper(native.dynamics)
    genotype = genotype.copy()
    stepper.set(native.steps(experiment.policy.maxsteps))
    stepper.start(5, 0)
    policy.load(genotype, None)
    policy.reset(5, 0)
    blind, rows = [], []
    for step in range(40):
        for when, what, which, value in changes:
            if when != step:
                continue
            if what == "blind":
                blind.append(which)
            elif what == "cut":
                inputs, hidden = policy.spec.inputs, policy.spec.nhiddens
                assert policy.spec.architecture == 0 and policy.spec.nlayers == 1
                outputs = policy.spec.outputs
                own = which - inputs
                # biases of hidden neurons and outputs, rows of weights into them
                genotype[own] = 0
                first = hidden + outputs
                genotype[first + own * inputs : first + (own + 1) * inputs] = 0
                second = first + hidden * inputs
                genotype[second + own : second + outputs * hidden : hidden] = 0
                policy.load(genotype, None)
            elif what == "move":
                state = stepper.state
                state[which] = value
                stepper.state = state
        seen = stepper.observation
        seen[blind] = 0
        action = np.atleast_1d(policy.act(seen)).astype(np.float64)
        reward, ended = stepper.step(action)
        rows.append([reward, *stepper.state, *network.activations])
        if ended:
            break
    return np.array(rows)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("problem", "changes"),
    [
        ("ErDiscrim", []),
        ("ErDiscrim", [[5, "blind", 2, 0], [9, "cut", 10, 0], [12, "move", 3, 120.0]]),
        ("ErDpole", [[3, "move", 2, 0.1], [4, "blind", 0, 0]]),
        ("CartPole-v1", [[2, "cut", 5, 0], [3, "move", 3, 0.4]]),
        ("PlanarHopper-v5", [[4, "cut", 14, 0], [6, "move", 6, 1.0]]),
        ("SpatialAnt-v5", [[4, "cut", 30, 0], [6, "move", 15, 1.0]]),
    ],
)
def test_a_page_s_hands_do_what_they_say(problem, changes, tmp_path):
    experiment = experiment_of(problem, "OpenAI-ES")
    policy = NativeProblem(problem).policy(experiment.policy)
    genotype = 3 * policy.initial(4)
    expected = by_python(experiment, genotype, changes)
    np.testing.assert_array_equal(benched(experiment, genotype, changes, tmp_path), expected)


# The page


PAGES = (
    *("acrobot", "cartpole", "cartpole_openaies", "discrim", "dpole", "dpole_lstm"),
    *("mountaincarcontinuous", "pendulum", "planarhalfcheetah", "planarhopper", "planarwalker2d"),
    *(
        "predprey",
        "predprey_archive",
        "predprey_archivestar",
        "predprey_maxsolvestar",
        "predprey_small",
        "spatialant",
    ),
    *("spatialbalancebot", "spatialhumanoid", "swingup"),
)
"""Experiment files that can be pages."""


@pytest.mark.slow
def test_each_page_is_small_and_whole(tmp_path):
    """Each experiment file is a page below 250 KB, with its evolved robot, or is refused."""
    fitting = []
    for file in sorted((ROOT / "data/experiments").glob("*.ini")):
        experiment = config.load(file)
        name = "predprey/S12G300" if file.stem.startswith("predprey") else file.stem
        robot = ROOT / f"data/genotypes/{name}.npy"
        given = {"saved": np.load(robot), "name": robot.name} if robot.exists() else {}
        try:
            path, data = written(experiment, tmp_path, seed=11, **given)
        except BotschoolError as error:
            assert "\n" not in str(error) and str(error).endswith("."), file
            continue
        fitting.append(file.stem)
        text = path.read_text()
        assert path.stat().st_size < 350_000, file
        assert "http" not in text.replace("http-equiv", "")
        assert "/*" not in text.partition("<script>")[0].partition("</style>")[2]
        assert len(data["first"]) > 0
    assert set(fitting) == set(PAGES)
    trainable = problem_of_training._PROBLEMS
    assert {"CartPole-v1", "botschool/PlanarHalfCheetah-v5"} <= trainable.keys()
    for env in trainable:
        try:
            write_training_page(tmp_path / "training.html", env)
        except BotschoolError as error:
            assert re.search("has no picture in a page|cannot train this", str(error))
            continue
        assert (tmp_path / "training.html").stat().st_size < 350_000, env


@pytest.mark.parametrize("algo", ["MAP-Elites", "CMA-ES", "ARS", "GA", "PGPE", "(1+1)-ES", "xNES"])
def test_an_algorithm_that_pages_lack_is_refused(algo, refused, tmp_path):
    file = tmp_path / "a.ini"
    text = (ROOT / "data/experiments/planarhopper.ini").read_text().partition("[ALGO]")[0]
    lines = [f"algo = {algo}" if re.match("algo *=", one) else one for one in text.splitlines()]
    file.write_text("\n".join(lines) + "\n")
    refused("page", file, "-o", tmp_path / "a.html", says=[algo, "OpenAI-ES or SSS"])
    assert not (tmp_path / "a.html").exists()


def test_a_hyperparameter_that_the_core_does_not_know_is_refused(tmp_path):
    experiment = experiment_of("Acrobot-v1", "OpenAI-ES")
    more = make_dataclass("More", [("momentum", float, 0.9)], bases=(type(experiment.algo),))
    experiment.algo = more(**vars(experiment.algo))
    with pytest.raises(BotschoolError, match="momentum"):
        page.write_page(tmp_path / "a.html", experiment)


@pytest.mark.slow
def test_the_core_refuses_settings_that_it_does_not_know(tmp_path):
    place = str(SCRIPTS / "classic.wasm")
    said = node(
        tmp_path,
        f"""
const core = await Core.load(readFileSync({place!r}));
const asked = (given) => {{
  try {{ return [...core.settings("SSS", given)]; }} catch (error) {{ return error.message; }}
}};
const right = {{ mutrate: 0.5, popsize: 20 }};
const answers = [right, {{ popsize: 20 }}, {{ ...right, elite: 3 }}].map(asked);
console.log(JSON.stringify(answers));
""",
    )
    assert said[0] == [20, 0.5] and "mutrate" in said[1] and "elite" in said[2]


HASH = """(async () => {
  const found = {};
  for (const [name, bytes] of Object.entries(runFiles(result.seed, result))) {
    const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
    found[name] = [...digest].map((x) => x.toString(16).padStart(2, "0")).join("");
  }
  return found;
})()"""
DRAG = """(() => {
  const canvas = byId("scene");
  const [left, bottom, right, top] = data.scene.view;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const scale = Math.min(width / (right - left), height / (top - bottom));
  const send = (kind, x, y) => {
    const event = new PointerEvent(kind, { bubbles: true });
    const offsetX = width / 2 + scale * (x - (left + right) / 2);
    const offsetY = height / 2 - scale * (y - (bottom + top) / 2);
    Object.defineProperties(event, { offsetX: { value: offsetX }, offsetY: { value: offsetY } });
    canvas.dispatchEvent(event);
  };
  canvas.setPointerCapture = () => {};
  send("pointerdown", bench.state[3], bench.state[4]);
  send("pointermove", 200, 150);
  send("pointerup", 200, 150);
})()"""


ROWS = (
    "[...byId('rows').querySelectorAll('tr')].slice(1)"
    ".map((row) => [...row.querySelectorAll('button')]"
)


@pytest.mark.slow
def test_predators_and_prey_in_a_browser(browser, tmp_path):
    experiment = config.load(ROOT / "data/experiments/predprey.ini")
    saved = np.load(ROOT / "data/genotypes/predprey/S12G300.npy")
    path, _ = written(experiment, tmp_path, saved=saved, name="generation 300")
    browser.errors.clear()
    browser.open(path)
    browser.wait("bench && game.step > 3")
    both = np.stack([saved[0], saved[10]]).astype(float)
    assert browser.run("[...bench.genotype]") == both.ravel().tolist()

    # against the random robots that seed 3 begins with, as `botschool tournament` lets them meet
    contest = Contest(experiment, seed=3)
    rivals = np.stack([contest.policy.initial(3, i).reshape(2, -1) for i in range(10)], axis=1)
    expected = [contest.meet(both[:1], rivals[1])[0], 1 - contest.meet(rivals[0], both[1:])[:, 0]]
    browser.wait(f"{ROWS}.length).join() === '10,10'")
    browser.run("setPlaying(false)")
    np.testing.assert_array_equal(np.array(browser.run("meetings()")), expected)
    shown = browser.run(f"{ROWS}.map((cell) => +cell.textContent))")
    np.testing.assert_allclose(shown, expected, atol=0.0051)
    browser.run("document.querySelectorAll('.meeting')[3].click()")
    assert browser.run("[...bench.genotype]") == [*both[0], *rivals[1][3]]
    browser.run("document.querySelectorAll('.meeting')[14].click()")
    assert browser.run("[...bench.genotype]") == [*rivals[0][4], *both[1]]
    browser.run("byId('home').click()")
    assert browser.run("[...bench.genotype]") == both.ravel().tolist()
    assert browser.errors == []


MODELS = """(async () => {
  const found = {};
  for (const [name, bytes] of Object.entries(modelFiles(result))) {
    const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
    found[name] = [...digest].map((x) => x.toString(16).padStart(2, "0")).join("");
  }
  return found;
})()"""


@pytest.mark.slow
def test_a_training_in_a_browser(browser, tmp_path):
    """CartPole by PPO, a part of the training that the command does by itself."""
    settings = replace(settings_of("CartPole-v1", 3), steps=10_000)
    run, found = training.learn(settings, tmp_path / "run", lambda steps, found: None)
    expected = {
        name: hashlib.sha256((run.path / name).read_bytes()).hexdigest()
        for name in ("best_model.npz", "last_model.npz")
    }
    write_training_page(tmp_path / "page.html", "CartPole-v1", 3, run.path / "best_model.npz")
    browser.errors.clear()
    browser.open(tmp_path / "page.html")
    browser.wait("bench && game.step > 0")
    best = files.make(settings)
    files.fill(best, run.path / "best_model.npz")
    assert browser.run("[...bench.genotype]") == best.parameters.astype(float).tolist()
    browser.run("byId('field-learning_rate').value = 'quick'; byId('evolve').click()")
    assert "learning_rate = quick is not possible" in browser.run("byId('said').textContent")
    browser.run("byId('field-learning_rate').value = 'linear 0.003'")
    browser.run("byId('field-steps').value = 10000; byId('evolve').click()")
    browser.wait("!byId('downloads').hidden")
    assert browser.run(MODELS) == expected
    assert browser.run("result.rows.slice(-3)[0]") == found.last
    assert browser.run("document.querySelectorAll('#downloads a').length") == 2
    assert browser.errors == []


@pytest.mark.slow
def test_the_first_picture_needs_no_core(browser, tmp_path):
    path, _ = written(experiment_of("CartPole-v1", "SSS"), tmp_path)
    before, _, rest = path.read_text().partition('<script id="core" type="text/plain">')
    path.write_text(f'{before}<script id="core" type="text/plain">AAAA{rest[rest.index("</") :]}')
    browser.open(path)
    browser.wait("!byId('trouble').hidden")
    assert browser.run("bench === null && shown.rows === 1")
    colours = "new Set(byId('scene').getContext('2d').getImageData(0, 0, 900, 500).data).size"
    assert browser.run(colours) > 3


@pytest.mark.slow
def test_in_a_browser(browser, tmp_path):
    experiment = experiment_of("ErDiscrim", "OpenAI-ES", maxsteps=200)
    expected = digests_of_the_command(experiment, 3, tmp_path / "run")
    path, _ = written(experiment, tmp_path)
    browser.errors.clear()
    browser.requests.clear()
    browser.resize(1280, 900)
    browser.open(path)
    browser.wait("bench && game.step > 2")

    # evolve to the end: the files are the command's
    browser.run("byId('evolve').click()")
    browser.wait("!byId('downloads').hidden")
    hashed = browser.run(HASH)
    assert hashed == expected
    assert browser.run("document.querySelectorAll('#downloads a').length") == 5

    # drag the cylinder
    browser.run("setPlaying(false)")
    before = browser.run("[...bench.state.slice(3, 5)]")
    browser.run(DRAG)
    after = browser.run("[...bench.state.slice(3, 5)]")
    assert after == pytest.approx([200, 150], abs=1) and after != before

    # blind a sensor by keyboard, heal
    browser.run("chips[2].made.focus(); chips[2].made.click()")
    assert browser.run("[...bench.blind]") == [0, 0, 1, 0, 0, 0, 0, 0]
    browser.run("chips[9].made.click()")
    assert browser.run("cuts.size") == 1
    browser.run("byId('heal').click()")
    assert browser.run("cuts.size + bench.blind.reduce((a, b) => a + b)") == 0
    assert browser.errors == []
    assert {url.partition(":")[0] for url in browser.requests} <= {"file", "data", "about", "blob"}


WALK = """({ id: document.activeElement.id, role: document.activeElement.className,
  name: document.activeElement.getAttribute("aria-label") || document.activeElement.innerText
    || document.activeElement.labels?.[0]?.innerText })"""
CONTROLS = """[...document.querySelectorAll(
  "button, input, select, summary, a[href], canvas[tabindex]")
].filter((one) => one.checkVisibility()).length"""


@pytest.mark.slow
def test_by_keyboard_alone(browser, tmp_path):
    """Every control is reached in order, has a name, and does what a click would do."""
    experiment = experiment_of("ErDiscrim", "OpenAI-ES", maxsteps=200, architecture=3)
    path, _ = written(experiment, tmp_path)
    browser.errors.clear()
    browser.resize(1280, 900)
    browser.open(path)
    browser.wait("bench && game.step > 2")
    enter, space = ("Enter", "\r"), (" ", " ")

    def focus(name):
        for _ in range(80):
            browser.press("Tab")
            if browser.run(WALK)["id"] == name:
                return
        raise AssertionError(f"the tabulator does not reach {name}")

    focus("scene")  # the first of all
    browser.press(*space)
    assert not browser.run("game.playing")
    count = browser.run(CONTROLS)
    reached = []
    for _ in range(count - 1):
        browser.press("Tab")
        reached.append(browser.run(WALK))
    assert all(one["name"] for one in reached), reached
    named = [one["id"] for one in reached if one["id"]]
    order = ["pause", "once", "again", "speed", "seed", "evolve", "freeze", "heal", "load"]
    assert [name for name in named if name in order] == order
    assert len([one for one in reached if one["role"] == "neuron"]) == browser.run("chips.length")
    browser.press("Tab")

    focus("freeze")
    browser.press(*enter)
    assert browser.run("byId('freeze').getAttribute('aria-pressed')") == "true"
    browser.run("chips[3].made.focus()")
    browser.press(*space)
    assert browser.run("[...bench.blind]") == [0, 0, 0, 1, 0, 0, 0, 0]
    focus("evolve")
    browser.press(*enter)
    browser.wait("!byId('downloads').hidden")
    assert browser.errors == []
