"""The files of deploy/, as far as one machine can tell: they are parsed, their commands exist with
these options, and the SLURM job runs with a stand-in for srun.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import click
import pytest
import yaml

from clusters import ROOT, Cluster, certificates, registered
from running import call, finish, one_sentence, same, start, write_experiment

pytest.importorskip("distributed")

pytestmark = pytest.mark.slow
DEPLOY = ROOT / "deploy"
posix = pytest.mark.skipif(sys.platform == "win32", reason="scripts of the shell")


def documents(name):
    """The parts of a YAML file."""
    return list(yaml.safe_load_all((DEPLOY / name).read_text()))


def understood(words):
    """Asserts that a command line of dask or botschool has options that exist."""
    from distributed.cli.dask_scheduler import main as scheduler
    from distributed.cli.dask_worker import main as worker
    from typer.main import get_command

    from botschool.cli.es import app

    commands = {
        ("dask", "scheduler"): scheduler,
        ("dask", "worker"): worker,
        ("botschool", "es"): get_command(app),
    }
    words = [re.sub(r"^\$\(\w+\)$", "name", str(word)) for word in words]
    try:
        commands[tuple(words[:2])].make_context(words[1], words[2:], resilient_parsing=False)
    except click.exceptions.Exit:
        pytest.fail(f"{words} only prints its help")


def containers(document):
    """All containers of a Kubernetes object, wherever they are."""
    if isinstance(document, dict):
        yield from document.get("containers", [])
        for value in document.values():
            yield from containers(value)


@pytest.mark.parametrize("name", ["kubernetes.yaml", "daskcluster.yaml"])
def test_manifests(name):
    found = documents(name)
    assert all({"apiVersion", "kind", "metadata", "spec"} == each.keys() for each in found)
    ran = [container["args"] for each in found for container in containers(each)]
    for words in ran:
        understood(words)
    assert {tuple(words[:2]) for words in ran} >= {("dask", "scheduler"), ("dask", "worker")}
    for each in found:
        for container in containers(each):
            mounted = {mount["name"] for mount in container["volumeMounts"]}
            assert "tls" in mounted
            assert {"name": "DASK_CONFIG", "value": "/tls"} in container["env"]


def test_deployments_select_their_own_pods_and_the_service_the_scheduler():
    found = {
        (each["kind"], each["metadata"]["name"]): each["spec"]
        for each in documents("kubernetes.yaml")
    }
    for (kind, _), spec in found.items():
        if kind == "Deployment":
            assert spec["selector"]["matchLabels"] == spec["template"]["metadata"]["labels"]
    scheduler = found["Deployment", "botschool-scheduler"]["template"]["metadata"]["labels"]
    assert found["Service", "botschool-scheduler"]["selector"] == scheduler


def test_the_compose_file():
    [compose] = documents("compose.yaml")
    services = compose["services"]
    assert services["worker"]["deploy"]["replicas"] == 2
    for name in ("scheduler", "worker"):
        understood(services[name]["command"].split())
    understood([*services["es"]["entrypoint"], "-f", "x.ini"])
    assert (DEPLOY / services["scheduler"]["build"]["context"]).resolve() == ROOT
    assert (ROOT / services["scheduler"]["build"]["dockerfile"]).is_file()
    assert all(port.startswith("127.0.0.1:") for port in services["scheduler"]["ports"])


def test_the_dockerfile_copies_what_exists():
    lines = (DEPLOY / "Dockerfile").read_text().splitlines()
    copied = [
        line.split()[1:-1] for line in lines if line.startswith("COPY") and "--from" not in line
    ]
    assert copied and all((ROOT / source).exists() for sources in copied for source in sources)
    assert any("botschool[cluster" in line and ",pybullet" in line for line in lines)


@posix
@pytest.mark.parametrize("name", ["certificates.sh", "slurm.sh"])
def test_scripts_of_the_shell(name):
    shell = (DEPLOY / name).read_text().split("\n", 1)[0].removeprefix("#!")
    subprocess.run([shell, "-n", DEPLOY / name], check=True)


def test_the_script_for_dask_jobqueue_says_what_it_takes():
    done = subprocess.run(
        [sys.executable, DEPLOY / "slurm.py", "--help"], capture_output=True, text=True, check=True
    )
    assert "--walltime" in done.stdout


SRUN = """#!/bin/sh
# stands in for srun: two nodes are two processes here
while [ "${1#--}" != "$1" ]; do shift; done
"$@" & "$@" & wait
"""


@pytest.mark.long
@posix
@pytest.mark.skipif(not shutil.which("openssl"), reason="openssl makes the certificates")
def test_the_slurm_job_runs(tmp_path):
    """By TLS, with a stand-in for srun and the loopback in the place of the nodes' network."""
    tls = certificates(tmp_path / "tls")
    ini = write_experiment(tmp_path, "CartPole-v1", "OpenAI-ES")
    assert call("es", "-f", ini, "-s", 5, "-o", tmp_path / "w1")[0] == 0
    binaries = tmp_path / "bin"
    binaries.mkdir()
    (binaries / "srun").write_text(SRUN)
    (binaries / "srun").chmod(0o755)
    environment = os.environ | {
        "PATH": f"{binaries}:{os.environ['PATH']}",
        "EXPERIMENT": str(ini),
        "SEED": "5",
        "RESULTS": str(tmp_path / "slurm"),
        "DASK_CONFIG": str(tls),
        "INTERFACE": "lo",
        "VENV": str(Path(sys.executable).parents[1]),
        "SLURM_JOB_ID": "7",
        "SLURM_CPUS_PER_TASK": "1",
    }
    done = subprocess.run(
        ["bash", DEPLOY / "slurm.sh"],
        cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert same(tmp_path / "w1", tmp_path / "slurm")
    assert not (tmp_path / ".scheduler-7.json").exists()


# --- Clusters with TLS by Dask's own settings: who has what deploy/certificates.sh made gets in.


needs_openssl = pytest.mark.skipif(
    sys.platform == "win32" or not shutil.which("openssl"),
    reason="a script of the shell, in which openssl makes the certificates",
)


@pytest.fixture(scope="module")
def tls(tmp_path_factory):
    return certificates(tmp_path_factory.mktemp("tls"))


@needs_openssl
def test_a_run_by_tls_and_who_is_refused(tls, tmp_path):
    """The same files; no certificate, or one of another authority, opens nothing."""
    ini = write_experiment(tmp_path, "CartPole-v1", "OpenAI-ES")
    arguments = ("es", "-f", ini, "-s", 5)
    assert call(*arguments, "-o", tmp_path / "w1")[0] == 0
    strangers = certificates(tmp_path / "strangers")
    with Cluster(tmp_path / "cluster", tls) as cluster:
        assert cluster.address.startswith("tls://")
        worker = cluster.start_worker()
        stranger = cluster.start_worker("--death-timeout", 5, DASK_CONFIG=str(strangers))
        registered(worker)
        here = ("--cluster", cluster.address)
        done = start(*arguments, "-o", tmp_path / "tls", *here, env=cluster.environment)
        code, out, errors = finish(done)
        assert code == 0, errors
        assert "worker tls://127.0.0.1" in out
        assert same(tmp_path / "w1", tmp_path / "tls")

        for environment in (
            cluster.environment | {"DASK_CONFIG": str(strangers)},
            cluster.environment | {"DASK_CONFIG": str(tmp_path)},
        ):
            refused = start(*arguments, "-o", tmp_path / "no", *here, env=environment)
            code, _, errors = finish(refused)
            one_sentence(code, errors, [cluster.address, "certificate"])
        plain = start(
            *arguments, "-o", tmp_path / "no", "--cluster", cluster.address.replace("tls", "tcp")
        )
        code, _, errors = finish(plain)
        one_sentence(code, errors, "tcp://")
        assert not (tmp_path / "no").exists()
        stranger.process.wait(60)
        assert "Registered to" not in stranger.log


@needs_openssl
@pytest.mark.parametrize(
    "address", ["tcp://192.0.2.7:8786", "192.0.2.7:8786", "tcp://[2001:db8::7]:8786"]
)
def test_other_machines_without_tls_are_refused(address, refused, tmp_path):
    """Before anything is sent to them: these addresses exist nowhere."""
    ini = write_experiment(tmp_path)
    refused("es", "-f", ini, "-o", tmp_path / "run", "--cluster", address, says=["tls://"])
    assert not (tmp_path / "run").exists()


@needs_openssl
def test_the_script_keeps_what_is_there(tls):
    before = (tls / "cert.pem").read_bytes()
    settings = (tls / "dask.yaml").read_text()
    (tls / "dask.yaml").unlink()
    certificates(tls)
    assert (tls / "cert.pem").read_bytes() == before
    assert (tls / "dask.yaml").read_text() == settings
    assert {path.name for path in tls.iterdir()} == {"ca.pem", "cert.pem", "key.pem", "dask.yaml"}
    assert all(path.stat().st_mode & 0o077 == 0 for path in tls.iterdir())
