"""The run folder: what is in it, under which key, and whether it is whole.

    run_folder  RunFolder, open_run_folder: entries stored under a key of all their inputs, resume, the lock
    manifest    what identifies the run, and what it has finished
    neighbours  the reuse cache: finished stages taken over from other run folders
    digests     digests of values and files, and values as JSON
    confined    names of files that stay inside their folder
    atomic      files that are written whole or not at all
    timings     time and peak memory of stages, as `timings.json` holds them
"""
