"""Triangles without height, as booleans leave them where several corners lie on one line: removed by flips.

A flat triangle a, b, c with b between a and c borders a triangle c, a, d across its longest edge; a, b, d and b, c, d take the
place of both, where both are then higher than HEIGHT. Nothing moves by more than the triangle's height and the mesh stays closed.
Corners that coincide stay as they are, and with them the triangles between them that have no normal.
"""

import numpy as np

HEIGHT = 1e-9  # metres: triangles lower than this have no usable normal


def heights(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """[f] the height of each triangle over its longest edge, metres."""
    corners = vertices[faces]
    edges = np.roll(corners, -1, axis=1) - corners
    doubled_area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    longest = np.linalg.norm(edges, axis=2).max(axis=1)
    return np.divide(doubled_area, longest, out=np.zeros_like(longest), where=longest > 0)


def flip_slivers(vertices: np.ndarray, faces: np.ndarray, labels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The faces and labels of a closed mesh with its flat triangles flipped away; flips take the neighbour's label.

    Flat triangles that only border each other stay (there is nothing to flip them into), and so do those whose flip would leave
    another flat one: two of their corners coincide.
    """
    flat = set(np.flatnonzero(heights(vertices, faces) < HEIGHT).tolist())
    if not flat:
        return faces, labels
    faces, labels = faces.copy(), labels.copy()
    face_at = {}
    for k in range(3):
        edges = zip(faces[:, k].tolist(), faces[:, (k + 1) % 3].tolist())
        face_at.update({edge: face for face, edge in enumerate(edges)})
    progress = True
    while flat and progress:
        progress = False
        for face in sorted(flat):
            corners = vertices[faces[face]]
            k = int(np.argmax(np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)))
            c, a, b = (int(v) for v in np.roll(faces[face], -k))  # the longest edge runs from c to a
            other = face_at[a, c]
            if other in flat:
                continue
            d = next(int(v) for v in faces[other] if v not in (a, c))
            if (b, d) in face_at or (d, b) in face_at:
                continue
            flipped = np.array([(a, b, d), (b, c, d)])
            if heights(vertices, flipped).min() < HEIGHT:
                continue
            faces[face], faces[other] = flipped
            labels[face] = labels[other]
            del face_at[a, c], face_at[c, a]
            for triangle in (face, other):
                p, q, r = (int(v) for v in faces[triangle])
                face_at.update({(p, q): triangle, (q, r): triangle, (r, p): triangle})
            flat.discard(face)
            progress = True
    return faces, labels
