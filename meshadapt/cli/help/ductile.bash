# Completion of the program ductile for bash. Commands, their options, what these take and the endings
# of files are what the help of that very program says, so there is nothing to keep up here.

# Adds to COMPREPLY folders, and files that begin with WORD and have one of the endings; without
# any ending all files.
#   _ductile_files WORD [ENDING...]
_ductile_files() {
  local word=${1//\\/} ending
  word=${word#[\'\"]}
  shift
  compopt -o filenames 2>/dev/null  # the shell then quotes them, and gives folders a slash
  mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(
    if [[ $# -eq 0 ]]; then compgen -f -- "$word"; else compgen -d -- "$word"; fi
    for ending; do compgen -f -X "!*$ending" -- "$word"; done)
}

# Adds to COMPREPLY the words A|B|C that begin with WORD, except those in capitals, which stand for
# something else.
#   _ductile_words WORD A|B|C
_ductile_words() {
  local all one
  IFS='|' read -ra all <<<"$2"
  for one in "${all[@]}"; do
    [[ $one != "$1"* || $one =~ [^a-z-] ]] || COMPREPLY+=("$one")
  done
}

# Adds to COMPREPLY what an option or a command takes. TAKES is what help has for it; the help of an
# option may name the endings of its files.
#   _ductile_values PROGRAM WORD TAKES [HELP]
_ductile_values() {
  local program=$1 word=$2 takes=$3 help=${4-} line
  local format='^  (\.[a-z0-9]+) +(.*)$' ending='\.([a-z][a-z0-9]*)([^a-z0-9.]|$)(.*)'
  local named=() read=() written=() fields=(.sol .solb)
  help=${help%%(default*}
  while [[ $help =~ $ending ]]; do
    named+=(".${BASH_REMATCH[1]}")
    help=${BASH_REMATCH[3]}
  done
  while IFS= read -r line; do
    [[ $line =~ $format ]] || continue
    written+=("${BASH_REMATCH[1]}")
    [[ $line == *'written only'* ]] || read+=("${BASH_REMATCH[1]}")
    [[ $line != *'with fields'* ]] || fields+=("${BASH_REMATCH[1]}")
  done < <("$program" help 2>/dev/null)
  case $takes in
    *'|'*) _ductile_words "$word" "$takes" ;;
    MESH | OLD | NEW) _ductile_files "$word" "${read[@]}" ;;
    IN) _ductile_files "$word" "${read[@]}" .sol .solb ;;
    METRIC | FIELD) _ductile_files "$word" "${fields[@]}" ;;
    OUT)  # of which those that may be metrics or other fields name some endings
      if [[ ${#named[@]} -gt 0 ]]; then named+=("${fields[@]}"); else named=("${written[@]}"); fi
      [[ $# -gt 3 ]] || named+=(.sol .solb)
      _ductile_files "$word" "${named[@]}"
      ;;
    FILE | PICTURE) _ductile_files "$word" "${named[@]}" ;;
  esac
}

# Sets `words` to those after the program up to the one that is completed. The shell takes words apart
# at = and : as well.
_ductile_split() {
  local i
  for ((i = 1; i <= COMP_CWORD; ++i)); do
    if [[ $i -gt 1 && (${COMP_WORDS[i]} == [:=]* || ${words[-1]} == *[:=]) ]]; then
      words[-1]+=${COMP_WORDS[i]}
    else
      words+=("${COMP_WORDS[i]}")
    fi
  done
}

# Sets what the help of a command has: `names` of options, [without dashes] `takes_of` and `help_of`
# them, and `operands`.
#   _ductile_read_help PROGRAM COMMAND
_ductile_read_help() {
  local line name key option='^  (-[^ ,]+)(, (-[^ ]+))?( ([^ ]+))? +([^ ].*)$'
  while IFS= read -r line; do
    if [[ $line == "ductile $2 "* ]]; then
      line=${line#"ductile $2 "}
      line=${line%%[\[ ]-*}  # where options begin
      read -ra operands <<<"${line//[\[\]]/}"
    elif [[ $line =~ $option ]]; then
      for name in "${BASH_REMATCH[1]}" ${BASH_REMATCH[3]}; do
        names+=("$name")
        key=${name#-}
        key=${key#-}
        takes_of[$key]=${BASH_REMATCH[5]}
        help_of[$key]=${BASH_REMATCH[6]}
      done
    fi
  done < <("$1" help "$2" 2>/dev/null)
}

_ductile() {
  local program=${COMP_WORDS[0]/#\~/$HOME} words=() word line names=() operands=() key i at=0
  local open='' again=''
  local command='^  ductile ([a-z-]+) '
  local -A takes_of=() help_of=()
  COMPREPLY=()
  _ductile_split
  word=${words[-1]}
  if [[ ${#words[@]} -eq 1 || (${#words[@]} -eq 2 && ${words[0]} == help) ]]; then
    [[ ${#words[@]} -eq 1 ]] || command='^  ductile ([a-z]+) +[a-z]'
    while IFS= read -r line; do
      [[ ! $line =~ $command ]] || names+=("${BASH_REMATCH[1]}")
    done < <("$program" help 2>/dev/null)
    mapfile -t COMPREPLY < <(compgen -W "${names[*]}" -- "$word")
    return
  fi

  _ductile_read_help "$program" "${words[0]}"
  # `open` is the option whose value comes next, `at` the number of operands before the word.
  for ((i = 1; i < ${#words[@]} - 1; ++i)); do
    key=${words[i]#-}
    key=${key#-}
    if [[ -n $open ]]; then
      open=
    elif [[ ${words[i]} == -?* ]]; then
      [[ ! ${takes_of[${key:--}]} =~ ^[^[] ]] || open=$key
    else
      at=$((at + 1))
    fi
  done
  if [[ -z $open && $word == -*=* ]]; then
    open=${word%%=*}
    open=${open#-}
    open=${open#-}
    word=${word#*=}
  fi
  if [[ -n $open ]]; then
    _ductile_values "$program" "$word" "${takes_of[$open]}" "${help_of[$open]}"
  elif [[ $word == -* ]]; then
    line=${word%%[!-]*}  # one dash or two, of which both are right
    [[ $word == - ]] || for i in "${!names[@]}"; do
      key=${names[i]#-}
      names[i]=$line${key#-}
    done
    mapfile -t COMPREPLY < <(compgen -W "${names[*]}" -- "$word")
  else
    # From one on that may be given again, each may be it, or one of those after it.
    for ((i = 0; i < ${#operands[@]}; ++i)); do
      [[ $i -gt $at || ${operands[i]} != *... ]] || again=yes
      [[ $i -ne $at && -z $again ]] || _ductile_values "$program" "$word" "${operands[i]%...}"
    done
  fi
}

complete -F _ductile ductile
