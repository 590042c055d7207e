"""Clusters with TLS by Dask's own settings: who has what deploy/certificates.sh made gets in."""

import shutil
import sys

import pytest

from clusters import Cluster, certificates, registered
from running import call, finish, one_sentence, same, start, write_experiment

pytest.importorskip("distributed")
pytestmark = [
    pytest.mark.skipif(sys.platform == "win32", reason="a script of the shell"),
    pytest.mark.skipif(not shutil.which("openssl"), reason="openssl makes the certificates"),
]


@pytest.fixture(scope="module")
def tls(tmp_path_factory):
    return certificates(tmp_path_factory.mktemp("tls"))


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


@pytest.mark.parametrize(
    "address", ["tcp://192.0.2.7:8786", "192.0.2.7:8786", "tcp://[2001:db8::7]:8786"]
)
def test_other_machines_without_tls_are_refused(address, refused, tmp_path):
    """Before anything is sent to them: these addresses exist nowhere."""
    ini = write_experiment(tmp_path)
    refused("es", "-f", ini, "-o", tmp_path / "run", "--cluster", address, says=["tls://"])
    assert not (tmp_path / "run").exists()


def test_the_script_keeps_what_is_there(tls):
    before = (tls / "cert.pem").read_bytes()
    settings = (tls / "dask.yaml").read_text()
    (tls / "dask.yaml").unlink()
    certificates(tls)
    assert (tls / "cert.pem").read_bytes() == before
    assert (tls / "dask.yaml").read_text() == settings
    assert {path.name for path in tls.iterdir()} == {"ca.pem", "cert.pem", "key.pem", "dask.yaml"}
    assert all(path.stat().st_mode & 0o077 == 0 for path in tls.iterdir())
