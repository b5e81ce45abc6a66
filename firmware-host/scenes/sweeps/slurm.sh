#!/bin/sh
# A sweep as a Slurm job array: sbatch slurm.sh SWEEP.toml FOLDER
# Every task runs its part of the sweep into one folder that all nodes see. A task that is stopped, by its limit of time or
# by a node, is started again as it was and goes on: sbatch --array=3 asks for another division, so name the part then, as
# firmware-host sweep SWEEP.toml --out FOLDER --shard 3/16.
# When all are done, this puts the parts together, without running anything that is there:
#   firmware-host sweep SWEEP.toml --out FOLDER
#SBATCH --job-name=sweep
#SBATCH --array=1-16
#SBATCH --cpus-per-task=4
#SBATCH --mem=1G
#SBATCH --time=04:00:00
#SBATCH --requeue
set -eu
exec firmware-host sweep "$1" --out "$2" --shard slurm --threads "${SLURM_CPUS_PER_TASK:-1}"
