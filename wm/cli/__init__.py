"""What stands between the words that people type and a checked configuration.

    command_line  plain words translated into the overrides that Hydra reads
    keys          every key and choice, as the fields and the YAML files declare them
    help          what --help and --version print
    completion    words that TAB completes
    composition   conf/ and overrides composed into one checked RunConfig
    preflight     every run that is asked for is composed and checked before a folder is made
    signals       Ctrl-C and SIGTERM, heard also where Python would lose them
"""
