# Completion of gauntlet for bash. Names of commands, options and experiments are asked of the program itself.
_gauntlet() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} words=
  if [ "$COMP_CWORD" -eq 1 ]; then
    words="$("$program" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p') help --help --version"
  elif [[ $word == -* ]]; then
    words=$("$program" "${COMP_WORDS[1]}" --help 2>/dev/null | sed -n 's/^  \(-[a-z],\)*\(--[a-z-]*\).*/\2/p')
  elif [ "$COMP_CWORD" -eq 2 ]; then
    words=$("$program" list experiments 2>/dev/null | sed -n 's/^  \([a-z][a-z-]*\) .*/\1/p')
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}
complete -o default -F _gauntlet gauntlet
