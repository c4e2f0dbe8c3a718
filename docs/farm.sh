#!/bin/sh
# One picture by a Slurm array, each task a share of the samples:
#   sbatch --array=0-15 farm.sh SCENE FOLDER SAMPLES [OPTIONS OF RENDER]
#   sbatch --dependency=afterok:JOB farm.sh merge FOLDER IMAGE        (or on any machine: sh farm.sh merge FOLDER IMAGE)
# A task that is ended by its time limit, preempted or lost with its node is put back in the queue and goes on from its checkpoint.
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:TERM@60
set -eu
program=${GRELHA:-grelha}
if [ "$1" = merge ]; then
  exec "$program" merge "$2"/part-*.grelha -o "$3"
fi
scene=$1 folder=$2 samples=$3
shift 3
task=$((SLURM_ARRAY_TASK_ID - SLURM_ARRAY_TASK_MIN))
first=$((samples * task / SLURM_ARRAY_TASK_COUNT)) last=$((samples * (task + 1) / SLURM_ARRAY_TASK_COUNT))
part=$folder/part-$(printf %05d "$task")
mkdir -p "$folder"
if [ -e "$part.grelha" ]; then exit 0; fi
status=0
"$program" render "$scene" "$@" --samples "$first:$last/$samples" --threads "${SLURM_CPUS_PER_TASK:-1}" --quiet \
  -o "$part.grelha" --checkpoint "$part.kept" --checkpoint-every 300 &
trap 'kill -TERM $!' TERM
wait $! || status=$?
if [ $status -gt 128 ]; then wait $! && status=0 || status=$?; fi  # the trap cut the first wait short: this is the program's own status
if [ $status -eq 143 ] && [ -n "${SLURM_JOB_ID:-}" ]; then exec scontrol requeue "$SLURM_JOB_ID"; fi
exit $status
