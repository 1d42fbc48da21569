# Completion of the program ductile for fish. Commands and options are those in the help of the program itself.

function __ductile_commands
    $argv[1] help 2>/dev/null | string replace -rf '^  ductile ([a-z]+) +([a-z].*)$' '$1\t$2'
    printf 'help\tshows the options of a command\n'
end

# The options of a command: name, tab, help; both names if there are two.
function __ductile_options
    set -l lines ($argv[1] help $argv[2] 2>/dev/null)
    string replace -rf '^  (-[^ ,]+)(, -[^ ]+)?( [^ ]+)? +([^ ].*)$' '$1\t$4' -- $lines
    string replace -rf '^  -[^ ,]+, (-[^ ]+)( [^ ]+)? +([^ ].*)$' '$1\t$3' -- $lines
end

complete -c ductile -n __fish_use_subcommand -f -a '(__ductile_commands (commandline -opc)[1])'
complete -c ductile -n '__fish_seen_subcommand_from help' -f -a '(__ductile_commands (commandline -opc)[1])'
complete -c ductile -n 'not __fish_use_subcommand; and string match -q -- "-*" (commandline -ct)' -f \
    -a '(__ductile_options (commandline -opc)[1..2])'
