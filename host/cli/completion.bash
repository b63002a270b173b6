# Bash completion for solidcast. Verbs, options and their words are read from --help, so this never falls behind.
_solidcast() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} verb=${COMP_WORDS[1]} help choices
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "$(solidcast --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p') --help --version" -- "$word")
    return
  fi
  help=$(solidcast "$verb" --help 2>/dev/null) || return
  if [[ $before == --* ]]; then
    choices=$(sed -n "s/^ *$before \([a-z0-9]*\(|[a-z0-9]*\)\{1,\}\) .*/\1/p" <<<"$help" | tr '|' ' ')
    if [[ -n $choices ]]; then
      mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word")
      return
    fi
  fi
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(grep -o '^  *-[-a-z,]*' <<<"$help" | tr ',' '\n')" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -o filenames -F _solidcast solidcast
