"""The stages of a run: each is a function of the run's context and of the results of the stages before it."""
