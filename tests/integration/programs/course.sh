#!/bin/sh
# course.sh CASE OUT SEED NOISE: a run whose numbers follow from the case and the seed, and with NOISE from the clock.
# Without NOISE it is one process: tests kill whatever they find below a worker, and a program that lost a part of
# itself would end in another way.
obstacles=0
while read -r line; do
  case $line in *'"length"'*) obstacles=$((obstacles + 1)) ;; esac
done < "$1"
noise=0
[ "$4" = 0 ] || noise=$(($(date +%N | sed 's/^0*//;s/^$/0/') % 97))
printf '{"items": %d, "obstacles": %d}\n' $((($3 + 7 * obstacles + noise) % 10)) "$obstacles" > "$2"
