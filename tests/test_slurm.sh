#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# sweep --slurm on a Slurm of one node, started here by whoever runs the test.
. tests/harness.sh
B=$(cd "$B" && pwd)
PATH=$PATH:/usr/sbin

missing=
for program in sbatch scontrol slurmctld slurmd munged; do
  command -v $program >/dev/null || missing+=" $program"
done
if [[ -n $missing ]]; then
  echo "skipped: Slurm, of which are not installed:$missing"
  pass
  check_done
  exit
fi
here=$PWD
cd "$T" || exit 1
chmod 755 . # munged wants to know who can write to its folder
host=$(hostname -s) user=$(id -un)
export SLURM_CONF=$T/slurm.conf
port=$((20000 + $$ % 10000 * 2))
cat >"$SLURM_CONF" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$T/munge.socket
SlurmctldPort=$port
SlurmdPort=$((port + 1))
StateSaveLocation=$T/state
SlurmdSpoolDir=$T/spool
SlurmctldPidFile=$T/slurmctld.pid
SlurmdPidFile=$T/slurmd.pid
SlurmctldLogFile=$T/slurmctld.log
SlurmdLogFile=$T/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_res
SelectTypeParameters=CR_CPU
MpiDefault=none
MaxArraySize=5
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=100 State=UNKNOWN
PartitionName=test Nodes=$host Default=YES State=UP
END
mkdir state spool
head -c 128 /dev/urandom >munge.key
chmod 600 munge.key
slurm_end() {
  local file
  for file in slurmd slurmctld munged; do
    [[ ! -s $T/$file.pid ]] || kill "$(cat "$T/$file.pid")" 2>/dev/null
  done
  sleep 0.2
  rm -rf "$T"
}
trap slurm_end EXIT
{
  munged --force --key-file="$T/munge.key" --socket="$T/munge.socket" \
    --pid-file="$T/munged.pid" --log-file="$T/munged.log" \
    --seed-file="$T/munged.seed" && slurmctld -c && slurmd -c
} >log 2>&1
for ((k = 0; k < 100; k++)); do
  [[ $(sinfo -h -o %t 2>/dev/null) != idle ]] || break
  sleep 0.1
done
if [[ $(sinfo -h -o %t 2>/dev/null) != idle ]]; then
  echo "skipped: Slurm, which did not start here: $(tail -n 1 log)"
  pass
  cd "$here" || exit 1
  check_done
  exit
fi

# eight runs, in an array of at most five jobs
printf '%s\n' seed {1..8} >runs.tsv
tiny='--count 12 --base 0.5,0.5 --drop 0.2 --time 0.4'
timeout 60 "$B/sweep" --settle "$tiny" runs.tsv >wanted
timeout 60 "$B/sweep" --slurm --settle "$tiny" --jobs 2 runs.tsv >out 2>err
check 'exit status' test $? = 0
check 'the same table as without Slurm' cmp -s out wanted
check 'eight rows' test "$(wc -l <out)" = 9
check 'nothing is left' test ! -e runs.sweep
printf 'seed\tfriction\n1\t-1\n2\t0\n' >fail.tsv
timeout 60 "$B/sweep" --slurm --settle "$tiny" --jobs 0 fail.tsv >out 2>err
check 'a run that fails' test $? = 4
check 'is a row' test "$(cut -f 3 out | tr '\n' ' ')" = 'status 2 0 '
timeout 60 "$B/sweep" --slurm --sbatch --nonsense runs.tsv >out 2>err
check 'an option that sbatch does not know' test $? = 1
check 'says so' grep -q nonsense err

# ended in the middle: no job is left, and the same command goes on
printf '%s\t%s\n' seed time 1 0.1 2 0.1 3 0.1 4 100000 >long.tsv
"$B/sweep" --slurm --settle '--count 8 --base 0.4,0.4' --jobs 2 long.tsv \
  >out 2>err </dev/null &
pid=$!
for ((k = 0; k < 300; k++)); do
  (($(find long.sweep -name '*.row' 2>/dev/null | wc -l) < 3)) || break
  sleep 0.1
done
kill -TERM $pid
wait $pid
check 'SIGTERM: exit status 5' test $? = 5
for ((k = 0; k < 100; k++)); do
  [[ -n $(squeue -h 2>/dev/null) ]] || break
  sleep 0.1
done
check 'no job is left' test -z "$(squeue -h 2>&1)"
check 'three runs were done' test "$(find long.sweep -name '*.row' | wc -l)" = 3
cd "$here" || exit 1
check_done
