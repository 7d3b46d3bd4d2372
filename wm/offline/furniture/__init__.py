"""Parametric furniture: KINDS lists every kind, make_piece builds one in its own frame (front towards -y, foot at the origin)."""

from wm.offline.furniture.catalog import EQUIPMENT, KINDS, make_piece
from wm.offline.furniture.piece import FurnitureKind, Piece, Top

__all__ = ["EQUIPMENT", "KINDS", "FurnitureKind", "Piece", "Top", "make_piece"]
