# Completion of the landmass tools for bash; zsh takes it behind `autoload bashcompinit && bashcompinit`.
# The programs themselves say what they accept: COMMAND --help=list prints a line an option: its name, its value, and
# what the value may be completed from.

# What one program, or one of its commands, accepts.
_landmass_list() { # PROGRAM [COMMAND]
    "$@" --help=list 2>/dev/null
}

# Candidates for the value of an option, or for an argument, that comes from $1.
_landmass_value() { # SOURCE WORD
    case $1 in
    file) mapfile -t COMPREPLY < <(compgen -f -- "$2") && compopt -o filenames 2>/dev/null ;;
    folder) mapfile -t COMPREPLY < <(compgen -d -- "$2") && compopt -o filenames 2>/dev/null ;;
    *) mapfile -t COMPREPLY < <(compgen -W "${1//|/ }" -- "$2") ;;
    esac
}

_landmass() {
    local program=$1 word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
    local list command='' source
    COMPREPLY=()
    list=$(_landmass_list "$program")
    # A program whose list has words without dashes has commands: the first word is one.
    if grep -q '^[a-z]' <<<"$list"; then
        if [ "$COMP_CWORD" -eq 1 ]; then
            mapfile -t COMPREPLY < <(compgen -W "$(cut -f1 <<<"$list")" -- "$word")
            return
        fi
        command=${COMP_WORDS[1]}
        list=$(_landmass_list "$program" "$command")
    fi
    if [[ $before == --* ]] && grep -q -e "^$before	." <<<"$list"; then
        source=$(grep -e "^$before	" <<<"$list" | cut -f3)
        _landmass_value "$source" "$word"
    elif [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(cut -f1 <<<"$list" | grep '^-')" -- "$word")
    elif grep -q '^	' <<<"$list"; then
        _landmass_value file "$word"
    fi
}

complete -F _landmass landmass-bus landmass-db landmass-dis landmass-load landmass-nav landmass-netem \
    landmass-radar landmass-realradar landmass-reference landmass-scene landmass-sim landmass-target
