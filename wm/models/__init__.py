"""Backends of real models: a module for each, in the folder of its group, and what they share.

prompt_files  Prompts: what models are told, in files of wm/models/prompts that a user's own can replace
"""
