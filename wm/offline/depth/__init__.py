"""The offline depth backend: estimator, what the painter drew as a monocular estimator would report it."""
