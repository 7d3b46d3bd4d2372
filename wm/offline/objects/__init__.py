"""The offline objects backend.

    generator  parametric furniture, arranged by the type of the room
"""
