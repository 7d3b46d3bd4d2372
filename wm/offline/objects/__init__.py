"""The offline objects backend: generator, parametric furniture arranged by room type."""
