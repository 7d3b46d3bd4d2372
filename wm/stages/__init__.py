"""The stages of a run, each a function of the job and of what came before it."""
