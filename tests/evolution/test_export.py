"""Controllers leave as files of other tools, and act there as our network does."""

import importlib.util
import shutil
import subprocess
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import botschool
from botschool.errors import BotschoolError
from botschool.interface.controller import Controller
from botschool.interface.export import export
from botschool.policies.hyperparameters import PolicyConfig
from botschool.policies.policy import Interface, Policy
from reference_network import policy_choices

STEPS = 5


@st.composite
def policies(draw):
    """A policy, a genotype, its normalisation, and what it does in some steps."""
    discrete = draw(st.booleans())
    bins = 1 if discrete else draw(st.sampled_from([1, 1, 3]))
    config = PolicyConfig(**draw(policy_choices()), nbins=bins)
    interface = Interface(draw(st.integers(1, 5)), draw(st.integers(1, 4)), discrete, -2.0, 3.0)
    interface = Interface(**{**vars(interface), "scaled": True})
    policy = Policy("Any", interface, config)
    rng = np.random.default_rng(draw(st.integers(0, 99)))
    vectors = np.append(
        rng.normal(size=policy.spec.inputs), rng.uniform(0.5, 3, policy.spec.inputs)
    )
    normalisation = vectors if policy.spec.normalize else None
    genotype = rng.normal(size=policy.genotype_size)
    observations = rng.normal(0, 2, (STEPS, policy.spec.inputs))
    policy.load(genotype, normalisation)
    policy.reset(1, 0)
    actions = np.array([np.ravel(policy.act(each)) for each in observations], float)
    return SimpleNamespace(
        controller=Controller(policy, genotype, normalisation),
        observations=observations,
        actions=actions,
    )


def by_python(path, case):
    spec = importlib.util.spec_from_file_location("exported", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    controller = module.Controller()
    return [np.ravel(controller.act(each)) for each in case.observations]


def by_c(path, case):
    c = case.controller
    rows = ",".join("{" + ",".join(map(repr, row.tolist())) + "}" for row in case.observations)
    main = path.with_name("main.c")
    main.write_text(
        f'#include <stdio.h>\n#include "{path.name}"\n'
        f"int main(void) {{ double seen[{STEPS}][{c.inputs}] = {{{rows}}}, action[{c.actions}];\n"
        f"{path.stem}_reset(); for (int t = 0; t < {STEPS}; ++t) {{"
        f" {path.stem}_act(seen[t], action);"
        f' for (int i = 0; i < {c.actions}; ++i) printf("%.17g ", action[i]);'
        "} return 0; }"
    )
    command = ["cc", "-std=c99", "-Wall", "-Werror", main, "-o", path.with_name("main"), "-lm"]
    subprocess.run(command, check=True)
    done = subprocess.run([path.with_name("main")], capture_output=True, text=True, check=True)
    return np.reshape([float(x) for x in done.stdout.split()], (STEPS, -1))


def by_steps(call, case):
    memory = [np.zeros((1, size), np.float32) for size in case.controller.memory.values()]
    actions = []
    for observation in case.observations:
        action, *memory = call([observation[None].astype(np.float32), *memory])
        actions.append(np.ravel(action))
    return actions


def by_onnx(path, case):
    from onnx.reference import ReferenceEvaluator

    session = ReferenceEvaluator(str(path))
    names = session.input_names
    return by_steps(lambda given: session.run(None, dict(zip(names, given, strict=True))), case)


def by_torch(path, case):
    import torch

    module = torch.jit.load(str(path))
    return by_steps(
        lambda given: [part.numpy() for part in module(*map(torch.tensor, given))], case
    )


@settings(deadline=None, derandomize=True, database=None, max_examples=40)
@given(case=policies())
def test_python_acts_alike(case, tmp_path_factory):
    path = export(case.controller, tmp_path_factory.mktemp("e") / "walker.py", "A walker.")
    np.testing.assert_allclose(by_python(path, case), case.actions, rtol=1e-6, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ending", "acts", "needs", "near"),
    [
        (".h", by_c, None, 1e-6),
        (".onnx", by_onnx, "onnx", 1e-5),
        (".pt", by_torch, "torch", 1e-5),
    ],
)
def test_files_of_other_tools_act_alike(ending, acts, needs, near, tmp_path_factory):
    if needs:
        pytest.importorskip(needs)
    elif not shutil.which("cc"):
        pytest.skip("no C compiler")

    @settings(deadline=None, derandomize=True, database=None, max_examples=25)
    @given(case=policies())
    def tried(case):
        path = export(case.controller, tmp_path_factory.mktemp("e") / f"walker{ending}", "")
        np.testing.assert_allclose(acts(path, case), case.actions, rtol=near, atol=near)

    tried()


def test_a_run_acts_and_leaves(tmp_path):
    run = botschool.evolve("CartPole-v1", steps=2000, samplesize=4, pepisodes=1)
    observation = np.array([0.01, 0.0, 0.02, 0.0])
    path = run.export(tmp_path / "pole.py")
    case = SimpleNamespace(observations=[observation])
    assert by_python(path, case)[0] == run.act(observation)
    with pytest.raises(BotschoolError, match=r"\.onnx"):
        run.export(tmp_path / "pole.txt")
