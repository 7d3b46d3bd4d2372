"""Backends of real models: a module for each, in the folder of its group, and what they share.

    language      floor plans, and the names of what stands in a room
    access        packages of extras and secrets of the environment, when they are needed and not before
    http_client   an HTTP client whose time limit holds for a whole request
    http_faults   what goes wrong between here and a service, told apart by whether a later try helps
    prompt_files  Prompts: what models are told, in files of wm/models/prompts that a user's own can replace
"""
