# The log, the time limit, and the exit code for the master, which sees a job vanish when it has ended.
exec >>@LOGS@/@STEM@-"$job".log 2>&1 </dev/null || exit 2
rm -f @LOGS@/"$job".exit
export GAUNTLET_BATCH_JOB=$job
@SETUP@

trap 'kill -TERM "$child" 2>/dev/null' TERM USR1 USR2 INT
timeout --preserve-status -s TERM $((@SECONDS@ - @MARGIN@)) @COMMAND@ &
child=$!
wait "$child"
while kill -0 "$child" 2>/dev/null; do wait "$child"; done
wait "$child"
code=$?
echo "$code" >@LOGS@/"$job".exit
exit "$code"
