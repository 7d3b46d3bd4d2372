"""A training view: a posed image, the depth of the scaffold at its pixels, and the mask of its usable pixels."""

import dataclasses

import numpy as np

from wm.types import Camera


@dataclasses.dataclass(frozen=True, eq=False)
class TrainingView:
    """One posed image of one room with its scaffold, on the host.

    Raises: ValueError at construction, naming the array whose shape does not fit the camera.

    Attributes:
        camera: where the image was taken from
        rgb: [h, w, 3] uint8 sRGB
        depth: [h, w] float32 z-depth of the scaffold, metres; 0 where it is not hit
        mask: [h, w] bool: usable pixels
        room: the room it stands in
        own: [h, w] bool: pixels that show a surface of `room`; None: all of them
        normal: [h, w, 3] float32 world normal of the scaffold; None: taken from the depth
        detailed: [h, w] bool: pixels of surfaces with detail, such as objects; None: of none
        sees: other rooms that it may see into, through doors
    """

    camera: Camera
    rgb: np.ndarray
    depth: np.ndarray
    mask: np.ndarray
    room: int
    own: np.ndarray | None = None
    normal: np.ndarray | None = None
    detailed: np.ndarray | None = None
    sees: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        size = (self.camera.height, self.camera.width)
        shapes = {"rgb": (*size, 3), "depth": size, "mask": size, "own": size, "detailed": size, "normal": (*size, 3)}
        for name, shape in shapes.items():
            array = getattr(self, name)
            if array is not None and array.shape != shape:
                raise ValueError(f"training view of room {self.room}: {name} has shape {array.shape}, its camera makes {shape}")
        if self.rgb.dtype != np.uint8 or self.mask.dtype != np.bool_:
            kinds = f"{self.rgb.dtype} and {self.mask.dtype}"
            raise ValueError(f"training view of room {self.room}: rgb and mask must be uint8 and bool, not {kinds}")
