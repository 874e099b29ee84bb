#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# slurm_array.sh PROGRAM SCRIPT WORK: runs a sweep as one share and as four, one of which is killed half-way and queued again.
# Both must give the same meshes, and no finished cell may be lost or made twice.
set -eu
program=$1 script=$2 work=$3

PATH=$PATH:/usr/sbin:/sbin
for tool in slurmctld slurmd sbatch; do
  command -v $tool >/dev/null || { echo "skipped: slurm-wlm: there is no program $tool"; exit 77; }
done

rm -rf "$work"
mkdir -p "$work/state" "$work/spool" "$work/log"
host=$(hostname -s)
user=$(id -un)
port=$((20000 + $$ % 20000))
cat >"$work/slurm.conf" <<CONF
ClusterName=delquad
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,batch_sched_delay=1
SlurmdParameters=config_overrides
KillWait=1
ReturnToService=2
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/log/slurmctld.log
SlurmdLogFile=$work/log/slurmd.log
NodeName=$host NodeAddr=127.0.0.1 CPUs=4 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES State=UP
CONF
export SLURM_CONF="$work/slurm.conf" DELQUAD="$program"

fail() {
  echo "$1" >&2
  tail -n 20 "$work"/log/* >&2
  exit 1
}
stop() {
  scancel --user "$user" 2>/dev/null || true
  kill $controller $node 2>/dev/null || true
  wait
}
slurmctld -D -i >/dev/null 2>&1 &
controller=$!
slurmd -D -N "$host" >/dev/null 2>&1 &
node=$!
trap stop EXIT INT TERM

# until SECONDS COMMAND: waits for the command to succeed.
until_true() {
  left=$(($1 * 5)) what=$2
  while ! sh -c "$what"; do
    left=$((left - 1))
    [ $left -gt 0 ] || fail "waited in vain for: $what"
    sleep 0.2
  done
}
up=0
for _ in $(seq 300); do
  sinfo -h -o %t 2>/dev/null | grep -q idle && up=1 && break
  sleep 0.2
done
if [ $up -eq 0 ]; then # some containers do not let a node start
  reason=$(tail -q -n 1 "$work"/log/* 2>/dev/null | tr '\n' ' ' || true)
  echo "skipped: Slurm does not come up on this machine: $reason"
  exit 77
fi

cat >"$work/sweep.toml" <<'TOML'
title = "Turned squares"
pipelines = ["F", "DB"]
[matrix]
seed = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20]
[[case]]
name = "square"
loop = { rectangle = [[0, 0], [1, 1]] }
size = 0.01
TOML
records() { find "$work/$1" -name record.json | wc -l; }
# submit ARRAY FOLDER: the job's number.
submit() {
  sbatch --parsable --array="$1" --output="$work/log/$2-%a.out" "$script" "$work/sweep.toml" "$work/$2"
}
finished() { until_true 300 "! squeue -h -j $1 2>/dev/null | grep -q ."; }

finished "$(submit 0 whole)"
[ "$(records whole)" -eq 40 ] || fail "one share made $(records whole) cells of 40"

job=$(submit 1-7:2 shared)
mkdir -p "$work/shared"
until_true 120 "[ \$(find '$work/shared' -name record.json | wc -l) -ge 6 ]"
scontrol requeue "${job}_3"
until_true 60 "squeue -h -j ${job}_3 -o %t | grep -q PD"
find "$work/shared" -name record.json -exec stat -c '%n %i %y' {} + | sort >"$work/before"
[ "$(wc -l <"$work/before")" -lt 40 ] || fail "all was done before a job could be killed"
scontrol update "JobId=${job}_3" StartTime=now+3 # Slurm would wait two minutes
finished "$job"
find "$work/shared" -name record.json -exec stat -c '%n %i %y' {} + | sort >"$work/after"

[ "$(records shared)" -eq 40 ] || fail "four shares made $(records shared) cells of 40"
[ -z "$(comm -23 "$work/before" "$work/after")" ] || fail "finished cells were lost or made anew"
(cd "$work/whole" && find . -name mesh.msh) | while read -r mesh; do
  cmp "$work/whole/$mesh" "$work/shared/$mesh"
done || fail "meshes differ"
for folder in whole shared; do
  "$program" tables "$work/$folder" >"$work/$folder.table" || fail "no table of $folder"
  # Without the column of seconds and what follows it.
  sed -n '/^| *case/,/^$/p' "$work/$folder.table" | sed 's/|[^|]*| *$//' >"$work/$folder.rows"
done
cmp "$work/whole.rows" "$work/shared.rows" || fail "tables differ"
grep -q square "$work/whole.rows" || fail "the table is empty"
