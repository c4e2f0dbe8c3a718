#!/bin/sh
# One picture by a Slurm array, each task a share of the samples:
#   sbatch --array=0-15 farm.sh SCENE FOLDER SAMPLES [OPTIONS OF RENDER]
#   sbatch --array=3 farm.sh THE SAME                                 (task 3 of them again)
#   sbatch --dependency=afterok:JOB farm.sh merge FOLDER IMAGE
#   sh farm.sh merge FOLDER IMAGE                                     (or so, on any machine)
# A task that is ended by its time limit, preempted or lost with its node is put back in the queue
# and goes on from its checkpoint.
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:TERM@60
set -eu
program=${GRELHA:-grelha}
refuse() { echo "farm.sh: error: $1" >&2; exit 2; }
if [ "${1:-}" = merge ] && [ $# -eq 3 ]; then
  exec "$program" merge "$2"/part-*.grelha -o "$3"
fi
if [ $# -lt 3 ] || [ -z "${SLURM_ARRAY_TASK_ID:-}" ]; then
  refuse "usage: sbatch --array=0-15 farm.sh SCENE FOLDER SAMPLES [OPTIONS OF RENDER];\
 then sh farm.sh merge FOLDER IMAGE"
fi
scene=$1 folder=$2 samples=$3
shift 3
mkdir -p "$folder"
# The first array says how many shares there are; a later one, of a few of its tasks, must not share
# anew.
if [ ! -e "$folder/tasks" ]; then
  step=${SLURM_ARRAY_TASK_STEP:-1}
  [ $((SLURM_ARRAY_TASK_MIN + step * (SLURM_ARRAY_TASK_COUNT - 1))) -eq "$SLURM_ARRAY_TASK_MAX" ] ||
    refuse 'the first array of a folder has no gaps'
  echo "$SLURM_ARRAY_TASK_MIN $step $SLURM_ARRAY_TASK_COUNT" >"$folder/tasks.$SLURM_ARRAY_TASK_ID"
  # all tasks write the same, and each finds a whole one
  mv "$folder/tasks.$SLURM_ARRAY_TASK_ID" "$folder/tasks"
fi
read -r least step count <"$folder/tasks"
task=$(((SLURM_ARRAY_TASK_ID - least) / step))
if [ $((least + step * task)) -ne "$SLURM_ARRAY_TASK_ID" ] ||
  [ "$task" -lt 0 ] || [ "$task" -ge "$count" ]; then
  last=$((least + step * (count - 1)))
  refuse "task $SLURM_ARRAY_TASK_ID is none of those $folder was begun with, $least to $last"
fi
first=$((samples * task / count)) last=$((samples * (task + 1) / count))
if [ $first -eq $last ]; then exit 0; fi  # more tasks than samples
part=$folder/part-$(printf %05d "$task")
# A finished part is a checkpoint with nothing left to do: of another scene or other options it is
# refused by name, else written again.
if [ -e "$part.grelha" ]; then mv "$part.grelha" "$part.kept"; fi
status=0
"$program" render "$scene" "$@" --samples "$first:$last/$samples" \
  --threads "${SLURM_CPUS_PER_TASK:-1}" --quiet \
  -o "$part.grelha" --checkpoint "$part.kept" --checkpoint-every 300 &
trap 'kill -TERM $!' TERM
wait $! || status=$?
# where the trap cut the first wait short, the second has the program's own status
if [ $status -gt 128 ]; then wait $! && status=0 || status=$?; fi
if [ $status -eq 143 ] && [ -n "${SLURM_JOB_ID:-}" ]; then exec scontrol requeue "$SLURM_JOB_ID"; fi
exit $status
