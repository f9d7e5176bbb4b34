#!/bin/sh
# course.sh CASE OUT SEED NOISE: a run whose numbers follow from the case and the seed, and with NOISE from the clock.
obstacles=$(grep -c '"length"' "$1")
noise=0
[ "$4" = 0 ] || noise=$(($(date +%N | sed 's/^0*//;s/^$/0/') % 97))
printf '{"items": %d, "obstacles": %d}\n' $((($3 + 7 * obstacles + noise) % 10)) "$obstacles" > "$2"
