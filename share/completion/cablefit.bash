# bash completion of cablefit: commands, and the options that --help names.
_cablefit() {
  local current="${COMP_WORDS[COMP_CWORD]}" program="${COMP_WORDS[0]}" command="${COMP_WORDS[1]}"
  COMPREPLY=()
  if ((COMP_CWORD == 1)) || { ((COMP_CWORD == 2)) && [[ "$command" == help ]]; }; then
    local commands
    commands="$("$program" --help 2>/dev/null | sed -n 's/^  \([a-z]*\)  .*/\1/p')"
    mapfile -t COMPREPLY < <(compgen -W "$commands help --help --version" -- "$current")
  elif [[ "$current" == -* ]]; then
    local options
    options="$("$program" "$command" --help 2>/dev/null | grep -o -e '--[a-z][a-z-]*')"
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  elif [[ "$command" == list ]]; then
    mapfile -t COMPREPLY < <(compgen -W "effects models estimators formats" -- "$current")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}
complete -F _cablefit cablefit
