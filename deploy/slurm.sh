#!/bin/bash
# A run on several nodes of a SLURM cluster, by SLURM's own means: sbatch deploy/slurm.sh
# The first task of the job is scheduler, command and one worker; every node has a worker with all its cores.
# A job that ends before the run (--requeue, or sbatch again) goes on where it stopped.
#SBATCH --job-name=botschool
#SBATCH --nodes=4
#SBATCH --ntasks-per-node=1
#SBATCH --cpus-per-task=32
#SBATCH --time=24:00:00
#SBATCH --requeue
#SBATCH --signal=B:USR1@60
#SBATCH --output=botschool-%j.log
set -euo pipefail

EXPERIMENT=${EXPERIMENT:-data/experiments/hopper.ini}
SEED=${SEED:-1}
RESULTS=${RESULTS:-results/hopper}
# Made once: sh deploy/certificates.sh ~/botschool-tls, in a home folder that all nodes share
export DASK_CONFIG=${DASK_CONFIG:-$HOME/botschool-tls}
# The network of the nodes, as ib0; without, the one that leads outside
interface=${INTERFACE:+--interface $INTERFACE}
# The environment in which `pip install 'botschool[cluster]'` was run
source "${VENV:-.venv}/bin/activate"

file=$PWD/.scheduler-$SLURM_JOB_ID.json
space=${SLURM_TMPDIR:-${TMPDIR:-/tmp}}
trap 'rm -f "$file"; kill $(jobs -p) 2>/dev/null || true' EXIT

# shellcheck disable=SC2086
dask scheduler --protocol tls --port 0 $interface --dashboard-address 127.0.0.1:0 --scheduler-file "$file" &
until [ -s "$file" ]; do sleep 1; done
# shellcheck disable=SC2086
srun --kill-on-bad-exit=0 dask worker --scheduler-file "$file" $interface --nworkers 1 \
    --nthreads "$SLURM_CPUS_PER_TASK" --local-directory "$space" --no-dashboard --death-timeout 300 &

botschool es -f "$EXPERIMENT" -s "$SEED" -o "$RESULTS" --resume --cluster "$file" &
command=$!
# SLURM's warning a minute before the end: the command saves and ends, as with Ctrl-C, and the job is queued again
stopped=
trap 'stopped=yes; kill -TERM $command' USR1
code=0
wait $command || code=$?
if [ -n "$stopped" ]; then
    code=0
    wait $command || code=$?
    [ $code -ne 130 ] || scontrol requeue "$SLURM_JOB_ID"
fi
exit $code
