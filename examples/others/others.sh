#!/usr/bin/env bash
# Tests controllers that others wrote for ARGoS: adopts their projects, looks for what breaks them, and makes that
# small; where a controller also compiles for Gauntlet's own engine, compares searches there and holds what they find
# against ARGoS. README.md says what is needed and what is written.
#
# Usage: examples/others/others.sh PROJECTS OUT [NAME...]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

# name | repository | folder of start | scene | seconds | score | searched runs
rows() {
  cat <<'ROWS'
flocking|ilpincy/argos3-examples|.|experiments/flocking.argos|240|displacement|300
push-pull|andraspatka/q-swarm|experiments|scenes/push_pull.argos|60|displacement|300
foraging|ilpincy/argos3-examples|.|experiments/foraging.argos|150|csv:foraging.txt:4|300
central-place|BCLab-UNM/CPFA-ARGoS|.|experiments/CPFAExample.xml|601|log:^[-+.0-9eE]+, ([-+.0-9eE]+)$|300
transport|aparwal/Occlusion_with_obstacles|.|experiments/occlusion.argos|300|displacement|100
ROWS
}

say() { printf '%s\n' "others: $*"; }
die() { say "$*" >&2; exit 2; }

# once DIR COMMAND...: nothing where it has ended before, where it was stopped it goes on.
once() {
  local dir=$1
  shift
  [[ -e $dir.done ]] && return
  if [[ -d $dir ]]; then gauntlet resume "$dir" --quiet; else "$@" --dir "$dir" --quiet; fi >/dev/null
  touch "$dir.done"
}

# library OUT FLAGS SOURCES...: as the project's own files for CMake do, some of which ask for an older ARGoS.
library() {
  local out=$1 flags=$2 prefix
  shift 2
  prefix=$(dirname "$(dirname "$(command -v argos3)")")
  mkdir -p "$(dirname "$out")"
  # shellcheck disable=SC2086 # flags are several words
  "${CXX:-c++}" -std=c++17 -O2 -w -shared -fPIC $flags -I. "-I$prefix/include" -I/usr/include/lua5.3 "$@" -o "$out"
}

# In the project's copy: what its scene loads, and a scene whose obstacles are the search's own.
prepare() {
  case $1 in
    flocking)
      library build/controllers/footbot_flocking/libfootbot_flocking.so "" controllers/footbot_flocking/*.cpp
      # By (-6.7, -3.6): the origin lies between start and light then, as in flocking.toml.
      sed -i 's/min="4,4,0" max="5,5,0"/min="-2.7,0.4,0" max="-1.7,1.4,0"/
              s/position="8.9,2.7,0.5"/position="2.2,-0.9,0.5"/' "$2" ;;
    push-pull)
      library cmake-build-debug/controllers/push_pull/libfootbot_push_pull.so "" controllers/push_pull/*.cpp
      python3 - "$2" <<'PY'
import sys
import xml.etree.ElementTree as tree
scene = tree.parse(sys.argv[1])
arena = scene.find("arena")
for one in list(arena):  # its ten random obstacles, and its wall
    kinds = {inside.tag for inside in one.iter()}
    if one.get("id") == "wall_obstacle" or one.tag == "distribute" and kinds & {"box", "cylinder"}:
        arena.remove(one)
scene.write(sys.argv[1])
PY
      ;;
    foraging)
      library build/controllers/footbot_foraging/libfootbot_foraging.so "" controllers/footbot_foraging/*.cpp
      library build/loop_functions/foraging_loop_functions/libforaging_loop_functions.so "" \
        loop_functions/foraging_loop_functions/foraging_loop_functions.cpp ;;
    central-place)
      library build/source/CPFA/libCPFA_controller.so '-DGIT_BRANCH="" -DGIT_COMMIT_HASH=""' \
        source/Base/*.cpp source/CPFA/CPFA_controller.cpp source/CPFA/CPFA_loop_functions.cpp
      library build/source/CPFA/libCPFA_loop_functions.so "" source/CPFA/CPFA_loop_functions.cpp
      sed -i 's/MaxSimTimeInSeconds = "3600"/MaxSimTimeInSeconds = "600"/' "$2" ;;
    transport)
      library build/controllers/footbot_occlusion/libfootbot_occlusion.so "" controllers/footbot_occlusion/*.cpp ;;
  esac
}

# How well the swarm did: as in the file for our own engine, whose formulas are over the same measures; of transport, how
# far towards the light it ended, (3.5, 3.5); else by the score that was seen. Where no cells are given, all failures are
# of one kind: scores and places of these swarms hardly repeat.
judge() {
  local key cells='cells = "displacement:0:100:1"'
  if [[ $1 == transport ]]; then
    sed -i 's/^fitness = .*/fitness = "center_x + center_y"/; s/^failure = .*/failure = "center_x + center_y < 3"/' "$2"
  elif [[ -e $here/$1.toml ]]; then
    for key in fitness failure; do
      sed -i "s/^$key = .*/$(grep "^$key = " "$here/$1.toml" | sed 's/[&/]/\\&/g')/" "$2"
    done
    cells=$(grep '^cells = ' "$here/$1.toml")
    printf '\n[[command.metric]]\nname = "dispersion"\nfrom = "trajectory:dispersion"\n' >> "$2"
  fi
  sed -i "/^\[search\]/a $cells" "$2"
}

# confirmed DIR N: the runs of at most N confirmed cases, the toughest and of these the smallest first.
confirmed() {
  gauntlet show "$1" --json | python3 -c '
import json, sys
shown = [one for one in json.load(sys.stdin).get("confirmed", []) if one["verdict"] == "fail" and one["run"]]
shown.sort(key=lambda one: -one["k"] / one["n"])
print(*[one["run"] for one in shown[:int(sys.argv[1])]])' "$2"
}

# minimised DIR N: makes at most N confirmed cases small; leaves pictures of the first and says what did it.
minimised() {
  local dir=$1 runs
  runs=$(confirmed "$dir" "$2")
  if [[ -z $runs ]]; then say "$dir: no case is confirmed"; return; fi
  # shellcheck disable=SC2086 # runs are several words
  gauntlet minimise "$dir" $runs --no-progress || true
  gauntlet blame "$dir" "${runs%% *}" --no-progress
  gauntlet replay "$dir" "${runs%% *}" --svg "$dir.svg" >/dev/null
}

in_argos() {
  local out=$1 runs=$2
  once "$out/random" gauntlet random "$out.toml" --cases 100
  once "$out/archive" gauntlet evolve "$out.toml" --set "search.runs=$runs"
  gauntlet show "$out/random" | grep -E 'total failures|no obstacles' || true
  gauntlet confirm "$out/archive" --elites --no-progress || return 0  # it found nothing
  minimised "$out/archive" 3
}

in_our_engine() {
  local name=$1 out=$2 adopted=$3 search
  cp "$here/$name.toml" "$name.toml"
  for search in archive cma-me random-deletion random genetic; do
    local length=(--set search.runs=1000) kept=--elites
    case $search in
      random) length=(--set search.cases=1000) kept=--all-failing ;;
      genetic) length=(--set search.generations=50) kept=--all-failing ;;
    esac
    once "$out/$search" gauntlet evolve "$name.toml" --set "search.algorithm=$search" "${length[@]}" --seeds "1..$SEEDS"
    gauntlet confirm "$out/$search" "$kept" --quiet >/dev/null || true
  done
  gauntlet compare --budget "$out"/{archive,cma-me,random-deletion,random,genetic}
  minimised "$out/archive" 20
  local runs
  runs=$(confirmed "$out/archive" 20)
  [[ -n $runs ]] || return 0
  # shellcheck disable=SC2086 # runs are several words
  gauntlet confirm "$out/archive" $runs --replicates 30 --no-progress
  # shellcheck disable=SC2086
  gauntlet confirm "$out/archive" $runs --replicates 30 --engine "$adopted" --no-progress
}

[[ $# -ge 2 ]] || die "usage: others.sh PROJECTS OUT [NAME...] (examples/others/README.md)"
command -v gauntlet >/dev/null || die "gauntlet is not in PATH"
command -v argos3 >/dev/null || die "argos3 is not in PATH: nothing can be adopted"
projects=$(realpath "$1")
mkdir -p "$2"
results=$(realpath "$2")
shift 2
SEEDS=${SEEDS:-10}
while IFS='|' read -r -u 3 name repository start scene seconds score runs; do
  [[ $# -eq 0 || " $* " == *" $name "* ]] || continue
  if [[ ! -d $projects/${repository#*/} ]]; then
    say "$name: skipped, $projects/${repository#*/} is not there (git clone https://github.com/$repository)"
    continue
  fi
  say "$name, of $repository"
  out=$results/$name
  if [[ ! -e $out.toml ]]; then
    rm -rf "$out.project"
    cp -rL "$projects/${repository#*/}" "$out.project"
    (
      cd "$out.project"
      scene_in_project=$(realpath "$start/$scene")
      cd "$start"
      prepare "$name" "$scene_in_project"
      gauntlet adopt "$scene" -o "$out.toml" --length "$seconds" --score "$score"
    )
    judge "$name" "$out.toml"
  fi
  in_argos "$out" "$runs"
  if [[ -e $here/$name.toml ]]; then
    (
      mkdir -p "$out.engine"
      cd "$out.engine"
      [[ -e lib$name.so ]] || gauntlet build-controller "$out.project/$start"/controllers/*/footbot_"${name/-/_}.cpp" \
        --argos "$out.project/$start/$scene" -I "$out.project/$start" -o "lib$name.so"
      in_our_engine "$name" "$out.engine/searches" "$out.toml"
    )
  fi
done 3< <(rows)
