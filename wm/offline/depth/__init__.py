"""The offline depth backend.

    estimator  what the painter drew, as a monocular depth estimator would report it
"""
