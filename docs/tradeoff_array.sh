#!/bin/sh
# A trade-off sweep as a Slurm job array: every task measures one shard, and a last job joins them.
#
#   PARAFOVEA=/path/to/build/parafovea sh docs/tradeoff_array.sh 8 /shared/sweep --scenes atrium,primitives --sizes 1280x1440@76.7
#
# First the number of shards, then the folder for the results (all nodes see it), then options of `parafovea
# tradeoff`. A task that was killed or ran out of time goes on where it stopped when the script is run again.
# `parafovea power PROTOCOL --participants ... --shard I/N` runs the same way: put `power` for `tradeoff` below.
set -eu

shards=$1
out=$2
shift 2
mkdir -p "$out"
cp "${PARAFOVEA:?set PARAFOVEA to the program}" "$out/parafovea" # so that a rebuild in the meantime changes nothing

# Frames are timed: a task has its node for itself, and all nodes should be alike.
task='exec "$0"/parafovea tradeoff --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --out "$0/shard_$SLURM_ARRAY_TASK_ID" "$@"'
join='exec "$0"/parafovea tradeoff --merge "$0"/shard_*/ --out "$0/all"'

quote() { # each argument in single quotes, for --wrap
    for word; do printf " '%s'" "$(printf %s "$word" | sed "s/'/'\\\\''/g")"; done
}

array=$(sbatch --parsable --job-name=tradeoff --array="1-$shards" --exclusive --requeue \
    --output="$out/shard_%a.log" --wrap="sh -c $(quote "$task" "$out" "$@" --quiet)")
sbatch --parsable --job-name=tradeoff_merge --dependency="afterok:$array" \
    --output="$out/all.log" --wrap="sh -c $(quote "$join" "$out")"
