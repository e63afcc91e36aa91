# fish completion of cablefit: commands, and the options that --help names.
function __cablefit_commands
    cablefit --help 2>/dev/null | sed -n 's/^  \([a-z]*\)  *\(.*\)/\1\t\2/p'
end
function __cablefit_options
    set -l words (commandline -opc)
    cablefit $words[2] --help 2>/dev/null | grep -o -e '--[a-z][a-z-]*' | sort -u
end
function __cablefit_after_help
    set -l words (commandline -opc)
    test (count $words) = 2; and test $words[2] = help
end
complete -c cablefit -n __fish_use_subcommand -f -a '(__cablefit_commands)'
complete -c cablefit -n __fish_use_subcommand -f -a help -d 'options of a command and an example'
complete -c cablefit -n __fish_use_subcommand -f -l help
complete -c cablefit -n __fish_use_subcommand -f -l version
complete -c cablefit -n __cablefit_after_help -f -a '(__cablefit_commands)'
complete -c cablefit -n 'not __fish_use_subcommand; and string match -q -- "-*" (commandline -ct)' -f -a '(__cablefit_options)'
complete -c cablefit -n '__fish_seen_subcommand_from list' -f -a 'effects models estimators formats'
