# SPDX-License-Identifier: GPL-3.0-or-later
# Completion of bounce, settle, analyze and sweep for bash. The program is asked
# (--complete), so this knows what the installed one takes.
_dem() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  local program=${COMP_WORDS[0]} verb=() table option kind choices
  # --name=value comes as three words
  if [[ $word == = ]]; then
    word=
  elif [[ $before == = ]] && ((COMP_CWORD > 2)); then
    before=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  if ((COMP_CWORD > 1)) && [[ ${COMP_WORDS[1]} == [a-z]* ]]; then
    verb=("${COMP_WORDS[1]}")
  fi
  table=$("$program" "${verb[@]}" --complete 2>/dev/null) || return
  COMPREPLY=()
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$(cut -f 1 <<<"$table" | grep '^-')" -- "$word"))
    return
  fi
  while IFS=$'\t' read -r option kind choices; do
    [[ $option == "$before" && $kind != flag ]] || continue
    if [[ -n $choices ]]; then
      COMPREPLY=($(compgen -W "$choices" -- "$word"))
    elif [[ $kind == text ]]; then
      COMPREPLY=($(compgen -f -- "$word"))
    fi
    return
  done <<<"$table"
  COMPREPLY=($(compgen -f -- "$word"))
  if ((COMP_CWORD == 1)); then
    COMPREPLY+=($(compgen -W "$(grep -v '^-' <<<"$table")" -- "$word"))
  fi
}
complete -o filenames -F _dem bounce settle analyze sweep
