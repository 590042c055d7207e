"""Workers from a SLURM queue by dask-jobqueue: each is a job of its own, as many as there is room.

    pip install dask-jobqueue
    python deploy/slurm.py --cores 32 --jobs 10 -- -f hopper.ini -s 1 -o results/hopper

Run it where jobs may be submitted from, as on a login node, in `tmux` or the like: the scheduler
and the command `botschool es` are its processes. Jobs may start late, end early or be pre-empted:
the run goes on with those that are there. Killed itself, it goes on by the same command, as it adds
--resume. Certificates are those of Dask's settings (DASK_CONFIG, see deploy/certificates.sh).
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys


def main() -> int:
    parser = argparse.ArgumentParser(description="botschool es on workers from a SLURM queue")
    parser.add_argument("--jobs", type=int, default=4, help="workers, each a job")
    parser.add_argument("--cores", type=int, default=16, help="of a job")
    parser.add_argument("--memory", default="16GB", help="of a job")
    parser.add_argument("--walltime", default="04:00:00", help="of a job")
    parser.add_argument("--queue", help="SLURM's partition")
    parser.add_argument("--account", help="who is charged")
    parser.add_argument("--interface", help="network of the nodes, as ib0")
    parser.add_argument("--print-job", action="store_true", help="print a job's script, and end")
    parser.add_argument("es", nargs=argparse.REMAINDER, help="after --: arguments of botschool es")
    options = parser.parse_args()

    from dask_jobqueue import SLURMCluster
    from distributed import Security

    cluster = SLURMCluster(
        queue=options.queue,
        account=options.account,
        cores=options.cores,
        processes=1,  # one worker a job: its threads share a native evaluation
        memory=options.memory,
        walltime=options.walltime,
        interface=options.interface,
        protocol="tls",
        security=Security(),  # as Dask's settings say
        job_extra_directives=["--requeue"],
        job_script_prologue=[f"export DASK_CONFIG={os.environ.get('DASK_CONFIG', '')}"],
        scheduler_options={"dashboard_address": "127.0.0.1:0"},
    )
    if options.print_job:
        print(cluster.job_script())
        return 0
    cluster.adapt(minimum_jobs=1, maximum_jobs=options.jobs)
    arguments = [each for each in options.es if each != "--"]
    command = ["botschool", "es", *arguments, "--resume", "--cluster", cluster.scheduler_address]
    return subprocess.run([sys.executable, "-m", *command], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
